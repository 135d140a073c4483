//! The joints of machines: ball, pin, universal joint, cylinder, slider, weld, plane, and a rod without mass.

use nalgebra::{Matrix3, SMatrix, Vector3, Vector6};

use super::constraint::{Constraint, Place, Slope};
use super::point_joint::PointJoint;
use crate::error::SetupError;

/// A joint between a body above, or space, and a body below. Points `ρ_a`, `ρ_b`, from the origin of each body's axes in these
/// axes, m, and axes `n_a`, `n_b`, of any length, are given as pairs, that of the body above first; for a joint to space they
/// are a point and an axis of space.
///
/// With `s = x_b + R_b ρ_b − x_a − R_a ρ_a`, unit vectors `e_1`, `e_2` at right angles to the axis `n_a`, and `c_i` the axes of a
/// weld, the functions that vanish are, in m and as cosines:
///
/// | kind | functions | leaves free |
/// |---|---|---|
/// | [`ball`](Self::ball) | `s` | three turns |
/// | [`pin`](Self::pin) | `s`, `R_a e_1 · R_b n_b`, `R_a e_2 · R_b n_b` | a turn about the axis |
/// | [`universal`](Self::universal) | `s`, `R_a n_a · R_b n_b` | turns about either axis |
/// | [`cylinder`](Self::cylinder) | `R_a e_1 · s`, `R_a e_2 · s`, `R_a e_1 · R_b n_b`, `R_a e_2 · R_b n_b` | turn and shift along the axis |
/// | [`slider`](Self::slider) | `R_a e_1 · s`, `R_a e_2 · s`, and the three of a weld | a shift along the axis |
/// | [`weld`](Self::weld) | `s`, `R_a c_1 · R_b Qᵀ c_2`, `R_a c_2 · R_b Qᵀ c_3`, `R_a c_3 · R_b Qᵀ c_1` | nothing |
/// | [`plane`](Self::plane) | `R_a n_a · s`, `R_a e_1 · R_b n_b`, `R_a e_2 · R_b n_b` | two shifts and a turn |
/// | [`distance`](Self::distance) | `(s·s / l − l) / 2` | all but one shift |
///
/// Signs of axes don't matter: axes that start parallel stay parallel, and opposite ones opposite.
///
/// # Examples
///
/// A cart on a rail, with a pole on a pin. The momentum along the rail is conserved.
///
/// ```
/// use liestep::groups::{LieGroup as _, R3};
/// use liestep::methods::{Joint, Multibody};
/// use liestep::{NonstandardInertia, SO3, lagrangian};
/// use nalgebra::{Matrix3, Vector3, Vector6};
///
/// /// A body and its weight.
/// #[lagrangian(
///     group(F = SO3, d = R3),
///     advected(x = d.seen_from(space)),
///     l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) + m * d.norm_squared() / (2.0 * h)
///         - 0.5 * h * m * g * (x + x + d)[2],
/// )]
/// struct Heavy {
///     J_d: NonstandardInertia,
///     m: f64,
///     g: f64,
/// }
///
/// let J_d = NonstandardInertia::from_principal_moments(Vector3::new(0.084, 0.084, 0.002))?;
/// let (zero, half) = (Vector3::zeros(), Vector3::z() * 0.5);
/// let mut system = Multibody::new();
/// let cart = system.body(Heavy { J_d, m: 2.0, g: 9.81 });
/// let pole = system.body(Heavy { J_d, m: 1.0, g: 9.81 });
/// system.join(Joint::slider([zero, zero], Vector3::x(), Matrix3::identity()), None, cart);
/// system.join(Joint::pin([zero, -half], [Vector3::y(); 2]), Some(cart), pole);
/// let stepper = system.stepper(0.01)?;
///
/// let tilt = SO3::exp(Vector3::y() * 0.3);
/// let top = R3::from(tilt.as_matrix() * half);
/// let mut state = stepper.start(&[(SO3::identity(), R3::identity()), (tilt, top)], &[Vector6::zeros(); 2])?;
/// stepper.run(&mut state, 300)?;
/// let along = |body| stepper.momentum(&state, body)[3];
/// assert!((along(cart) + along(pole)).abs() < 1e-13);
/// assert!(stepper.widest_gap(&state) < 1e-14);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joint {
    name: &'static str,
    points: [Vector3<f64>; 2],
    functions: [Function; 6],
    count: usize,
    /// The first parameter with an invalid value, and the reason.
    flaw: Option<(&'static str, &'static str)>,
}

/// A function of the places of two bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Function {
    /// The component of `s` along an axis of space, m.
    Component(usize),
    /// The component `R_a e · s`, m.
    Along(Vector3<f64>),
    /// The cosine `R_a e · R_b n`.
    Cosine(Vector3<f64>, Vector3<f64>),
    /// The excess `(s·s / l − l) / 2` of a length, m.
    Distance(f64),
    /// Zero: beyond the functions of the joint.
    Nothing,
}

use Function::{Along, Component, Cosine, Distance, Nothing};

const COINCIDENCE: [Function; 3] = [Component(0), Component(1), Component(2)];

