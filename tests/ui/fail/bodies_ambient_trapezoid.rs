use liestep::{NonstandardInertia, SO3, lagrangian};
use nalgebra::Vector3;

// The second end isn't the adjoint of the first, as the kinetic energy depends on how the bodies stand.
#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    velocity(Omega_1, Omega_2),
    advected(Q = F_2.seen_from(F_1)),
    l = 0.5 * (hat(Omega_1) * J * hat(Omega_1).transpose()).trace()
        + 0.5 * (hat(Omega_2) * J * hat(Omega_2).transpose()).trace()
        + (hat(Omega_1) * rho).dot(&(Q * (hat(Omega_2) * s))),
    discretise = trapezoid,
)]
struct Links {
    J: NonstandardInertia,
    rho: Vector3<f64>,
    s: Vector3<f64>,
}

fn main() {}
