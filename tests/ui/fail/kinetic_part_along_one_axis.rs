use liestep::{SO3, lagrangian};
use nalgebra::Vector3;

#[lagrangian(group = SO3, l_d = k * axis.dot(&vee(F - F.transpose())).powi(2) / h)]
struct Rotor {
    k: f64,
    axis: Vector3<f64>,
}

fn main() {}
