use liestep::{NonstandardInertia, SO3, lagrangian};
use nalgebra::Vector3;

#[lagrangian(
    group(F_1: SO3, F_2: SO3),
    advected(w = up.seen_from(F_1)),
    l_d = (F_1.trace() + F_2.trace()) / h - h * w.z,
)]
struct Colons {
    up: Vector3<f64>,
}

#[lagrangian(
    group(F_1 = SO3), group(F_2 = SO3),
    advected(w = up.seen_from(F_1)),
    l_d = (F_1.trace() + F_2.trace()) / h - h * w.z,
)]
struct Twice {
    up: Vector3<f64>,
}

#[lagrangian(group(SO3, SO3), advected(w = up.seen_from(F_1)), l_d = (F_1.trace() + F_2.trace()) / h - h * w.z)]
struct Nameless {
    up: Vector3<f64>,
}

#[lagrangian(group = (SO3, SO3), advected(w = up.seen_from(F_1)), l_d = (F_1.trace() + F_2.trace()) / h - h * w.z)]
struct Tuple {
    up: Vector3<f64>,
}

#[lagrangian(group = SO3 * SO3, advected(w = up.seen_from(F_1)), l_d = (F_1.trace() + F_2.trace()) / h - h * w.z)]
struct Product {
    up: Vector3<f64>,
}

#[lagrangian(group = [SO3; 2], advected(w = up.seen_from(F_1)), l_d = (F_1.trace() + F_2.trace()) / h - h * w.z)]
struct Array {
    up: Vector3<f64>,
}

#[lagrangian(
    group { F_1 = SO3, F_2 = SO3 },
    advected(w = up.seen_from(F_1)),
    l_d = (F_1.trace() + F_2.trace()) / h - h * w.z,
)]
struct Braces {
    up: Vector3<f64>,
}

#[lagrangian(group(), advected(w = up.seen_from(F_1)), l_d = (F_1.trace() + F_2.trace()) / h - h * w.z)]
struct Empty {
    up: Vector3<f64>,
}

#[lagrangian(
    group(SO3 = F_1, SO3 = F_2),
    advected(w = up.seen_from(F_1)),
    l_d = (F_1.trace() + F_2.trace()) / h - h * w.z,
)]
struct TheOtherWayRound {
    up: Vector3<f64>,
}

#[lagrangian(
    group(R1 = S03, F = SO3),
    advected(w = up.seen_from(F)),
    l_d = ((R1 - I) * J * (R1 - I).transpose()).trace() / (2.0 * h)
        + ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h)
        - h * w.z,
)]
struct Misspelled {
    J: NonstandardInertia,
    up: Vector3<f64>,
}

#[lagrangian(
    group(SO3 = turn, R3 = shift),
    l_d = ((turn - I) * J * (turn - I).transpose()).trace() / (2.0 * h) + shift.dot(&up) / h,
)]
struct OwnNames {
    J: NonstandardInertia,
    up: Vector3<f64>,
}

fn main() {}
