//! A generic scalar, with bounds in either place, and with a constant that the Lagrangian doesn't use.

use core::fmt::Debug;

use liestep::numbers::Real;
use liestep::{NonstandardInertia, SO3, Stepper, lagrangian};
use nalgebra::{RealField, Vector3};

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = ((F - I) * inertia * (F - I).transpose()).trace() / (2.0 * h) - 0.5 * h * w.dot(&(rho + F * rho)),
)]
#[derive(Clone, Debug)]
struct Top<T: Real> {
    inertia: NonstandardInertia<T>,
    rho: Vector3<T>,
    up: Vector3<T>,
}

#[lagrangian(group = SO3, l_d = ((F - I) * inertia * (F - I).transpose()).trace() / (2.0 * h))]
struct Body<Scalar, const ID: usize>
where
    Scalar: Real + RealField,
    Vector3<Scalar>: Debug,
{
    inertia: NonstandardInertia<Scalar>,
}

fn inertia<T: Real + RealField>() -> NonstandardInertia<T> {
    let diagonal = Vector3::new(2.0, 2.0, 1.0).map(nalgebra::convert);
    NonstandardInertia::from_diagonal(diagonal).unwrap()
}

pub fn main() {
    let stepper = Stepper::new(Top { inertia: inertia(), rho: Vector3::z(), up: Vector3::z() }, 0.01_f64).unwrap();
    let mut state = stepper.start(SO3::identity(), Vector3::new(0.1, 0.0, 5.0)).unwrap();
    stepper.step(&mut state).unwrap();
    assert_eq!(state.steps(), 1);
    let stepper = Stepper::new(Body::<f32, 7> { inertia: inertia() }, 0.01).unwrap();
    let mut state = stepper.start(SO3::identity(), Vector3::new(0.1, 0.0, 5.0)).unwrap();
    stepper.step(&mut state).unwrap();
    assert_eq!(state.steps(), 1);
}
