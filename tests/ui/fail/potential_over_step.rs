use liestep::{NonstandardInertia, SO3, lagrangian};
use nalgebra::Vector3;

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = h * (((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h * h) - m * w.dot(&rho) / h),
)]
struct Top {
    J_d: NonstandardInertia,
    m: f64,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

fn main() {}
