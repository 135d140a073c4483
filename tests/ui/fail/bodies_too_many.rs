use liestep::groups::R3;
use liestep::{SO3, lagrangian};

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3, d_1 = R3, d_2 = R3, d_3 = R3),
    l_d = m * d_1.norm_squared() / (2.0 * h),
)]
struct Bodies {
    m: f64,
}

fn main() {}
