use liestep::mechanics::Inertia;
use liestep::{SO3, lagrangian};

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    velocity(Omega_1, Omega_2),
    advected(Q = F_2.seen_from(F_1)),
    l = 0.5 * Omega_1.dot(&(J_1 * Omega_1)) + 0.5 * Omega_2.dot(&(J_2 * Omega_2)) - k * Omega_1.dot(&Omega_2) - k * Q.trace(),
)]
struct Side {
    J_1: Inertia,
    J_2: Inertia,
    k: f64,
}

fn main() {}
