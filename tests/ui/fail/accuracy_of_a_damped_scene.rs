use liestep::effects::{Drag, RigidBody};
use liestep::{Accuracy, LieGroup, SO3, Stepper, Sum};
use nalgebra::Vector3;

fn claim(damped: Sum<RigidBody, Drag>, accuracy: Accuracy) {
    let _ = Stepper::for_accuracy(damped, accuracy, SO3::identity(), Vector3::zeros());
}

fn main() {}
