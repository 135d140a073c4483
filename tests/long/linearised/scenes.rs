//! Sums of the library's effects, with a force, and methods composed of their steps.

use liestep::Stepper;
use liestep::effects::{CayleyBody, Dipole, Drag, GeodesicBody, Gravity, GravityGradient, MagneticDamping};
use liestep::effects::{PrincipalBody, RigidBody, Rotor, Spring};
use liestep::mechanics::{DiagonalNonstandardInertia, Inertia, NonstandardInertia, Sum};
use liestep::methods::{CompositionScheme, ExactBody, SplittingScheme, SymmetricBody};
use nalgebra::{Matrix3, RealField, Vector3};
use num_dual::Dual64;

use super::dual::{STEP, assert_linearised};

/// The parameters of the scene, one of which may have a derivative; the entries of a symmetric matrix vary together.
pub(crate) struct Numbers<T> {
    next: usize,
    varied: Option<(usize, T)>,
}

impl<T: RealField + Copy> Numbers<T> {
    pub(crate) fn new(varied: Option<(usize, T)>) -> Self {
        Self { next: 0, varied }
    }

    pub(crate) fn number(&mut self, value: f64) -> T {
        self.next += 1;
        let value: T = nalgebra::convert(value);
        self.varied.filter(|(number, _)| number + 1 == self.next).map_or(value, |(_, unit)| value + unit)
    }

    pub(crate) fn vector(&mut self, x: f64, y: f64, z: f64) -> Vector3<T> {
        Vector3::new(self.number(x), self.number(y), self.number(z))
    }

    pub(crate) fn symmetric(&mut self, value: &Matrix3<f64>) -> Matrix3<T> {
        let rows = [0, 1, 2].map(|row| [0, 1, 2].map(|column| self.number(value[(row, column)])));
        let matrix = Matrix3::from_fn(|row, column| rows[row][column]);
        (matrix + matrix.transpose()) * nalgebra::convert::<f64, T>(0.5)
    }

    fn diagonal(&mut self, x: f64, y: f64, z: f64) -> Vector3<T> {
        let first = self.next;
        let moments = [x, y, z].map(|moment| nalgebra::convert::<f64, T>(moment));
        self.next += 9;
        Vector3::from_fn(|k, _| match self.varied {
            Some((number, unit)) if number == first + 4 * k => moments[k] + unit,
            _ => moments[k],
        })
    }
}

pub(crate) fn unit(number: Option<usize>) -> Option<(usize, Dual64)> {
    number.map(|number| (number, Dual64::new(0.0, 1.0)))
}

pub(crate) const J_D: Matrix3<f64> = Matrix3::new(2.0, 0.2, -0.1, 0.2, 1.6, 0.3, -0.1, 0.3, 2.4);

pub(crate) type SpringTop<T> = Sum<Sum<Sum<RigidBody<T>, Gravity<T>>, Spring<T>>, GravityGradient<T>>;

/// A body under three potentials.
pub(crate) fn held<T: RealField + Copy>(n: &mut Numbers<T>) -> SpringTop<T> {
    let body = RigidBody { J_d: NonstandardInertia::new(n.symmetric(&J_D)).expect("a body") };
    let gravity = gravity(n);
    let spring = Spring {
        k: n.number(1.5),
        length: n.number(0.4),
        at: n.vector(0.1, 0.5, -0.3),
        anchor: n.vector(0.8, -0.2, 0.9),
    };
    let gradient =
        GravityGradient { GM: n.number(0.7), r: n.number(1.3), J: inertia(n), direction: n.vector(0.6, 0.0, 0.8) };
    body + gravity + spring + gradient
}

fn inertia<T: RealField + Copy>(n: &mut Numbers<T>) -> Inertia<T> {
    let J = Matrix3::identity() * J_D.trace() - J_D;
    Inertia::new(n.symmetric(&J)).expect("a body")
}

type DampedTop<T> = Sum<Sum<SpringTop<T>, Rotor<T>>, Drag<T>>;

