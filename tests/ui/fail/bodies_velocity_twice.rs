use liestep::mechanics::Inertia;
use liestep::{SO3, lagrangian};

#[lagrangian(group(F_1 = SO3, F_2 = SO3), velocity(Omega, Omega), l = 0.5 * Omega.dot(&(J * Omega)))]
struct Bodies {
    J: Inertia,
}

fn main() {}
