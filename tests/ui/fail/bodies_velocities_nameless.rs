use liestep::groups::R3;
use liestep::mechanics::Inertia;
use liestep::{SO3, lagrangian};

#[lagrangian(group(F_1 = SO3, d = R3, F_2 = SO3), velocity(), l = 0.5 * J.trace())]
struct Bodies {
    J: Inertia,
}

fn main() {}
