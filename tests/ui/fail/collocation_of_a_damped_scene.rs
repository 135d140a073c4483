use liestep::effects::{Drag, RigidBody};
use liestep::Stepper;

fn collocate(body: RigidBody, drag: Drag) {
    let _ = Stepper::collocated::<4>(body + drag, 0.1);
}

fn main() {}
