use liestep::{NonstandardInertia, SO3, lagrangian};
use nalgebra::Vector3;

#[lagrangian(
    group(F_1 = SO3, F_2 = SE3),
    advected(w = up.seen_from(F_1)),
    l_d = ((F_1 - I) * J_1 * (F_1 - I).transpose()).trace() / (2.0 * h)
        + ((F_2 - I) * J_2 * (F_2 - I).transpose()).trace() / (2.0 * h) - h * w.z,
)]
struct Bodies {
    J_1: NonstandardInertia,
    J_2: NonstandardInertia,
    up: Vector3<f64>,
}

fn main() {}