/// Two unit vectors at right angles to an axis and to each other.
fn across(axis: &Vector3<f64>) -> [Vector3<f64>; 2] {
    // The coordinate axis that is farthest from the axis.
    let far = Vector3::ith(axis.iamin(), 1.0);
    let first = axis.cross(&far).normalize();
    [first, axis.cross(&first)]
}

/// The functions by which directions across an axis of the body above are at right angles to that of the body below.
fn parallel([above, below]: [Vector3<f64>; 2]) -> [Function; 2] {
    across(&above).map(|across| Cosine(across, below))
}

/// The functions by which the attitude `R_aᵀ R_b` is this one.
fn fixed(relative: &Matrix3<f64>) -> [Function; 3] {
    [0, 1, 2].map(|k| Cosine(Vector3::ith(k, 1.0), relative.row((k + 1) % 3).transpose()))
}

impl Joint {
    fn of<const C: usize>(name: &'static str, points: [Vector3<f64>; 2], functions: [Function; C]) -> Self {
        let mut all = [Nothing; 6];
        all[..C].copy_from_slice(&functions);
        let finite = |vector: &Vector3<f64>| vector.iter().all(|entry| entry.is_finite());
        let [above, below] = points.each_ref().map(finite);
        let flaw = match (above, below) {
            (true, true) => None,
            (false, _) => Some(("above", NOT_FINITE)),
            (_, false) => Some(("below", NOT_FINITE)),
        };
        Self { name, points, functions: all, count: C, flaw }
    }

    /// The joint, with what is wrong with these axes.
    fn checked(self, axes: [Vector3<f64>; 2]) -> Self {
        let flaw = ["axis_above", "axis_below"].into_iter().zip(axes).find_map(|(field, axis)| {
            let size = axis.norm_squared();
            let has_direction = size > 0.0 && size.is_finite() && (1.0 / size).is_finite();
            let cause = if axis.iter().all(|entry| entry.is_finite()) { "has no direction" } else { NOT_FINITE };
            (!has_direction).then_some((field, cause))
        });
        Self { flaw: self.flaw.or(flaw), ..self }
    }

    /// A ball joint: a point of one body coincides with a point of another, or with a pivot of space.
    #[must_use]
    pub fn ball(points: [Vector3<f64>; 2]) -> Self {
        Self::of("ball joint", points, COINCIDENCE)
    }

    /// A pin, or hinge: points coincide, and so do axes, about which the bodies turn.
    #[must_use]
    pub fn pin(points: [Vector3<f64>; 2], axes: [Vector3<f64>; 2]) -> Self {
        let ([x, y, z], [one, other]) = (COINCIDENCE, parallel(axes.map(|axis| axis.normalize())));
        Self::of("pin", points, [x, y, z, one, other]).checked(axes)
    }

    /// A universal joint: points coincide, and an axis of one body stays at right angles to an axis of the other.
    #[must_use]
    pub fn universal(points: [Vector3<f64>; 2], axes: [Vector3<f64>; 2]) -> Self {
        let ([x, y, z], [above, below]) = (COINCIDENCE, axes.map(|axis| axis.normalize()));
        Self::of("universal joint", points, [x, y, z, Cosine(above, below)]).checked(axes)
    }

    /// A cylinder: the bodies turn about an axis and shift along it.
    #[must_use]
    pub fn cylinder(points: [Vector3<f64>; 2], axes: [Vector3<f64>; 2]) -> Self {
        let units = axes.map(|axis| axis.normalize());
        let ([x, y], [one, other]) = (across(&units[0]).map(Along), parallel(units));
        Self::of("cylinder", points, [x, y, one, other]).checked(axes)
    }

    /// A slider: the bodies shift along an axis of the body above, and keep the attitude `R_aᵀ R_b = relative`, a rotation.
    #[must_use]
    pub fn slider(points: [Vector3<f64>; 2], axis: Vector3<f64>, relative: Matrix3<f64>) -> Self {
        let ([x, y], [one, other, third]) = (across(&axis.normalize()).map(Along), fixed(&relative));
        Self::of("slider", points, [x, y, one, other, third]).checked([axis; 2]).turned(&relative)
    }

    /// A weld: points coincide, and the bodies keep the attitude `R_aᵀ R_b = relative`, a rotation.
    #[must_use]
    pub fn weld(points: [Vector3<f64>; 2], relative: Matrix3<f64>) -> Self {
        let ([x, y, z], [one, other, third]) = (COINCIDENCE, fixed(&relative));
        Self::of("weld", points, [x, y, z, one, other, third]).turned(&relative)
    }

    /// A plane: the bodies shift at right angles to an axis, and turn about it.
    #[must_use]
    pub fn plane(points: [Vector3<f64>; 2], axes: [Vector3<f64>; 2]) -> Self {
        let units = axes.map(|axis| axis.normalize());
        let [one, other] = parallel(units);
        Self::of("plane", points, [Along(units[0]), one, other]).checked(axes)
    }

