use liestep::{SO3, force, lagrangian};
use nalgebra::Vector3;

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(w = up.seen_from(F_1)),
    l_d = (F_1.trace() + F_2.trace()) / h - h * (F1 * w).z,
)]
struct Misspelled {
    up: Vector3<f64>,
}

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(w = up.seen_from(F_1)),
    l_d = (F_1.trace() + F_2.trace()) / h - h * (F * w).z,
)]
struct OfOneBody {
    up: Vector3<f64>,
}

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(w = up.seen_from(F_1)),
    l_d = (F_1.trace() + F_2.trace()) / h - h * (R_2 * rho).z * w.z,
)]
struct Attitude {
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(w = up.seen_from(F_1)),
    l_d = (F_1.trace() + F_2.trace()) / h - h * Omega_2.dot(&w),
)]
struct Velocity {
    up: Vector3<f64>,
}

#[lagrangian(group(F_1 = SO3, F_2 = SO3), l_d = (F_1.trace() + F_2.trace()) / h - h * w_2.dot(&up))]
struct Vertical {
    up: Vector3<f64>,
}

// Of a body that is translated.
#[force(group(F_1 = SO3, d_2 = R3), displacement(eta, s), work = -h * c * velocity_2.dot(&s))]
struct Resistance {
    c: f64,
}

#[force(group(t = R1, F = SO3), displacement(s, eta), work = -h * c * (attitude_1 * eta).x * s)]
struct Attitudes {
    c: f64,
}

#[force(group(d_1 = R3, d_2 = R3), displacement(s_1, s_2), work = -h * R_1 * s_1.dot(&s_2))]
struct NoAttitudes {
    c: f64,
}

#[force(group(F_1 = SO3, F_2 = SO3), displacement(eta_1, eta_2), work = -h * c * Omega_1.dot(&eta_1))]
struct Drag {
    c: f64,
}

fn main() {}
