use liestep::{NonstandardInertia, SO3, force, lagrangian};
use nalgebra::Vector3;

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(w = up.seen_from(F_1)),
    l_d = ((F_1 - I) * J * (F_1 - I).transpose()).trace() / (2.0 * h)
        + ((F_2 - I) * J * (F_2 - I).transpose()).trace() / (2.0 * h)
        - h * (F1 * w).z,
)]
struct Misspelled {
    J: NonstandardInertia,
    up: Vector3<f64>,
}

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(w = up.seen_from(F_1)),
    l_d = ((F_1 - I) * J * (F_1 - I).transpose()).trace() / (2.0 * h)
        + ((F_2 - I) * J * (F_2 - I).transpose()).trace() / (2.0 * h)
        - h * (F * w).z,
)]
struct OfOneBody {
    J: NonstandardInertia,
    up: Vector3<f64>,
}

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(w = up.seen_from(F_1)),
    l_d = ((F_1 - I) * J * (F_1 - I).transpose()).trace() / (2.0 * h)
        + ((F_2 - I) * J * (F_2 - I).transpose()).trace() / (2.0 * h)
        - h * (R_2 * rho).z * w.z,
)]
struct Attitude {
    J: NonstandardInertia,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(w = up.seen_from(F_1)),
    l_d = ((F_1 - I) * J * (F_1 - I).transpose()).trace() / (2.0 * h)
        + ((F_2 - I) * J * (F_2 - I).transpose()).trace() / (2.0 * h)
        - h * Omega_2.dot(&w),
)]
struct Velocity {
    J: NonstandardInertia,
    up: Vector3<f64>,
}

#[force(group(F_1 = SO3, F_2 = SO3), displacement(eta_1, eta_2), work = -h * c * Omega_1.dot(&eta_1))]
struct Drag {
    c: f64,
}

fn main() {}
