use liestep::{NonstandardInertia, SO3, force, lagrangian};
use nalgebra::Vector3;

#[lagrangian(
    group = SO3,
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - h * vee * F.trace(),
)]
struct Top0 {
    J_d: NonstandardInertia,
    vee: f64,
}

#[lagrangian(
    group = SO3,
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - h * log * F.trace(),
)]
struct Top1 {
    J_d: NonstandardInertia,
    log: f64,
}

#[lagrangian(
    group = SO3,
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - h * exp * F.trace(),
)]
struct Top2 {
    J_d: NonstandardInertia,
    exp: f64,
}

#[lagrangian(
    group = SO3,
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - h * h * F.trace(),
)]
struct Top3 {
    J_d: NonstandardInertia,
    h: f64,
}

#[lagrangian(
    group = SO3,
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - h * (F * I).trace(),
)]
struct Matrix {
    J_d: NonstandardInertia,
    I: NonstandardInertia,
}

#[lagrangian(
    group = SO3,
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h),
)]
struct Unused {
    J_d: NonstandardInertia,
    F: f64,
}

#[force(group = SO3, work = h * eta * eta_next[0])]
struct Push {
    eta: f64,
}

#[force(group = SO3, work = h * vee.dot(&eta))]
struct Turn {
    vee: Vector3<f64>,
}

fn main() {}
