use liestep::effects::{Drag, RigidBody};
use liestep::Stepper;
use liestep::methods::CompositionScheme;

fn claim(body: RigidBody, drag: Drag) {
    let _ = Stepper::composed(body + drag, 0.01, CompositionScheme::KAHAN_LI_8);
}

fn main() {}
