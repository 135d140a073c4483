use liestep::methods::CotangentGauss;
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

fn main() {
    let J = NonstandardInertia::from_diagonal(nalgebra::Vector3::new(2.0, 2.0, 1.0)).unwrap();
    let _ = CotangentGauss::<_, 2, 6>::new(Bodies { J_1: J, J_2: J }, 0.1);
}
