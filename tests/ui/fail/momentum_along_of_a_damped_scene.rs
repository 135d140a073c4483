use liestep::effects::{Drag, Gravity, RigidBody};
use liestep::{NonstandardInertia, Stepper};
use nalgebra::Vector3;

fn claim(J_d: NonstandardInertia, gravity: Gravity, drag: Drag) -> f64 {
    let stepper = Stepper::new(RigidBody { J_d } + gravity + drag, 0.01).unwrap();
    let state = stepper.start(nalgebra::UnitQuaternion::identity(), Vector3::z()).unwrap();
    stepper.momentum_along_advected(&state)
}

fn main() {}
