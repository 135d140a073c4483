use liestep::groups::SE2;
use liestep::lagrangian;
use nalgebra::Vector3;

#[lagrangian(
    group = SE2,
    velocity = xi,
    l = 0.5 * j * (hat(xi) * hat(xi).transpose()).trace() + 0.5 * k * r.dot(&(hat(xi) * s)).powi(2),
    discretise = trapezoid,
)]
struct Fish {
    j: f64,
    k: f64,
    r: Vector3<f64>,
    s: Vector3<f64>,
}

fn main() {}
