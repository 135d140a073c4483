//! Items with the names that an expansion might use, and with those of the declared syntax.

#![allow(dead_code, non_camel_case_types, non_upper_case_globals)]

use liestep::{SO3, Stepper, lagrangian};

mod core {}
mod std {}
mod nalgebra {}
mod liestep_macros {}

struct Option;
struct Result;
struct Ok;
struct Err;
struct Vec;
struct Copy;
trait Clone {}
trait DiscreteLagrangian {}
trait Real {}
struct f64;
struct str;
struct Matrix3;
struct CayleyRetraction;
fn vee() {}
fn real() {}

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = ((F - I) * inertia * (F - I).transpose()).trace() / (2.0 * h)
        - 0.5 * h * w.dot(&(rho + F * rho)) - h.powi(3) * (vee(F).dot(&rho) / h).powi(2),
)]
struct Top {
    inertia: liestep::NonstandardInertia,
    rho: ::nalgebra::Vector3<::core::primitive::f64>,
    up: ::nalgebra::Vector3<::core::primitive::f64>,
}

/// The names of displacements have a meaning in forces; in a Lagrangian they are names like others.
#[lagrangian(
    group = SO3,
    advected(eta = up),
    l_d = ((F - I) * inertia * (F - I).transpose()).trace() / (2.0 * h) - 0.5 * h * eta.dot(&(eta_next + F * eta_next)),
)]
struct Efficiency {
    inertia: liestep::NonstandardInertia,
    eta_next: ::nalgebra::Vector3<::core::primitive::f64>,
    up: ::nalgebra::Vector3<::core::primitive::f64>,
}

/// The names of the type parameters that an implementation adds.
#[lagrangian(group = SO3, l_d = ((F - I) * inertia * (F - I).transpose()).trace() / (2.0 * h))]
struct Other<Several: liestep::numbers::Real> {
    inertia: liestep::NonstandardInertia<Several>,
}

pub fn main() {
    use ::nalgebra::Vector3;
    let inertia = liestep::NonstandardInertia::from_diagonal(Vector3::new(2.0, 2.0, 1.0)).unwrap();
    let stepper = Stepper::new(Top { inertia, rho: Vector3::z(), up: Vector3::z() }, 0.01).unwrap();
    let mut state = stepper.start(SO3::identity(), Vector3::new(0.1, 0.0, 5.0)).unwrap();
    stepper.step(&mut state).unwrap();
    assert_eq!(state.steps(), 1);
    let stepper = Stepper::new(Other { inertia } + Other { inertia }, 0.01).unwrap();
    let mut state = stepper.start(SO3::identity(), Vector3::new(0.1, 0.0, 5.0)).unwrap();
    stepper.step(&mut state).unwrap();
    assert_eq!(state.steps(), 1);
}
