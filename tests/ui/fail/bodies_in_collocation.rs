use liestep::methods::CotangentGauss;
use liestep::{NonstandardInertia, SO3, lagrangian};
use nalgebra::Vector6;

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    l_d = ((F_1 - I) * J_1 * (F_1 - I).transpose()).trace() / (2.0 * h)
        + ((F_2 - I) * J_2 * (F_2 - I).transpose()).trace() / (2.0 * h),
)]
struct Bodies {
    J_1: NonstandardInertia,
    J_2: NonstandardInertia,
}

fn motion(gauss: CotangentGauss<Bodies, 2, 6>, attitudes: (SO3, SO3), momentum: Vector6<f64>) {
    let _ = gauss.step(&attitudes, &momentum);
}

fn main() {}
