//! A unit struct and a constant with the names that the macro binds: a pattern would compare with them.

#![allow(dead_code)]

use liestep::{NonstandardInertia, SO3, Stepper, lagrangian};
use nalgebra::Vector3;

struct F;
const I: f64 = 0.3;

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = ((F - I) * inertia * (F - I).transpose()).trace() / (2.0 * h) - 0.5 * h * w.dot(&(rho + F * rho)),
)]
struct Top {
    inertia: NonstandardInertia,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

pub fn main() {
    let inertia = NonstandardInertia::from_diagonal(Vector3::new(2.0, 2.0, 1.0)).unwrap();
    let stepper = Stepper::new(Top { inertia, rho: Vector3::z(), up: Vector3::z() }, 0.01).unwrap();
    let mut state = stepper.start(SO3::identity(), Vector3::new(0.1, 0.0, 5.0)).unwrap();
    stepper.step(&mut state).unwrap();
    assert_eq!(state.steps(), 1);
}
