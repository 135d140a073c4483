use liestep::effects::{Drag, Gravity, PrincipalBody};
use liestep::Stepper;
use liestep::methods::{SplittingScheme, SymmetricBody};

fn claim(body: PrincipalBody, gravity: Gravity, drag: Drag, kinetic: SymmetricBody) {
    let _ = Stepper::split(body + gravity + drag, 0.01, kinetic, SplittingScheme::STRANG);
}

fn main() {}