fn damped<T: RealField + Copy>(varied: Option<(usize, T)>) -> DampedTop<T> {
    let mut n = Numbers::new(varied);
    let held = held(&mut n);
    let rotor = Rotor { spin: n.vector(0.3, -0.2, 0.5) };
    let drag = Drag { c: n.number(0.4), J: inertia(&mut n) };
    held + rotor + drag
}

pub(crate) fn gravity<T: RealField + Copy>(n: &mut Numbers<T>) -> Gravity<T> {
    let (m, g) = (n.number(1.2), n.number(9.81));
    Gravity { m, g, rho: n.vector(0.3, 0.2, 0.4), up: n.vector(0.0, 0.6, 0.8) }
}

pub(crate) type Top<T> = Sum<PrincipalBody<T>, Gravity<T>>;

pub(crate) fn top<T: RealField + Copy>(varied: Option<(usize, T)>) -> Top<T> {
    let mut n = Numbers::new(varied);
    let J_d = DiagonalNonstandardInertia::from_diagonal(n.diagonal(2.0, 1.5, 1.0)).expect("a body");
    PrincipalBody { J_d } + gravity(&mut n)
}

#[test]
fn a_damped_scene() {
    let stepper = Stepper::new(damped::<f64>(None), STEP).expect("a stepper");
    let dual = |number| Stepper::new(damped(unit(number)), STEP.into()).expect("a stepper");
    assert_linearised(&stepper, dual);
}

type Magnetic<T> = Sum<Sum<Sum<GeodesicBody<T>, CayleyBody<T>>, Dipole<T>>, MagneticDamping<T>>;

/// A body with both kinetic terms: their derivatives contain a logarithm, and a quotient.
fn magnetic<T: RealField + Copy>(varied: Option<(usize, T)>) -> Magnetic<T> {
    let mut n = Numbers::new(varied);
    let J = Matrix3::identity() * J_D.trace() - J_D;
    let inertia = |n: &mut Numbers<T>| Inertia::new(n.symmetric(&J)).expect("a body");
    let geodesic = GeodesicBody { J: inertia(&mut n) };
    let cayley = CayleyBody { J: inertia(&mut n) };
    let dipole = Dipole { moment: n.vector(0.7, -0.4, 0.2), field: n.vector(0.3, 0.9, -0.5) };
    let damping = MagneticDamping { k: n.number(0.4), field: n.vector(0.3, 0.9, -0.5), J: inertia(&mut n) };
    geodesic + cayley + dipole + damping
}

#[test]
fn a_magnet() {
    let stepper = Stepper::new(magnetic::<f64>(None), STEP).expect("a stepper");
    let dual = |number| Stepper::new(magnetic(unit(number)), STEP.into()).expect("a stepper");
    assert_linearised(&stepper, dual);
}

#[test]
fn a_composition() {
    let scheme = CompositionScheme::SUZUKI_4;
    let stepper = Stepper::composed(top::<f64>(None), STEP, scheme).expect("a stepper");
    let dual = |number| Stepper::composed(top(unit(number)), STEP.into(), scheme).expect("a stepper");
    assert_linearised(&stepper, dual);
}

/// The flow's inertia is a parameter of its own, after those of the scene: if both vary, both derivatives add.
#[test]
fn a_splitting() {
    // Schemes of three shares, and of more, that begin with a kick or with a drift.
    assert_split(SplittingScheme::STRANG);
    assert_split(SplittingScheme::NYSTROM_6);
    assert_split(SplittingScheme::NEAR_INTEGRABLE_8_6_4);
    assert_split(SplittingScheme::FORCE_GRADIENT_4);
}

fn assert_split(scheme: SplittingScheme) {
    let split = |number: Option<usize>| {
        // The scene's own inertia must equal the flow's to rounding, as a dual number's value does.
        let of_flow = number.filter(|&number| number >= 17).map(|number| number - 17);
        let scene = top(unit(number.filter(|&number| number < 17)));
        Stepper::split(scene, STEP.into(), top(unit(of_flow)).first, scheme).expect("a stepper")
    };
    let scene = top::<f64>(None);
    let stepper = Stepper::split(scene, STEP, scene.first, scheme).expect("a stepper");
    assert_linearised(&stepper, split);
}

