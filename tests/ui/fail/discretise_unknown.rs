use liestep::mechanics::Inertia;
use liestep::{SO3, lagrangian};
use nalgebra::Vector3;

#[lagrangian(
    group = SO3,
    velocity = Omega,
    advected(w = up),
    l = 0.5 * Omega.dot(&(J * Omega)) - w.dot(&rho),
    discretise = trapezium,
)]
struct Top {
    J: Inertia,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

fn main() {}
