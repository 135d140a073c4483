use liestep::{SO3, lagrangian};
use nalgebra::Matrix3;

#[lagrangian(
    group = SO3,
    l_d = {
        let a = F.trace() + F[(0, 1)] + F[(0, 2)] + F[(1, 0)];
        let b = (F * A).trace() + A[(0, 1)] + A[(0, 2)] + A[(1, 0)];
        (a + b).powi(4) / h
    },
)]
struct Top {
    A: Matrix3<f64>,
}

fn main() {}
