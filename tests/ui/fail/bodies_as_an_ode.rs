use liestep::motion::RightHandSide;
use liestep::{NonstandardInertia, SO3, lagrangian};

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    l_d = ((F_1 - I) * J_1 * (F_1 - I).transpose()).trace() / (2.0 * h)
        + ((F_2 - I) * J_2 * (F_2 - I).transpose()).trace() / (2.0 * h),
)]
struct Bodies {
    J_1: NonstandardInertia,
    J_2: NonstandardInertia,
}

fn motion(bodies: Bodies) {
    let _ = RightHandSide::new(bodies);
}

fn main() {}
