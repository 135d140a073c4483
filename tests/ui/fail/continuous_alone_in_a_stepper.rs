use liestep::mechanics::Inertia;
use liestep::{SO3, Stepper, lagrangian};

#[lagrangian(group = SO3, velocity = Omega, l = 0.5 * Omega.dot(&(J * Omega)))]
struct Body {
    J: Inertia,
}

fn step(body: Body) {
    let _ = Stepper::new(body, 0.01);
}

fn main() {}
