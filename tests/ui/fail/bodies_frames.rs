use liestep::{NonstandardInertia, SO3, lagrangian};
use nalgebra::Vector3;

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(w = up.seen_from(F_1)),
    l_d = k * (F_1.trace() + F_2.trace()) / h - h * k * ((F_1 * F_2).trace() + w.z),
)]
struct Increments {
    k: f64,
    up: Vector3<f64>,
}

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(w_1 = up.seen_from(F_1), w_2 = up.seen_from(F_2), Q = F_2.seen_from(F_1)),
    l_d = k * (F_1.trace() + F_2.trace()) / h - h * k * (w_1.dot(&w_2) + Q.trace()),
)]
struct Vectors {
    k: f64,
    up: Vector3<f64>,
}

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(w_1 = up.seen_from(F_1), w_2 = up.seen_from(F_2)),
    l_d = k * (F_1.trace() + F_2.trace()) / h - h * k * (w_1 - w_2).norm_squared(),
)]
struct Sum {
    k: f64,
    up: Vector3<f64>,
}

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(w = up.seen_from(F_1), Q = F_1.seen_from(F_2)),
    l_d = k * (F_1.trace() + F_2.trace()) / h - h * k * (F_1.transpose() * Q * F_2).trace() - h * w.z,
)]
struct Turned {
    k: f64,
    up: Vector3<f64>,
}

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(w = up.seen_from(F_1), v = up.seen_from(F_2)),
    l_d = k * (F_1.trace() + F_2.trace()) / h - h * k * (F_1 * (w - v.cross(&w))).z,
)]
struct Bound {
    k: f64,
    up: Vector3<f64>,
}

// A field has the name that is offered.
#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(w = up.seen_from(F_1), v = up.seen_from(F_2)),
    l_d = ((F_1 - I) * Q * (F_1 - I).transpose()).trace() / (2.0 * h)
        + ((F_2 - I) * Q_2 * (F_2 - I).transpose()).trace() / (2.0 * h)
        - h * k * w.dot(&v),
)]
struct Taken {
    Q: NonstandardInertia,
    Q_2: NonstandardInertia,
    k: f64,
    up: Vector3<f64>,
}

// A vector that is seen isn't a turn.
#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(w = up.seen_from(F_1), Q = F_2.seen_from(F_1)),
    l_d = k * (F_1.trace() + F_2.trace()) / h - h * k * (vee(F_2).dot(&w) + Q.trace()),
)]
struct Turn {
    k: f64,
    up: Vector3<f64>,
}

fn main() {}
