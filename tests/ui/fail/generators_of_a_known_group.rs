use liestep::{NonstandardInertia, SO3, force, lagrangian};
use nalgebra::Vector3;

#[lagrangian(
    group = SO3,
    generators = [[[0.0, -1.0], [1.0, 0.0]]],
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h),
)]
struct Body {
    J_d: NonstandardInertia,
}

#[force(group = liestep::SO3, generators = [[[0.0, -1.0], [1.0, 0.0]]], work = h * tau.dot(&eta))]
struct Push {
    tau: Vector3<f64>,
}

fn main() {}
