use liestep::{SO3, force};
use nalgebra::Vector3;

#[force(group = SO3, work = {
    let x = h * tau.dot(&eta);
    x;
})]
struct Push {
    tau: Vector3<f64>,
}

fn main() {}
