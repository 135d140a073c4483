use liestep::{NonstandardInertia, SO3, lagrangian};
use nalgebra::Vector3;

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = {
        let U = |y| y.norm_squared();
        ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) - h * k * U(w)
    },
)]
struct Untyped {
    J: NonstandardInertia,
    k: f64,
    up: Vector3<f64>,
}

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = {
        let U = |y: Vector3<f64>| y.z;
        ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) - h * k * U(w, w)
    },
)]
struct Counted {
    J: NonstandardInertia,
    k: f64,
    up: Vector3<f64>,
}

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = {
        let U = |y: Vector3<f64>| y.z;
        ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) - h * k * U(w.z)
    },
)]
struct Shaped {
    J: NonstandardInertia,
    k: f64,
    up: Vector3<f64>,
}

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = {
        let U = |y: Vector3<f64>| y.z;
        ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) - h * k * U(&w)
    },
)]
struct Referred {
    J: NonstandardInertia,
    k: f64,
    up: Vector3<f64>,
}

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = {
        let U = |y: &Vector3<f64>| y.z;
        ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) - h * k * U(w)
    },
)]
struct ByReference {
    J: NonstandardInertia,
    k: f64,
    up: Vector3<f64>,
}

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = {
        let U = |y: Vector3<f64>| y.z;
        ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) - h * k * (U + w.z)
    },
)]
struct Valued {
    J: NonstandardInertia,
    k: f64,
    up: Vector3<f64>,
}

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = {
        let U = |y: Vector3<f64>, x: f64| y.z;
        ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) - h * k * U(w, 1.0)
    },
)]
struct Unused {
    J: NonstandardInertia,
    k: f64,
    up: Vector3<f64>,
}

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = {
        let U = |y: Vector3<f64>| y.z;
        ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) - h * k * w.z
    },
)]
struct Uncalled {
    J: NonstandardInertia,
    k: f64,
    up: Vector3<f64>,
}

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = {
        let U = || w.z;
        ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) - h * k * U()
    },
)]
struct Nothing {
    J: NonstandardInertia,
    k: f64,
    up: Vector3<f64>,
}

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = {
        let z = (|y: Vector3<f64>| y.z)(w);
        ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) - h * k * z
    },
)]
struct Nameless {
    J: NonstandardInertia,
    k: f64,
    up: Vector3<f64>,
}

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = {
        let U = |y: Vector3<f64>| U(y);
        ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) - h * k * U(w)
    },
)]
struct Recursive {
    J: NonstandardInertia,
    k: f64,
    up: Vector3<f64>,
}

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = {
        let U = |y: NonstandardInertia| y.trace();
        ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) - h * k * U(J)
    },
)]
struct Odd {
    J: NonstandardInertia,
    k: f64,
    up: Vector3<f64>,
}

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = {
        let U = |y: f64, y: f64| y;
        ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) - h * k * U(w.z, w.z)
    },
)]
struct Twice {
    J: NonstandardInertia,
    k: f64,
    up: Vector3<f64>,
}

fn main() {}
