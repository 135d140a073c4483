use liestep::effects::{Drag, RigidBody};
use liestep::{SO3, Stepper};
use liestep::accuracy::Accuracy;
use liestep::mechanics::Sum;
use nalgebra::Vector3;

fn claim(damped: Sum<RigidBody, Drag>, accuracy: Accuracy) {
    let _ = Stepper::for_accuracy(damped, accuracy, SO3::identity(), Vector3::zeros());
}

fn main() {}
