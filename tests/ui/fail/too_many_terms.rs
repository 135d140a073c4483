use liestep::{SO3, lagrangian};
use nalgebra::Matrix3;

#[lagrangian(group = SO3, l_d = ((F * A + A * F + A).trace()).powi(16) / h)]
struct Top {
    A: Matrix3<f64>,
}

fn main() {}
