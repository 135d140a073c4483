use liestep::{NonstandardInertia, SO3, lagrangian};
use nalgebra::Vector3;

#[lagrangian(
    group = SO3,
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)
        - h * tan(m)
        - h * atan2(m, m)
        - h * trace(F)
        - h * dot(rho, rho)
        - h * tr(F)
        - h * skew(rho)[0]
        - h * abs(m)
        - h * Vector3::new(0.0, 0.0, 1.0)
        - h * inverze(F),
)]
struct Body {
    J_d: NonstandardInertia,
    m: f64,
    rho: Vector3<f64>,
}

fn main() {}
