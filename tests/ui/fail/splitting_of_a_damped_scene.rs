use liestep::effects::{Drag, Gravity, PrincipalBody};
use liestep::{Splitting, SplittingScheme, SymmetricBody};

fn claim(body: PrincipalBody, gravity: Gravity, drag: Drag, kinetic: SymmetricBody) {
    let _ = Splitting::new(body + gravity + drag, kinetic, 0.01, SplittingScheme::STRANG);
}

fn main() {}
