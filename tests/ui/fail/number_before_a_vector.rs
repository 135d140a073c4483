use liestep::{NonstandardInertia, SO3, lagrangian};
use nalgebra::Vector3;

// Over `f64` all of these are right.
#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = {
        let mean = 0.5 * (rho + F * rho);
        let turned = m * rho;
        ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - h * (w.dot(&mean) + (h * F * turned).z)
    },
)]
struct Top<T> {
    J_d: NonstandardInertia<T>,
    m: T,
    rho: Vector3<T>,
    up: Vector3<T>,
}

fn main() {}
