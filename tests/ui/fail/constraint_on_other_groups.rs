use liestep::{constraint, lagrangian};
use nalgebra::Vector3;

#[constraint(
    group(F_1 = SO3, F_2 = SO3),
    advected(Q = F_2.seen_from(F_1)),
    zero = vee(Q),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Aligned {}

#[constraint(group = SO3, advected(w = up), zero = w.dot(&e))]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Level {
    e: Vector3<f64>,
    up: Vector3<f64>,
}

#[constraint(
    group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
    advected(r = d_2.seen_from(d_1)),
    zero = r,
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Single {
    offset: Vector3<f32>,
}

#[lagrangian(
    group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
    advected(r = d_2.seen_from(d_1)),
    zero = r,
)]
struct Misplaced {}

fn main() {}
