use liestep::{SO3, force};
use nalgebra::Vector3;

#[force(group = SO3, work = h * tau.dott(&eta) + h * tau.determinant())]
struct Push {
    tau: Vector3<f64>,
}

fn main() {}
