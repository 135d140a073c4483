use liestep::{NonstandardInertia, SO3, Stepper, lagrangian};
use liestep::mechanics::{Effect, Term as _};

#[lagrangian(group = SO3 l_d = (F * J_d).trace() / h)]
struct Top {
    J_d: NonstandardInertia,
}

fn run(top: Top) {
    let stepper = Stepper::new(top, 0.01).unwrap();
    println!("{} {}", stepper.scene().validate().is_ok(), Top::DERIVATION);
}

fn main() {}
