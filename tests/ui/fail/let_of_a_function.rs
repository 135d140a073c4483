use liestep::{NonstandardInertia, SO3, lagrangian};
use nalgebra::Vector3;

#[lagrangian(group = SO3, advected(w = up), l_d = { let U = |y| y.norm_squared(); k * F.trace() / h - h * U(w) })]
struct Untyped {
    k: f64,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, advected(w = up), l_d = { let U = |y: Vector3<f64>| y.z; k * F.trace() / h - h * U(w, w) })]
struct Counted {
    k: f64,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, advected(w = up), l_d = { let U = |y: Vector3<f64>| y.z; k * F.trace() / h - h * U(w.z) })]
struct Shaped {
    k: f64,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, advected(w = up), l_d = { let U = |y: Vector3<f64>| y.z; k * F.trace() / h - h * U(&w) })]
struct Referred {
    k: f64,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, advected(w = up), l_d = { let U = |y: &Vector3<f64>| y.z; k * F.trace() / h - h * U(w) })]
struct ByReference {
    k: f64,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, advected(w = up), l_d = { let U = |y: Vector3<f64>| y.z; k * F.trace() / h - h * (U + w.z) })]
struct Valued {
    k: f64,
    up: Vector3<f64>,
}

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = {
        let U = |y: Vector3<f64>, x: f64| y.z;
        k * F.trace() / h - h * U(w, 1.0)
    },
)]
struct Unused {
    k: f64,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, advected(w = up), l_d = { let U = |y: Vector3<f64>| y.z; k * F.trace() / h - h * w.z })]
struct Uncalled {
    k: f64,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, advected(w = up), l_d = { let U = || w.z; k * F.trace() / h - h * U() })]
struct Nothing {
    k: f64,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, advected(w = up), l_d = { let z = (|y: Vector3<f64>| y.z)(w); k * F.trace() / h - h * z })]
struct Nameless {
    k: f64,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, advected(w = up), l_d = { let U = |y: Vector3<f64>| U(y); k * F.trace() / h - h * U(w) })]
struct Recursive {
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

#[lagrangian(group = SO3, advected(w = up), l_d = { let U = |y: f64, y: f64| y; k * F.trace() / h - h * U(w.z, w.z) })]
struct Twice {
    k: f64,
    up: Vector3<f64>,
}

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = {
        let U = |y: Vector3<f64>| -> f64 { y.z };
        k * F.trace() / h - h * U(w)
    },
)]
struct Returned {
    k: f64,
    up: Vector3<f64>,
}

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = {
        let U = |A: nalgebra::Matrix3<f64>| (inverse(A) * w).z;
        -h * k * U(F)
    },
)]
struct Inverted {
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
        k * F.trace() / h - h * q(w.z)
    },
)]
struct Many {
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
