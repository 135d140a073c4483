use liestep::mechanics::Inertia;
use liestep::{SO3, lagrangian};

#[lagrangian(group(F_1 = SO3, F_2 = SO3), l = 0.5 * Omega.dot(&(J * Omega)) - F_2.trace())]
struct Bodies {
    J: Inertia,
}

fn main() {}
