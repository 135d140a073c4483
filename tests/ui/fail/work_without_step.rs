use liestep::{SO3, force};
use nalgebra::Vector3;

#[force(group = SO3, work = 0.5 * tau.dot(&(eta + eta_next)) - c * vee(F).dot(&eta))]
struct Push {
    tau: Vector3<f64>,
    c: f64,
}

#[force(group = SO3, work = -c * vee(F).dot(&eta) / h)]
struct Drag {
    c: f64,
}

#[force(group = SO3, work = -h * c * vee(F).dot(&eta))]
struct VanishingDrag {
    c: f64,
}

fn main() {}
