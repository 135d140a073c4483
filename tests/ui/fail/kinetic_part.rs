use liestep::groups::SE3;
use liestep::{NonstandardInertia, SO3, lagrangian};
use nalgebra::{Matrix3, Vector3};

#[lagrangian(group = SO3, l_d = k * axis.dot(&vee(F - F.transpose())).powi(2) / h)]
struct KineticPartAlongOneAxis {
    k: f64,
    axis: Vector3<f64>,
}

#[lagrangian(group = SO3, l_d = k * ((F - I).norm_squared() + F[(0, 1)]) / h)]
struct KineticPartLinear {
    k: f64,
}

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = ((F - I) * J_d * (F - I)).trace() / (2.0 * h) - 0.5 * h * m * w.dot(&(rho + F * rho)),
)]
struct KineticPartNegative {
    J_d: NonstandardInertia,
    m: f64,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, l_d = k * (F - I).norm() / h)]
struct KineticPartNotSmooth {
    k: f64,
}

#[lagrangian(group = SO3, l_d = (F * A).trace() / h)]
struct KineticPartNotStationary {
    A: Matrix3<f64>,
}

#[lagrangian(group = SE3, l_d = k * (4.0 - F.trace()) / h)]
struct KineticPartSingular {
    k: f64,
}

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = h * (((F - I) * J_d * (F - I).transpose()).trace() - 0.5 * m * w.dot(&(rho + F * rho))),
)]
struct KineticPartTimesStep {
    J_d: NonstandardInertia,
    m: f64,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, l_d = (F * J_d).trace() / (h * h))]
struct KineticPartTooSingular {
    J_d: NonstandardInertia,
}

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = (F * J_d * F.transpose()).trace() / (2.0 * h) - 0.5 * h * m * w.dot(&(rho + F * rho)),
)]
struct KineticPartWithoutIdentity {
    J_d: NonstandardInertia,
    m: f64,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = {
        let kinetic = ((F - I) * J_d * (F - I).transpose()).trace() / 2.0;
        kinetic - 0.5 * h * m * w.dot(&(rho + F * rho))
    },
)]
struct KineticPartWithoutStep {
    J_d: NonstandardInertia,
    m: f64,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

fn main() {}
