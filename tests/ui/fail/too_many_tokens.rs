use liestep::{NonstandardInertia, SO3, lagrangian};
use nalgebra::Vector3;

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)
        - h * (w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)))
        - h * (w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)))
        - h * (w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)))
        - h * (w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)))
        - h * (w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)))
        - h * (w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)))
        - h * (w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)))
        - h * (w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)))
        - h * (w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)))
        - h * (w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)))
        - h * (w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)))
        - h * (w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)))
        - h * (w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)))
        - h * (w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)))
        - h * (w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)))
        - h * (w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)))
        - h * (w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)))
        - h * (w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)))
        - h * (w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)))
        - h * (w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)))
        - h * (w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)))
        - h * (w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)))
        - h * (w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)))
        - h * (w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)))
        - h * (w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)))
        - h * (w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)))
        - h * (w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)))
        - h * (w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)))
        - h * (w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)))
        - h * (w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho)) + w.dot(&(F * rho))),
)]
struct Body {
    J_d: NonstandardInertia,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

fn main() {}
