use liestep::{Effect, NonstandardInertia, Stepper, lagrangian};

#[lagrangian(group = SO4, l_d = (F * J_d).trace() / h)]
struct Top {
    J_d: NonstandardInertia,
}

fn run(top: Top) {
    let stepper = Stepper::new(top, 0.01).unwrap();
    println!("{} {}", stepper.lagrangian().inertia(), Top::DERIVATION);
}

fn main() {}
