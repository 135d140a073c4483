use liestep::lagrangian;
use liestep::groups::SE3;
use nalgebra::{Matrix4, Point2};

#[lagrangian(
    group = SE3,
    l_d = ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) - h * (F * p)[0],
)]
struct Body {
    J: Matrix4<f64>,
    p: Point2<f64>,
}

fn main() {}
