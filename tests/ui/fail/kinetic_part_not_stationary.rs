use liestep::{SO3, lagrangian};
use nalgebra::Matrix3;

#[lagrangian(group = SO3, l_d = (F * A).trace() / h)]
struct Top {
    A: Matrix3<f64>,
}

fn main() {}
