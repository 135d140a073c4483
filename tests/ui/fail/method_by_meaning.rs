use liestep::{NonstandardInertia, SO3, lagrangian};
use nalgebra::Vector3;

#[lagrangian(
    group = SO3,
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)
        - h * m.tan()
        - h * F.log().norm()
        - h * F.inverse().trace()
        - h * m.inverse()
        - h * m.log(2.0)
        - h * F.row(0).norm()
        - h * F.map(m)
        - h * m.acos()
        - h * m.cbrt()
        - h * m.len()
        - h * m.sinh()
        - h * m.powf(2.0)
        - h * rho.exp()
        - h * rho.normalize().x
        - h * rho.hat()
        - h * (F * J_d).try_inverse().trace()
        - h * m.squrt(),
)]
struct Body {
    J_d: NonstandardInertia,
    m: f64,
    rho: Vector3<f64>,
}

fn main() {}
