use liestep::{SO3, lagrangian};
use nalgebra::Vector3;

#[lagrangian(group = SO3, l_d = rho.trace() * F.trace() / h)]
struct Top {
    rho: Vector3<f64>,
}

fn main() {}
