use liestep::{NonstandardInertia, SO3, force, lagrangian};
use nalgebra::Vector3;

#[lagrangian(group = SO3<f64>, l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
struct Body {
    J_d: NonstandardInertia,
}

#[lagrangian(group = liestep::SO3::<f64>, l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
struct Path {
    J_d: NonstandardInertia,
}

#[lagrangian(group = Affine<f64>!, l_d = m * (F - I).norm_squared() / h)]
struct Own {
    m: f64,
}

#[force(group = SO3<'static>, work = h * tau.dot(&eta))]
struct Push {
    tau: Vector3<f64>,
}

fn main() {}
