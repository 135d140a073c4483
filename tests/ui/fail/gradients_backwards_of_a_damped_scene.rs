use liestep::Stepper;
use liestep::effects::{Drag, RigidBody};

fn claim(body: RigidBody, drag: Drag) {
    let stepper = Stepper::new(body + drag, 0.01).unwrap();
    let _ = stepper.linearised().unwrap().backwards();
}

fn main() {}
