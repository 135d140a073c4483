use liestep::effects::{Drag, Gravity, PrincipalBody};
use liestep::{SplittingScheme, Stepper, SymmetricBody};

fn claim(body: PrincipalBody, gravity: Gravity, drag: Drag, kinetic: SymmetricBody) {
    let _ = Stepper::split(body + gravity + drag, 0.01, kinetic, SplittingScheme::STRANG);
}

fn main() {}
