use liestep::accuracy::Accuracy;
use liestep::effects::{Drag, RigidBody};
use liestep::{SO3, Stepper};
use nalgebra::Vector3;

fn ask(body: RigidBody, drag: Drag, accuracy: Accuracy) {
    let _ = Stepper::for_accuracy(body + drag, accuracy, SO3::identity(), Vector3::z());
}

fn main() {}
