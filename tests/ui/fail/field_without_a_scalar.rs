use liestep::{NonstandardInertia, SO3, lagrangian};
use nalgebra::Vector3;

#[lagrangian(
    group = SO3,
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - h * rho.dot(&(F * rho)),
)]
struct Bare {
    J_d: NonstandardInertia,
    rho: Vector3,
}

#[lagrangian(
    group = SO3,
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - h * rho.dot(&(F * rho)),
)]
struct Empty {
    J_d: NonstandardInertia,
    rho: Vector3<>,
}

#[lagrangian(
    group = SO3,
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - h * rho.dot(&(F * rho)),
)]
struct Whole {
    J_d: NonstandardInertia,
    rho: Vector3<u32>,
}

#[lagrangian(
    group = SO3,
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - h * rho.dot(&(F * rho)),
)]
struct Nested {
    J_d: NonstandardInertia,
    rho: Vector3<NonstandardInertia>,
}

fn main() {}
