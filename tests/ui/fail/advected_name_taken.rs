use liestep::{NonstandardInertia, SO3, force, lagrangian};
use nalgebra::Vector3;

#[lagrangian(
    group = SO3,
    advected(F = up),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - h * w.dot(&(F * rho)),
)]
struct Top {
    J_d: NonstandardInertia,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(
    group = SO3,
    advected(log = up),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - h * log.dot(&rho),
)]
struct Logarithm {
    J_d: NonstandardInertia,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[force(group = SO3, advected(eta = up), work = h * eta.dot(&eta_next))]
struct Push {
    up: Vector3<f64>,
}

fn main() {}
