use liestep::{SO3, lagrangian};
use nalgebra::Vector3;

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(w = up.seen_by(F_1)),
    l_d = (F_1.trace() + F_2.trace()) / h - h * w.z,
)]
struct By {
    up: Vector3<f64>,
}

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(w = up.seen_from(F_1, F_2)),
    l_d = (F_1.trace() + F_2.trace()) / h - h * w.z,
)]
struct ByTwo {
    up: Vector3<f64>,
}

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(w = up.seen_from()),
    l_d = (F_1.trace() + F_2.trace()) / h - h * w.z,
)]
struct ByNone {
    up: Vector3<f64>,
}

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(Q = space.seen_from(F_2)),
    l_d = (F_1.trace() + F_2.trace()) / h - h * Q.trace(),
)]
struct Space {
    up: Vector3<f64>,
}

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(w = self.up.seen_from(F_1)),
    l_d = (F_1.trace() + F_2.trace()) / h - h * w.z,
)]
struct Itself {
    up: Vector3<f64>,
}

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(w = upp.seen_from(F_1)),
    l_d = (F_1.trace() + F_2.trace()) / h - h * w.z,
)]
struct Misspelled {
    up: Vector3<f64>,
}

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(w = up.seen_from(F_1), Q = F_3.seen_from(F_1)),
    l_d = (F_1.trace() + F_2.trace()) / h - h * Q.trace() * w.z,
)]
struct MisspelledBody {
    up: Vector3<f64>,
}

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(w = up.seen_from("F_1")),
    l_d = (F_1.trace() + F_2.trace()) / h - h * w.z,
)]
struct Quoted {
    up: Vector3<f64>,
}

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(w = up.seen_from(&F_1)),
    l_d = (F_1.trace() + F_2.trace()) / h - h * w.z,
)]
struct Reference {
    up: Vector3<f64>,
}

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(up.seen_from(F_1)),
    l_d = (F_1.trace() + F_2.trace()) / h - h * up.z,
)]
struct Unnamed {
    up: Vector3<f64>,
}

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(w = up.seen_from(F_1) Q = F_2.seen_from(F_1)),
    l_d = (F_1.trace() + F_2.trace()) / h - h * Q.trace() * w.z,
)]
struct WithoutAComma {
    up: Vector3<f64>,
}

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(w = up.seen_from(F_1).normalize()),
    l_d = (F_1.trace() + F_2.trace()) / h - h * w.z,
)]
struct WithMore {
    up: Vector3<f64>,
}

fn main() {}
