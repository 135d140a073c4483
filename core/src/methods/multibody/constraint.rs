//! Holonomic constraints on two bodies, and those of joints.

use core::fmt::Debug;

use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

use crate::error::SetupError;

/// The place of a body: attitude and position. The place of space is the identity and the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// The rotation from the body's axes to those of space.
    pub attitude: Matrix3<f64>,
    /// The origin of the body's axes in space, m.
    pub position: Vector3<f64>,
}

impl Place {
    /// The place of the frame of space.
    pub const SPACE: Self = Self {
        attitude: Matrix3::new(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0),
        position: Vector3::new(0.0, 0.0, 0.0),
    };

    /// The position in space of a point of the body.
    #[must_use]
    pub fn of(&self, point: &Vector3<f64>) -> Vector3<f64> {
        self.position + self.attitude * point
    }
}

/// The derivatives of a constraint by the place of one body, in the axes of space: one row per function, along
/// `δR = η̂ R` and `δx = ξ`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slope<const K: usize> {
    /// The derivatives along `η`.
    pub turn: SMatrix<f64, K, 3>,
    /// The derivatives along `ξ`.
    pub shift: SMatrix<f64, K, 3>,
}

/// A holonomic constraint on two bodies, or on a body and space: `K` functions of their places, which vanish.
///
/// [`BallJoint`] and [`PinJoint`] are constraints. [`constraint`](macro@crate::constraint) declares another
/// by its functions, and derives its [`slope`](Self::slope). In an implementation by hand, as in
/// `examples/declarations/strut.rs`, nothing checks that the slope is the derivative of the [`gap`](Self::gap).
///
/// A [`Multibody`](super::Multibody) system takes joints of any types, with up to six functions each.
///
/// # Examples
///
/// A strut, a rod without mass between two points, is one function. A body hangs on it and is thrown sideways:
///
/// ```
/// use liestep::groups::R3;
/// use liestep::methods::Multibody;
/// use liestep::{NonstandardInertia, SO3, constraint, lagrangian};
/// use nalgebra::{Vector3, Vector6};
///
/// #[constraint(
///     group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
///     advected(R_1 = F_1.seen_from(space), R_2 = F_2.seen_from(space), r = d_2.seen_from(d_1)),
///     zero = {
///         let along = r + R_2 * below - R_1 * above;
///         0.5 * (along.norm_squared() / length - length) // m
///     },
/// )]
/// #[derive(Clone, Copy, Debug, PartialEq)]
/// struct Strut {
///     above: Vector3<f64>, // m, in the axes of its body
///     below: Vector3<f64>,
///     length: f64, // m
/// }
///
/// /// A body and its weight.
/// #[lagrangian(
///     group(F = SO3, d = R3),
///     advected(x = d.seen_from(space)),
///     l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) + m * d.norm_squared() / (2.0 * h)
///         - 0.5 * h * m * g * (x + x + d)[2],
/// )]
/// #[derive(Clone, Copy, Debug, PartialEq)]
/// struct Heavy {
///     J_d: NonstandardInertia,
///     m: f64,
///     g: f64,
/// }
///
/// let J_d = NonstandardInertia::from_principal_moments(Vector3::new(0.02, 0.1, 0.09))?;
/// let strut = Strut { above: Vector3::zeros(), below: Vector3::x() * 0.2, length: 1.0 };
/// let start = [(SO3::identity(), R3::from(Vector3::new(-0.2, 0.0, -1.0)))];
/// let off = |h: f64, steps: u32| -> Result<f64, Box<dyn std::error::Error>> {
///     let mut system = Multibody::new();
///     let body = system.body(Heavy { J_d, m: 1.0, g: 9.81 });
///     system.join(strut, None, body);
///     let stepper = system.stepper(h)?;
///     let mut state = stepper.start(&start, &[Vector6::new(0.0, 0.0, 0.0, 0.0, 2.0, 0.0)])?;
///     let (energy, mut off) = (stepper.energy(&state), 0.0_f64);
///     for _ in 0..steps {
///         stepper.step(&mut state)?;
///         off = off.max((stepper.energy(&state) - energy).abs());
///     }
///     assert!(stepper.widest_gap(&state) < 1e-14);
///     Ok(off)
/// };
/// // Of second order: at half the step the energy is off by a quarter.
/// let ratio = off(0.01, 1000)? / off(0.005, 2000)?;
/// assert!((ratio - 4.0).abs() < 0.2, "{ratio}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is no constraint on two bodies",
    label = "not a joint",
    note = "joints are `BallJoint`, `PinJoint`, and what `#[constraint(…)]` declares"
)]
pub trait Constraint<const K: usize>: Debug + Send + Sync + 'static {
    /// Checks the parameters.
    ///
    /// # Errors
    ///
    /// [`SetupError::Parameter`] names the first field with an invalid value.
    fn validate(&self) -> Result<(), SetupError>;

    /// The name, by which descriptions distinguish two kinds with the same parameters.
    fn name(&self) -> &'static str;

    /// The functions, each in a unit of its own: m for lengths, 1 for cosines.
    fn gap(&self, above: &Place, below: &Place) -> SVector<f64, K>;

    /// The derivatives of the functions by the place of the body above, and of the body below: each row in the unit of
    /// its function per radian and per m.
    fn slope(&self, above: &Place, below: &Place) -> [Slope<K>; 2];

    /// Visits the parameters.
    fn describe(&self, visit: &mut dyn FnMut(&'static str, f64));
}

/// The coincidence of a point of one body with a point of another: three functions, m.
///
/// ```text
/// x_b + R_b ρ_b − x_a − R_a ρ_a = 0
/// ```
///
/// For a pivot, space takes the place of the body above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BallJoint {
    /// The joint `ρ_a`, in the axes of the body above, or of space for a pivot, m.
    pub above: Vector3<f64>,
    /// The joint `ρ_b`, in the axes of the body below, m.
    pub below: Vector3<f64>,
}

