use liestep::mechanics::Inertia;
use liestep::{SO3, lagrangian};

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    velocity = (Omega_1, Omega_2),
    l = 0.5 * Omega_1.dot(&(J * Omega_1)) + 0.5 * Omega_2.dot(&(J * Omega_2)),
)]
struct Bodies {
    J: Inertia,
}

fn main() {}