/// Weights on the third axis of a symmetric body, where its spin is merged, and beside it; short and long drifts. The
/// dual numbers' weight is always beside the axis, by less than a rounding: otherwise they would differentiate the
/// merged spin, which isn't the derivative towards a weight beside the axis.
#[test]
fn a_splitting_with_the_flow_of_a_symmetric_body() {
    for (scheme, h) in [
        (SplittingScheme::STRANG, STEP),
        (SplittingScheme::NYSTROM_6, 0.7),
        (SplittingScheme::NEAR_INTEGRABLE_8_6_4, 0.2),
        (SplittingScheme::FORCE_GRADIENT_4, 0.2),
    ] {
        assert_symmetric(0.2, h, scheme);
        assert_symmetric(0.0, h, scheme);
    }
}

fn symmetric_top<T: RealField + Copy>(beside: f64, varied: Option<(usize, T)>) -> Sum<PrincipalBody<T>, Gravity<T>> {
    let mut n = Numbers::new(varied);
    let J_d = DiagonalNonstandardInertia::from_diagonal(n.diagonal(2.0, 2.0, 1.0)).expect("a body");
    let (m, g) = (n.number(1.2), n.number(9.81));
    let rho = n.vector(beside, -0.5 * beside, 0.4);
    PrincipalBody { J_d } + Gravity { m, g, rho, up: n.vector(0.0, 0.6, 0.8) }
}

fn symmetric_flow<T: RealField + Copy>(varied: Option<(usize, T)>) -> SymmetricBody<T> {
    let mut n = Numbers::new(varied);
    let (transverse, axial) = (n.number(3.0), n.number(4.0));
    let inertia = Inertia::from_principal_moments(Vector3::new(transverse, transverse, axial)).expect("a body");
    SymmetricBody::new(&inertia).expect("a symmetric body")
}

fn assert_symmetric(beside: f64, h: f64, scheme: SplittingScheme) {
    let split = |number: Option<usize>| {
        let of_flow = number.filter(|&number| number >= 17).map(|number| number - 17);
        let scene =
            symmetric_top(if beside > 0.0 { beside } else { 1e-100 }, unit(number.filter(|&number| number < 17)));
        Stepper::split(scene, h.into(), symmetric_flow(unit(of_flow)), scheme).expect("a stepper")
    };
    let stepper = Stepper::split(symmetric_top(beside, None), h, symmetric_flow(None), scheme).expect("a stepper");
    let linear = stepper.linearised().expect("derivatives");
    assert_eq!(linear.numbers(2, "axial"), Some(18..19));
    assert_linearised(&stepper, split);
}

/// The principal axes, and their turn per unit of each of the flow's last three parameters.
pub(crate) fn exact_flow<T: RealField + Copy>(
    moments: [f64; 3],
    axes: &Matrix3<f64>,
    varied: Option<(usize, T)>,
) -> ExactBody<T> {
    let lift = |value: f64| nalgebra::convert::<f64, T>(value);
    let mut n = Numbers::new(varied);
    // The off-diagonal entries are less than a rounding but not zero, because zeros aren't evaluated.
    let (moments, zero) = (moments.map(|moment| n.number(moment)), varied.map_or(T::zero(), |_| lift(1e-100)));
    let turn = [0, 1, 2].map(|_| n.number(0.0));
    let axes = axes.map(lift);
    let inertia = axes * Matrix3::from_diagonal(&Vector3::from(moments)) * axes.transpose();
    let turn = Vector3::from(turn).cross_matrix();
    let inertia = inertia + turn * inertia - inertia * turn;
    let inertia = (inertia + inertia.transpose()) * lift(0.5);
    let beside = Matrix3::from_fn(|i, j| if i == j { T::zero() } else { zero });
    ExactBody::new(&Inertia::new(inertia + beside).expect("a body"))
}

/// The largest, the least and the middle moment.
pub(crate) const MOMENTS: [f64; 3] = [3.5, 2.5, 3.0];

