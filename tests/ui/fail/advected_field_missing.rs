use liestep::{NonstandardInertia, SO3, Stepper, lagrangian};
use liestep::mechanics::{Effect, Term as _};
use nalgebra::Vector3;

#[lagrangian(
    group = SO3,
    advected(w = upp),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - h * w.dot(&(rho + F * rho)),
)]
struct Top {
    J_d: NonstandardInertia,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

fn run(top: Top) {
    let stepper = Stepper::new(top, 0.01).unwrap();
    println!("{} {}", stepper.scene().validate().is_ok(), Top::DERIVATION);
}

fn main() {}
