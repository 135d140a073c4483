use liestep::{SO3, lagrangian};
use liestep::groups::R3;
use liestep::mechanics::Inertia;
use nalgebra::Vector3;

#[lagrangian(
    group(F = SO3, d = R3),
    velocity(Omega, v),
    advected(R = F.seen_from(space)),
    l = 0.5 * Omega.dot(&(J * Omega)) - (R * s).z,
)]
struct Standing {
    J: Inertia,
    s: Vector3<f64>,
}

fn main() {}
