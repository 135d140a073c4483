use liestep::{NonstandardInertia, SO3, lagrangian};
use nalgebra::Vector3;

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)
        - h * F.trace
        - h * (F * J_d).transpose.trace()
        - h * F.m33
        - h * F.x
        - h * rho.dot
        - h * rho.w
        - h * m.x
        - h * rho.0,
)]
struct Body {
    J_d: NonstandardInertia,
    m: f64,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

fn main() {}