pub(crate) fn heavy<T: RealField + Copy>(
    moments: [f64; 3],
    axes: &Matrix3<f64>,
    g: f64,
    varied: Option<(usize, T)>,
) -> Sum<RigidBody<T>, Gravity<T>> {
    let mut n = Numbers::new(varied);
    let inertia = axes * Matrix3::from_diagonal(&Vector3::from(moments)) * axes.transpose();
    let J_d = Matrix3::identity() * (0.5 * inertia.trace()) - inertia;
    let body = RigidBody { J_d: NonstandardInertia::new(n.symmetric(&J_d)).expect("a body") };
    let (m, g) = (n.number(1.2), n.number(g));
    body + Gravity { m, g, rho: n.vector(0.3, 0.2, 0.4), up: n.vector(0.0, 0.6, 0.8) }
}

/// Short and longer drifts, along the axes of the body and along others.
#[test]
fn a_splitting_with_the_flow_of_any_body() {
    let turned = nalgebra::Rotation3::new(Vector3::new(0.4, -0.3, 0.7)).into_inner();
    // The middle moment is about the first axis, so that the moments are in another order.
    let cyclic = Matrix3::new(0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0);
    let (own, other) = ([0, 1, 2, 3, 4, 5], [2, 0, 1, 3, 4, 5]);
    let cases = [
        (Matrix3::identity(), STEP, own, 9.81),
        (cyclic, STEP, other, 9.81),
        (turned, STEP, own, 9.81),
        (turned, 0.7, own, 9.81),
        // Drifts up to the longer polynomials; `free_body` has those that are doubled.
        (turned, 6.0, own, 1e-3),
    ];
    for (axes, h, places, g) in cases {
        let scheme = SplittingScheme::NYSTROM_6;
        let split = |number: Option<usize>| {
            let of_flow = number.filter(|&number| number >= 17).map(|number| places[number - 17]);
            let scene = heavy(MOMENTS, &axes, g, unit(number.filter(|&number| number < 17)));
            Stepper::split(scene, h.into(), exact_flow(MOMENTS, &axes, unit(of_flow)), scheme).expect("a stepper")
        };
        let stepper = Stepper::split(heavy(MOMENTS, &axes, g, None), h, exact_flow(MOMENTS, &axes, None), scheme)
            .expect("a stepper");
        assert_linearised(&stepper, split);
    }
}

#[test]
fn parameters_have_their_fields_names() {
    let stepper = Stepper::new(damped::<f64>(None), STEP).expect("a stepper");
    let linear = stepper.linearised().expect("derivatives");
    let parameters = linear.parameters();
    assert_eq!(linear.numbers(1, "rho"), Some(11..14));
    assert_eq!(linear.numbers(5, "c").map(|numbers| parameters[numbers.start].value), Some(0.4));
    assert_eq!(linear.numbers(5, "rho"), None);
    assert_eq!(linear.numbers(6, "c"), None);
}

/// The tangent of a composition hasn't the parameters of a splitting's flow.
#[test]
#[should_panic(expected = "a plan with 17 parameters, and this one has 26")]
fn the_tangent_of_another_plan_is_refused() {
    let scene = top::<f64>(None);
    let own = Stepper::new(scene, STEP).expect("a stepper");
    let split = Stepper::split(scene, STEP, scene.first, SplittingScheme::STRANG).expect("a stepper");
    let mut tangent = own.linearised().expect("derivatives").tangent(&[0]);
    let mut state =
        split.start(liestep::SO3::from_matrix_unchecked(Matrix3::identity()), Vector3::x()).expect("a start");
    let _ = split.linearised().expect("derivatives").step(&mut state, &mut tangent);
}

/// A step of zero length has zero derivatives with respect to all parameters.
#[test]
fn without_a_step_nothing_moves() {
    let stepper = Stepper::new(top::<f64>(None), 0.0).expect("a stepper");
    let linear = stepper.linearised().expect("derivatives");
    let mut state =
        stepper.start(liestep::SO3::from_matrix_unchecked(Matrix3::identity()), Vector3::x()).expect("a start");
    let mut tangent = linear.tangent(&[0]);
    let before: Vec<_> = tangent.columns().collect();
    linear.step(&mut state, &mut tangent).expect("a step");
    assert_eq!(before, tangent.columns().collect::<Vec<_>>());
}
