use liestep::groups::R3;
use liestep::{NonstandardInertia, SO3, lagrangian};
use nalgebra::Vector3;

#[lagrangian(
    group(F = SO3, d = R3),
    advected(Q = F.seen_from(d)),
    l_d = ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) + m * d.norm_squared() / (2.0 * h) - h * (Q * up).z,
)]
struct Relative {
    J: NonstandardInertia,
    m: f64,
    up: Vector3<f64>,
}

#[lagrangian(
    group(F = SO3, d = R3),
    advected(w = up.seen_from(d)),
    l_d = ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) + m * d.norm_squared() / (2.0 * h) - h * w.z,
)]
struct Sees {
    J: NonstandardInertia,
    m: f64,
    up: Vector3<f64>,
}

#[lagrangian(
    group(F = SO3, d = R3),
    l_d = ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) + m * (d - I).norm_squared() / (2.0 * h) + h * up.z,
)]
struct Identity {
    J: NonstandardInertia,
    m: f64,
    up: Vector3<f64>,
}

#[lagrangian(
    group(F = SO3, d = R3),
    l_d = ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) + m * inverse(d).norm_squared() / (2.0 * h) + h * up.z,
)]
struct Inverse {
    J: NonstandardInertia,
    m: f64,
    up: Vector3<f64>,
}

fn main() {}
