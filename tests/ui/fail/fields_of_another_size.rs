use liestep::groups::{R3, SE3};
use liestep::lagrangian;
use nalgebra::{Matrix3, Vector3};

#[lagrangian(
    group = SE3,
    advected(w = up),
    l_d = ((F - I) * A * (F - I).transpose()).trace() / (2.0 * h) - h * w.dot(&(F * rho)),
)]
struct Body {
    A: Matrix3<f64>,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(group = R3, l_d = m * (F - I).norm_squared() / (2.0 * h) - h * k.dot(&(F * k)))]
struct Point {
    m: f64,
    k: Vector3<f64>,
}

fn main() {}
