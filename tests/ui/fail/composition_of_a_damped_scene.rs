use liestep::effects::{Drag, RigidBody};
use liestep::{Composition, CompositionScheme};

fn claim(body: RigidBody, drag: Drag) {
    let _ = Composition::new(body + drag, 0.01, CompositionScheme::KAHAN_LI_8);
}

fn main() {}
