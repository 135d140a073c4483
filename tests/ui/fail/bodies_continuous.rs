use liestep::{NonstandardInertia, SO3, lagrangian};
use nalgebra::Vector3;

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    velocity = Omega,
    advected(w = up.seen_from(F_1)),
    l = 0.5 * Omega.dot(&(J_1 * J_2 * Omega)) - w.z,
)]
struct Bodies {
    J_1: NonstandardInertia,
    J_2: NonstandardInertia,
    up: Vector3<f64>,
}

fn main() {}
