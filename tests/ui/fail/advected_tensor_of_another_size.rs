use liestep::lagrangian;
use liestep::groups::{MixedTensor, SE3};
use nalgebra::Matrix4;

#[lagrangian(
    group = SE3,
    advected(S = field),
    l_d = ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) - h * S[(0, 0)] * F[(0, 3)],
)]
struct Body {
    J: Matrix4<f64>,
    field: MixedTensor<f64, 3>,
}

fn main() {}