/// A [`BallJoint`] whose bodies turn against each other about one axis alone: five functions.
///
/// ```text
/// x_b + R_b ρ_b − x_a − R_a ρ_a = 0          R_a e_1 · R_b n_b = R_a e_2 · R_b n_b = 0
/// ```
///
/// Here `e_1` and `e_2` are at right angles to the axis `n_a`. The sign of an axis doesn't matter: axes that start
/// parallel stay parallel, and opposite ones opposite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PinJoint {
    /// The joint `ρ_a`, in the axes of the body above, or of space for a pivot, m.
    pub above: Vector3<f64>,
    /// The joint `ρ_b`, in the axes of the body below, m.
    pub below: Vector3<f64>,
    /// The axis `n_a`, in the axes of the body above, of any length.
    pub axis_above: Vector3<f64>,
    /// The axis `n_b`, in the axes of the body below, of any length.
    pub axis_below: Vector3<f64>,
}

/// Checks that these vectors are finite.
fn check<const C: usize>(fields: [(&'static str, &Vector3<f64>); C]) -> Result<(), SetupError> {
    match fields.iter().find(|(_, vector)| !vector.iter().all(|entry| entry.is_finite())) {
        Some((field, _)) => Err(SetupError::Parameter { field, cause: "is not finite" }),
        None => Ok(()),
    }
}

fn describe<const C: usize>(fields: [(&'static str, &Vector3<f64>); C], visit: &mut dyn FnMut(&'static str, f64)) {
    for (field, vector) in fields {
        vector.iter().for_each(|&entry| visit(field, entry));
    }
}

impl Constraint<3> for BallJoint {
    fn name(&self) -> &'static str {
        "ball joint"
    }

    fn validate(&self) -> Result<(), SetupError> {
        check([("above", &self.above), ("below", &self.below)])
    }

    #[hot]
    fn gap(&self, above: &Place, below: &Place) -> Vector3<f64> {
        below.of(&self.below) - above.of(&self.above)
    }

    #[hot]
    fn slope(&self, above: &Place, below: &Place) -> [Slope<3>; 2] {
        let arm = |place: &Place, point: &Vector3<f64>| (place.attitude * point).cross_matrix();
        [
            Slope { turn: arm(above, &self.above), shift: -Matrix3::identity() },
            Slope { turn: -arm(below, &self.below), shift: Matrix3::identity() },
        ]
    }

    fn describe(&self, visit: &mut dyn FnMut(&'static str, f64)) {
        describe([("above", &self.above), ("below", &self.below)], visit);
    }
}

impl PinJoint {
    fn ball(&self) -> BallJoint {
        BallJoint { above: self.above, below: self.below }
    }

    /// The unit vectors `R_a e_1`, `R_a e_2` and `R_b n_b`.
    fn directions(&self, above: &Place, below: &Place) -> ([Vector3<f64>; 2], Vector3<f64>) {
        let axis = self.axis_above.normalize();
        // The coordinate axis that is farthest from the pin's axis.
        let far = Vector3::ith(axis.iamin(), 1.0);
        let first = axis.cross(&far).normalize();
        let normals = [first, axis.cross(&first)].map(|normal| above.attitude * normal);
        (normals, below.attitude * self.axis_below.normalize())
    }
}

impl Constraint<5> for PinJoint {
    fn name(&self) -> &'static str {
        "pin"
    }

    fn validate(&self) -> Result<(), SetupError> {
        self.ball().validate()?;
        for (field, axis) in [("axis_above", &self.axis_above), ("axis_below", &self.axis_below)] {
            check([(field, axis)])?;
            let size = axis.norm_squared();
            if !(size > 0.0 && size.is_finite() && (1.0 / size).is_finite()) {
                return Err(SetupError::Parameter { field, cause: "has no direction" });
            }
        }
        Ok(())
    }

    fn gap(&self, above: &Place, below: &Place) -> SVector<f64, 5> {
        let ball = self.ball().gap(above, below);
        let ([first, second], axis) = self.directions(above, below);
        SVector::from([ball.x, ball.y, ball.z, first.dot(&axis), second.dot(&axis)])
    }

    fn slope(&self, above: &Place, below: &Place) -> [Slope<5>; 2] {
        let ball = self.ball().slope(above, below).map(|slope| lengthened(&slope));
        let (normals, axis) = self.directions(above, below);
        let [mut above, mut below] = ball;
        for (row, normal) in normals.iter().enumerate() {
            // η_a × e · n = η_a · (e × n); the body below has the opposite sign.
            let turn = normal.cross(&axis);
            above.turn.set_row(3 + row, &turn.transpose());
            below.turn.set_row(3 + row, &-turn.transpose());
        }
        [above, below]
    }

    fn describe(&self, visit: &mut dyn FnMut(&'static str, f64)) {
        self.ball().describe(visit);
        describe([("axis_above", &self.axis_above), ("axis_below", &self.axis_below)], visit);
    }
}

/// The slope of a ball joint, padded with rows of zeros.
fn lengthened(slope: &Slope<3>) -> Slope<5> {
    let zero = SMatrix::<f64, 5, 3>::zeros();
    let mut all = Slope { turn: zero, shift: zero };
    all.turn.fixed_rows_mut::<3>(0).copy_from(&slope.turn);
    all.shift.fixed_rows_mut::<3>(0).copy_from(&slope.shift);
    all
}
