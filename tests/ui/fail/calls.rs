use liestep::accuracy::Accuracy;
use liestep::effects::{Dipole, Drag, Gravity, PrincipalBody, RigidBody, Torque};
use liestep::groups::SE2;
use liestep::mechanics::{Each, Sum};
use liestep::methods::{CompositionScheme, Constraint, CotangentGauss, SplittingScheme, SymmetricBody};
use liestep::motion::{DiscreteEulerPoincare, RightHandSide};
use liestep::{NonstandardInertia, SO3, State, Stepper, lagrangian};
use nalgebra::Vector3;

fn accuracy_of_a_damped_scene(body: RigidBody, drag: Drag, accuracy: Accuracy) {
    let _ = Stepper::for_accuracy(body + drag, accuracy, SO3::identity(), Vector3::z());
}

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    l_d = ((F_1 - I) * J_1 * (F_1 - I).transpose()).trace() / (2.0 * h)
        + ((F_2 - I) * J_2 * (F_2 - I).transpose()).trace() / (2.0 * h),
)]
struct BodiesInCollocation {
    J_1: NonstandardInertia,
    J_2: NonstandardInertia,
}

fn bodies_in_collocation() {
    let J = NonstandardInertia::from_diagonal(nalgebra::Vector3::new(2.0, 2.0, 1.0)).unwrap();
    let _ = CotangentGauss::<_, 2, 6>::new(BodiesInCollocation { J_1: J, J_2: J }, 0.1);
}

fn collocation_of_a_damped_scene(body: RigidBody, drag: Drag) {
    let _ = Stepper::collocated::<4>(body + drag, 0.1);
}

fn compensated_collocation() {
    let body = RigidBody { J_d: NonstandardInertia::from_diagonal(Vector3::new(2.0, 2.0, 1.0)).unwrap() };
    let _ = Stepper::collocated::<4>(body, 0.1).unwrap().compensated();
}

fn composition_of_a_damped_scene(body: RigidBody, drag: Drag) {
    let _ = Stepper::composed(body + drag, 0.01, CompositionScheme::KAHAN_LI_8); // is right: steps of −h undo drag
}

fn force_alone() {
    let _ = Stepper::new(Torque { torque: Vector3::z() }, 0.01);
}

fn force_as_a_lagrangian(body: RigidBody, torque: Torque) {
    let _ = DiscreteEulerPoincare::new(body + torque, 0.01);
}

fn gradients_backwards_of_a_damped_scene(body: RigidBody, drag: Drag) {
    let stepper = Stepper::new(body + drag, 0.01).unwrap();
    let _ = stepper.linearised().unwrap().backwards();
}

#[lagrangian(group = SO3, advected(w = up), l_d = -0.5 * h * weight * w.dot(&(rho + F * rho)))]
struct GradientsNotAskedFor {
    weight: f64,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

fn gradients_not_asked_for(body: RigidBody, weight: GradientsNotAskedFor) {
    let _ = Stepper::new(body + weight, 0.01).unwrap().linearised();
}

fn gradients_of_collocation(body: RigidBody) {
    let _ = Stepper::collocated::<4>(body, 0.1).unwrap().linearised();
}

fn inverse_of_a_damped_scene(damped: &Stepper<Sum<RigidBody, Drag>>) {
    let _ = damped.inverse();
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct JointWithoutAConstraint {
    above: Vector3<f64>,
    length: f64,
}

fn gap(joint: impl Constraint<1>) -> &'static str {
    joint.name()
}

fn joint_without_a_constraint() {
    gap(JointWithoutAConstraint { above: Vector3::zeros(), length: 1.0 });
}

fn momentum_along_of_a_damped_scene(J_d: NonstandardInertia, gravity: Gravity, drag: Drag) -> f64 {
    let stepper = Stepper::new(RigidBody { J_d } + gravity + drag, 0.01).unwrap();
    let state = stepper.start(nalgebra::UnitQuaternion::identity(), Vector3::z()).unwrap();
    stepper.momentum_along_advected(&state)
}

fn momentum_along_one_of_two(J_d: NonstandardInertia, gravity: Gravity, dipole: Dipole) -> f64 {
    let stepper = Stepper::new(RigidBody { J_d } + gravity + dipole, 0.01).unwrap();
    let state = stepper.start(nalgebra::UnitQuaternion::identity(), Vector3::z()).unwrap();
    stepper.momentum_along_advected(&state)
}

fn spatial_momentum_of_a_damped_body(
    stepper: &Stepper<Sum<RigidBody, Drag>>,
    state: &State<SO3, ((), ())>,
) -> Vector3<f64> {
    stepper.spatial_momentum(state)
}

fn spatial_momentum_of_a_heavy_body(
    stepper: &Stepper<Sum<RigidBody, Gravity>>,
    state: &State<SO3, ((), Vector3<f64>)>,
) -> Vector3<f64> {
    stepper.spatial_momentum(state)
}

fn splitting_of_a_damped_scene(body: PrincipalBody, gravity: Gravity, drag: Drag, kinetic: SymmetricBody) {
    let _ = Stepper::split(body + gravity + drag, 0.01, kinetic, SplittingScheme::STRANG);
}

#[lagrangian(group = SO3, l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
struct SumByHand {
    J_d: NonstandardInertia,
}

impl core::ops::Add for SumByHand {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        other
    }
}

#[lagrangian(group = SO3, l_d = ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h))]
#[derive(Clone, Copy)]
struct SystemAsAnOde {
    J: NonstandardInertia,
}

fn system_as_an_ode(body: SystemAsAnOde) {
    let _ = RightHandSide::new(Each::<2>::of([body, body]));
}

fn term_alone() {
    let gravity = Gravity { m: 1.0, g: 9.81, rho: Vector3::z(), up: Vector3::z() };
    let _ = Stepper::new(gravity, 0.01);
}

#[lagrangian(group = SE2, l_d = m * ((F - I) * (F - I).transpose()).trace() / (2.0 * h))]
struct TermsOfDifferentGroups {
    m: f64,
}

fn terms_of_different_groups() {
    let gravity = Gravity { m: 1.0, g: 9.81, rho: Vector3::z(), up: Vector3::z() };
    let _ = TermsOfDifferentGroups { m: 1.0 } + gravity;
}

fn values_for_collocation() {
    let body = RigidBody { J_d: NonstandardInertia::from_diagonal(Vector3::new(2.0, 2.0, 1.0)).unwrap() };
    let gravity = Gravity { m: 1.0, g: 9.81, rho: Vector3::z(), up: Vector3::z() };
    let stepper = Stepper::collocated::<4>(body + gravity, 0.1).unwrap();
    let mut state = stepper.start(SO3::identity(), Vector3::zeros()).unwrap();
    stepper.step_with(&mut state, &((), Vector3::x())).unwrap();
}

fn main() {}
