use liestep::{NonstandardInertia, SO3, lagrangian};
use nalgebra::Vector3;

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(w = up.seen_by(F_1)),
    l_d = ((F_1 - I) * J * (F_1 - I).transpose()).trace() / (2.0 * h)
        + ((F_2 - I) * J * (F_2 - I).transpose()).trace() / (2.0 * h)
        - h * w.z,
)]
struct By {
    J: NonstandardInertia,
    up: Vector3<f64>,
}

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(w = up.seen_from(F_1, F_2)),
    l_d = ((F_1 - I) * J * (F_1 - I).transpose()).trace() / (2.0 * h)
        + ((F_2 - I) * J * (F_2 - I).transpose()).trace() / (2.0 * h)
        - h * w.z,
)]
struct ByTwo {
    J: NonstandardInertia,
    up: Vector3<f64>,
}

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(w = up.seen_from()),
    l_d = ((F_1 - I) * J * (F_1 - I).transpose()).trace() / (2.0 * h)
        + ((F_2 - I) * J * (F_2 - I).transpose()).trace() / (2.0 * h)
        - h * w.z,
)]
struct ByNone {
    J: NonstandardInertia,
    up: Vector3<f64>,
}

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(Q = space.seen_from(F_2)),
    l_d = ((F_1 - I) * J * (F_1 - I).transpose()).trace() / (2.0 * h)
        + ((F_2 - I) * J * (F_2 - I).transpose()).trace() / (2.0 * h)
        - h * Q.trace(),
)]
struct Space {
    J: NonstandardInertia,
    up: Vector3<f64>,
}

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(w = self.up.seen_from(F_1)),
    l_d = ((F_1 - I) * J * (F_1 - I).transpose()).trace() / (2.0 * h)
        + ((F_2 - I) * J * (F_2 - I).transpose()).trace() / (2.0 * h)
        - h * w.z,
)]
struct Itself {
    J: NonstandardInertia,
    up: Vector3<f64>,
}

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(w = upp.seen_from(F_1)),
    l_d = ((F_1 - I) * J * (F_1 - I).transpose()).trace() / (2.0 * h)
        + ((F_2 - I) * J * (F_2 - I).transpose()).trace() / (2.0 * h)
        - h * w.z,
)]
struct Misspelled {
    J: NonstandardInertia,
    up: Vector3<f64>,
}

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(w = up.seen_from(F_1), Q = F_3.seen_from(F_1)),
    l_d = ((F_1 - I) * J * (F_1 - I).transpose()).trace() / (2.0 * h)
        + ((F_2 - I) * J * (F_2 - I).transpose()).trace() / (2.0 * h)
        - h * Q.trace() * w.z,
)]
struct MisspelledBody {
    J: NonstandardInertia,
    up: Vector3<f64>,
}

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(w = up.seen_from("F_1")),
    l_d = ((F_1 - I) * J * (F_1 - I).transpose()).trace() / (2.0 * h)
        + ((F_2 - I) * J * (F_2 - I).transpose()).trace() / (2.0 * h)
        - h * w.z,
)]
struct Quoted {
    J: NonstandardInertia,
    up: Vector3<f64>,
}

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(w = up.seen_from(&F_1)),
    l_d = ((F_1 - I) * J * (F_1 - I).transpose()).trace() / (2.0 * h)
        + ((F_2 - I) * J * (F_2 - I).transpose()).trace() / (2.0 * h)
        - h * w.z,
)]
struct Reference {
    J: NonstandardInertia,
    up: Vector3<f64>,
}

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(up.seen_from(F_1)),
    l_d = ((F_1 - I) * J * (F_1 - I).transpose()).trace() / (2.0 * h)
        + ((F_2 - I) * J * (F_2 - I).transpose()).trace() / (2.0 * h)
        - h * up.z,
)]
struct Unnamed {
    J: NonstandardInertia,
    up: Vector3<f64>,
}

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(w = up.seen_from(F_1) Q = F_2.seen_from(F_1)),
    l_d = ((F_1 - I) * J * (F_1 - I).transpose()).trace() / (2.0 * h)
        + ((F_2 - I) * J * (F_2 - I).transpose()).trace() / (2.0 * h)
        - h * Q.trace() * w.z,
)]
struct WithoutAComma {
    J: NonstandardInertia,
    up: Vector3<f64>,
}

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(w = up.seen_from(F_1).normalize()),
    l_d = ((F_1 - I) * J * (F_1 - I).transpose()).trace() / (2.0 * h)
        + ((F_2 - I) * J * (F_2 - I).transpose()).trace() / (2.0 * h)
        - h * w.z,
)]
struct WithMore {
    J: NonstandardInertia,
    up: Vector3<f64>,
}

fn main() {}
