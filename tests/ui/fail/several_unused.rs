use liestep::{NonstandardInertia, SO3, lagrangian};
use nalgebra::Vector3;

#[lagrangian(group = SO3, advected(w = up), l_d = h * J_d.trace())]
struct Top {
    J_d: NonstandardInertia,
    m: f64,
    up: Vector3<f64>,
}

fn main() {}
