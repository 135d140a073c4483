//! Expressions that begin with a block, which at the beginning of a statement would be a statement by itself.

use liestep::mechanics::ContinuousLagrangian as _;
use liestep::{NonstandardInertia, SO3, Stepper, force, lagrangian};
use nalgebra::Vector3;

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = { let d = F - I; (d * J_d * d.transpose()).trace() / (2.0 * h) } - h * k * w.z,
)]
struct Top {
    J_d: NonstandardInertia,
    k: f64,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, velocity = omega, l = { let s = k * omega; s }.dot(&omega), discretise = trapezoid(Cayley))]
struct Rotor {
    k: f64,
}

#[force(group = SO3, work = { 0.5 * h } * torque.dot(&(eta + eta_next)))]
struct Torque {
    torque: Vector3<f64>,
}

pub fn main() {
    let inertia = NonstandardInertia::from_diagonal(Vector3::new(2.0, 2.0, 1.0)).unwrap();
    let rotor = Rotor { k: 0.5 };
    assert_eq!(rotor.l(&Vector3::x(), &()), 0.5);
    let scene = Top { J_d: inertia, k: 1.0, up: Vector3::z() } + rotor + Torque { torque: Vector3::x() };
    let stepper = Stepper::new(scene, 0.01).unwrap();
    let mut state = stepper.start(SO3::identity(), Vector3::new(0.1, 0.0, 5.0)).unwrap();
    stepper.step(&mut state).unwrap();
    assert_eq!(state.steps(), 1);
}