    /// A rod without mass between two points, of this length, m.
    #[must_use]
    pub fn distance(points: [Vector3<f64>; 2], length: f64) -> Self {
        let joint = Self::of("distance", points, [Distance(length)]);
        let is_right = length > 0.0 && length.is_finite() && (1.0 / length).is_finite();
        let flaw = (!is_right).then_some(("length", "isn't a finite number above zero"));
        Self { flaw: joint.flaw.or(flaw), ..joint }
    }

    /// The joint as one that holds points, if it is one.
    pub(super) fn of_points(&self) -> Option<PointJoint> {
        let (first, others) = self.functions[..self.count].split_at_checked(3)?;
        let mut cosines = [[Vector3::zeros(); 2]; 3];
        for (cosine, function) in cosines.iter_mut().zip(others) {
            let Cosine(e, n) = function else { return None };
            *cosine = [*e, *n];
        }
        (*first == COINCIDENCE).then_some(PointJoint { points: self.points, cosines, count: others.len() })
    }

    /// The joint, with what is wrong with a relative attitude.
    fn turned(self, relative: &Matrix3<f64>) -> Self {
        let off = (relative * relative.transpose() - Matrix3::identity()).amax();
        // A NaN is no rotation.
        let is_rotation = off < ROUNDED && relative.determinant() > 0.0;
        let flaw = (!is_rotation).then_some(("relative", "is no rotation"));
        Self { flaw: self.flaw.or(flaw), ..self }
    }
}

const NOT_FINITE: &str = "is not finite";

/// The largest deviation of a relative attitude from a rotation: twelve digits pass.
const ROUNDED: f64 = 1e-11;

impl Constraint<6> for Joint {
    fn name(&self) -> &'static str {
        self.name
    }

    fn functions(&self) -> usize {
        self.count
    }

    fn validate(&self) -> Result<(), SetupError> {
        self.flaw.map_or(Ok(()), |(field, cause)| Err(SetupError::Parameter { field, cause }))
    }

    fn gap(&self, above: &Place, below: &Place) -> Vector6<f64> {
        let s = below.of(&self.points[1]) - above.of(&self.points[0]);
        let mut gap = Vector6::zeros();
        for (value, function) in gap.iter_mut().zip(&self.functions).take(self.count) {
            *value = match function {
                Component(k) => s[*k],
                Along(e) => (above.attitude * e).dot(&s),
                Cosine(e, n) => (above.attitude * e).dot(&(below.attitude * n)),
                Distance(length) => 0.5 * (s.norm_squared() / length - length),
                Nothing => 0.0,
            };
        }
        gap
    }

    fn slope(&self, above: &Place, below: &Place) -> [Slope<6>; 2] {
        let zero = SMatrix::<f64, 6, 3>::zeros();
        let [mut of_above, mut of_below] = [Slope { turn: zero, shift: zero }; 2];
        let arms = [above.attitude * self.points[0], below.attitude * self.points[1]];
        let crosses = arms.map(|arm| arm.cross_matrix());
        let s = below.of(&self.points[1]) - above.of(&self.points[0]);
        for (row, function) in self.functions.iter().enumerate().take(self.count) {
            // For a unit vector u that turns with the body above, `δ(u · s) = η_a · u × (s + r_a) + η_b · (r_b × u) + u · (ξ_b − ξ_a)`.
            let ([turn_above, turn_below], shift) = match function {
                Component(k) => {
                    let rows = crosses.map(|cross| cross.row(*k).transpose());
                    ([rows[0], -rows[1]], Some(Vector3::ith(*k, 1.0)))
                }
                Along(e) => {
                    let u = above.attitude * e;
                    ([u.cross(&(s + arms[0])), arms[1].cross(&u)], Some(u))
                }
                Distance(length) => {
                    let u = s / *length;
                    ([u.cross(&arms[0]), arms[1].cross(&u)], Some(u))
                }
                Cosine(e, n) => {
                    // η_a × e · n = η_a · (e × n); the body below has the opposite sign.
                    let turn = (above.attitude * e).cross(&(below.attitude * n));
                    ([turn, -turn], None)
                }
                Nothing => continue,
            };
            of_above.turn.set_row(row, &turn_above.transpose());
            of_below.turn.set_row(row, &turn_below.transpose());
            if let Some(shift) = shift {
                of_above.shift.set_row(row, &-shift.transpose());
                of_below.shift.set_row(row, &shift.transpose());
            }
        }
        [of_above, of_below]
    }

    fn point(&self) -> Vector3<f64> {
        self.points[1]
    }

    fn describe(&self, visit: &mut dyn FnMut(&'static str, f64)) {
        let mut each = |name, vector: &Vector3<f64>| vector.iter().for_each(|&entry| visit(name, entry));
        each("above", &self.points[0]);
        each("below", &self.points[1]);
        for function in self.functions.iter().take(self.count) {
            match function {
                Along(e) => each("axis_above", e),
                Cosine(e, n) => {
                    each("axis_above", e);
                    each("axis_below", n);
                }
                Distance(length) => each("length", &Vector3::repeat(*length)),
                Component(_) | Nothing => (),
            }
        }
    }
}
