use liestep::{SO3, lagrangian};
use nalgebra::Vector3;

#[lagrangian(group = SO3, l_d = -h * rho.dot(&(F * rho)))]
struct Bare {
    rho: Vector3,
}

#[lagrangian(group = SO3, l_d = -h * rho.dot(&(F * rho)))]
struct Empty {
    rho: Vector3<>,
}

fn main() {}
