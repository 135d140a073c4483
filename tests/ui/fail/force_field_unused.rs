use liestep::{SO3, force};
use nalgebra::Vector3;

#[force(group = SO3, work = h * tau.dot(&eta))]
struct Push {
    tau: Vector3<f64>,
    unused: f64,
}

fn main() {}
