use liestep::lagrangian;
use liestep::groups::SE3;
use nalgebra::{Matrix4, Vector3};

#[lagrangian(
    group = SE3,
    advected(w = up),
    l_d = ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) - h * w[0] * F[(0, 3)],
)]
struct Body {
    J: Matrix4<f64>,
    up: Vector3<f64>,
}

fn main() {}
