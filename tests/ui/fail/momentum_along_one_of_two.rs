use liestep::effects::{Dipole, Gravity, RigidBody};
use liestep::{NonstandardInertia, Stepper};
use nalgebra::Vector3;

fn claim(J_d: NonstandardInertia, gravity: Gravity, dipole: Dipole) -> f64 {
    let stepper = Stepper::new(RigidBody { J_d } + gravity + dipole, 0.01).unwrap();
    let state = stepper.start(nalgebra::UnitQuaternion::identity(), Vector3::z()).unwrap();
    stepper.momentum_along_advected(&state)
}

fn main() {}
