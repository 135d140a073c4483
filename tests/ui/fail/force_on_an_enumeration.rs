use liestep::{SO3, force};
use nalgebra::Vector3;

#[force(group = SO3, work = h * tau.dot(&eta))]
enum Push {
    Tau(Vector3<f64>),
}

fn main() {}
