use liestep::mechanics::Inertia;
use liestep::{SO3, lagrangian};

#[lagrangian(group = SO3, velocity(Omega_1, Omega_2), l = 0.5 * Omega_1.dot(&(J * Omega_2)))]
struct Body {
    J: Inertia,
}

fn main() {}
