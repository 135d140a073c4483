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

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = {
        let U = |y: Vector3<f64>| -> f64 { y.z };
        ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) - h * k * U(w)
    },
)]
struct Returned {
    J: NonstandardInertia,
    k: f64,
    up: Vector3<f64>,
}

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = {
        let U = |A: nalgebra::Matrix3<f64>| (inverse(A) * w).z;
        ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) - h * k * U(F)
    },
)]
struct Inverted {
    J: NonstandardInertia,
    k: f64,
    up: Vector3<f64>,
}

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = {
        let a = |x: f64| x + 1.0;
        let b = |x: f64| a(x) * a(x);
        let c = |x: f64| b(x) * b(x);
        let d = |x: f64| c(x) * c(x);
        let e = |x: f64| d(x) * d(x);
        let f = |x: f64| e(x) * e(x);
        let g = |x: f64| f(x) * f(x);
        let p = |x: f64| g(x) * g(x);
        let q = |x: f64| p(x) * p(x);
        ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) - h * k * q(w.z)
    },
)]
struct Many {
    J: NonstandardInertia,
    k: f64,
    up: Vector3<f64>,
}

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = {
        let U = |x: f64, y: Vector3<f64>| x * y.z;
        ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) - h * k * U(w.z, w)
    },
)]
struct Generic<T: liestep::numbers::Real> {
    J: NonstandardInertia<T>,
    k: T,
    up: Vector3<T>,
}

fn main() {}
