use liestep::groups::SE2;
use liestep::lagrangian;
use nalgebra::{Matrix3, Vector3};

#[lagrangian(group = SE2, velocity = xi, advected(w = up), l = 0.5 * xi.dot(&(M * xi)) - w.dot(&r), discretise = midpoint(exp))]
struct Planar {
    M: Matrix3<f64>,
    r: Vector3<f64>,
    up: Vector3<f64>,
}

fn main() {}
