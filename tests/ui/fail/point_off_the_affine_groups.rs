use liestep::{NonstandardInertia, SO3, lagrangian};
use nalgebra::Point3;

#[lagrangian(
    group = SO3,
    advected(c = centre),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - h * c.dot(&(F * c)),
)]
struct Body {
    J_d: NonstandardInertia,
    centre: Point3<f64>,
}

fn main() {}
