use liestep::{SO3, lagrangian};
use nalgebra::Matrix3;

#[lagrangian(group = SO3, l_d = (((F - I) * A * (F - I).transpose()).trace() - k * (F * B).trace()) / h)]
struct Body {
    k: f64,
    A: Matrix3<f64>,
    B: Matrix3<f64>,
}

fn main() {}
