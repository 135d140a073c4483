//! All parameters in single precision.

use liestep::{NonstandardInertia, SO3, Stepper, lagrangian};
use nalgebra::Vector3;

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = ((F - I) * inertia * (F - I).transpose()).trace() / (2.0 * h) - 0.5 * h * m * w.dot(&(rho + F * rho)),
)]
struct Top {
    inertia: NonstandardInertia<f32>,
    m: f32,
    rho: Vector3<f32>,
    up: Vector3<f32>,
}

pub fn main() {
    let inertia = NonstandardInertia::from_diagonal(Vector3::new(2.0, 2.0, 1.0)).unwrap();
    let top = Top { inertia, m: 9.81, rho: Vector3::z(), up: Vector3::z() };
    let stepper = Stepper::new(top, 0.01_f32).unwrap();
    let mut state = stepper.start(SO3::identity(), Vector3::new(0.1, 0.0, 5.0)).unwrap();
    stepper.step(&mut state).unwrap();
    assert_eq!(state.steps(), 1);
}
