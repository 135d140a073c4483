use liestep::force;
use nalgebra::Vector3;

#[force(group(F_1 = SO3, F_2 = SO3), work = h * tau.dot(&eta))]
struct Push {
    tau: Vector3<f64>,
}

fn main() {}
