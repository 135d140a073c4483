use liestep::groups::R3;
use liestep::{SO3, lagrangian};
use nalgebra::Vector3;

#[lagrangian(
    group(F = SO3, d = R3),
    advected(Q = F.seen_from(d)),
    l_d = m * d.norm_squared() / (2.0 * h) - h * (Q * up).z,
)]
struct Relative {
    m: f64,
    up: Vector3<f64>,
}

#[lagrangian(group(F = SO3, d = R3), advected(w = up.seen_from(d)), l_d = m * d.norm_squared() / (2.0 * h) - h * w.z)]
struct Sees {
    m: f64,
    up: Vector3<f64>,
}

#[lagrangian(group(F = SO3, d = R3), l_d = m * (d - I).norm_squared() / (2.0 * h) + h * up.z)]
struct Identity {
    m: f64,
    up: Vector3<f64>,
}

#[lagrangian(group(F = SO3, d = R3), l_d = m * inverse(d).norm_squared() / (2.0 * h) + h * up.z)]
struct Inverse {
    m: f64,
    up: Vector3<f64>,
}

fn main() {}
