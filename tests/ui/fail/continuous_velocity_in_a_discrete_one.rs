use liestep::mechanics::Inertia;
use liestep::{SO3, lagrangian};
use nalgebra::Vector3;

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = 0.5 * h * Omega.dot(&(J * Omega)) - h * w.dot(&(F * rho)),
)]
struct Top {
    J: Inertia,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

fn main() {}
