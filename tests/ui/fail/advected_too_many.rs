use liestep::{NonstandardInertia, SO3, lagrangian};
use nalgebra::Vector3;

#[lagrangian(
    group = SO3,
    advected(a = up, b = north, c = east, d = sun, e = moon, f = star, g = magnet),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - h * (a + b + c + d + e + f + g).dot(&(F * rho)),
)]
struct Top {
    J_d: NonstandardInertia,
    rho: Vector3<f64>,
    up: Vector3<f64>,
    north: Vector3<f64>,
    east: Vector3<f64>,
    sun: Vector3<f64>,
    moon: Vector3<f64>,
    star: Vector3<f64>,
    magnet: Vector3<f64>,
}

fn main() {}
