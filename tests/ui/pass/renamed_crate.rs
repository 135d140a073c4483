//! The crate liestep under another name, through a module that re-exports it.

extern crate liestep as renamed;

mod physics {
    pub mod steps {
        pub use renamed::*;
    }
}

/// Hides the crate from paths that start at the root of this one.
mod liestep {}

#[physics::steps::lagrangian(
    group = physics::steps::SO3,
    advected(w = up),
    l_d = ((F - I) * inertia * (F - I).transpose()).trace() / (2.0 * h) - 0.5 * h * w.dot(&(rho + F * rho)),
    crate = crate::physics::steps,
)]
struct Top {
    inertia: physics::steps::NonstandardInertia,
    rho: nalgebra::Vector3<f64>,
    up: nalgebra::Vector3<f64>,
}

fn main() {
    use nalgebra::Vector3;
    use physics::steps::{NonstandardInertia, SO3, Stepper};
    let inertia = NonstandardInertia::from_diagonal(Vector3::new(2.0, 2.0, 1.0)).unwrap();
    let stepper = Stepper::new(Top { inertia, rho: Vector3::z(), up: Vector3::z() }, 0.01).unwrap();
    let mut state = stepper.start(SO3::identity(), Vector3::new(0.1, 0.0, 5.0)).unwrap();
    stepper.step(&mut state).unwrap();
    assert_eq!(state.steps(), 1);
}
