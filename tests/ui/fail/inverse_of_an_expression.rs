use liestep::{SO3, lagrangian};
use nalgebra::Matrix3;

#[lagrangian(
    group = SO3,
    l_d = {
        let J = A + A.transpose();
        vee(F).dot(&(inverse(J) * vee(F))) / h
    },
)]
struct Body {
    A: Matrix3<f64>,
}

fn main() {}
