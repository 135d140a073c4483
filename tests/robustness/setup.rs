//! Scenes that no stepper is built for, each with the words that say why.

#![allow(non_snake_case)]

use liestep::groups::{R2, SE2};
use liestep::{NonstandardInertia, SO3, Stepper, lagrangian};
use nalgebra::{Matrix3, Vector3};

/// A body whose type says nothing of its inertia.
#[lagrangian(group = SO3, l_d = ((F - I) * A * (F - I).transpose()).trace() / (2.0 * h))]
struct Body {
    A: nalgebra::Matrix3<f64>,
}

/// The same on SE(2) with a symmetric matrix.
#[lagrangian(group = SE2, l_d = ((F - I) * (A + A.transpose()) * (F - I).transpose()).trace() / (2.0 * h))]
struct Planar {
    A: Matrix3<f64>,
}

#[lagrangian(group = R2, l_d = m * (F - I).norm_squared() / (2.0 * h))]
struct Point {
    m: f64,
}

/// A body with a constant that a parameter makes infinite.
#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - h * k / (m - 1.0) * w.dot(&rho),
)]
struct Divided {
    J_d: NonstandardInertia,
    k: f64,
    m: f64,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

/// The message, or nothing.
macro_rules! refusal {
    ($scene:expr) => {
        Stepper::new($scene, 0.01).err().map(|error| error.to_string()).unwrap_or_default()
    };
}

#[test]
fn a_negative_kinetic_part() {
    let body = |x, y, z| Body { A: Matrix3::from_diagonal(&Vector3::new(x, y, z)) };
    // J = tr(A) I − A: (2, 2, 2), (−2, 2, −2), (−2, −2, −2), (2, 0, 2), (1, 5, −2).
    assert_eq!(refusal!(body(1.0, 1.0, 1.0)), "");
    assert!(refusal!(body(1.0, -3.0, 1.0)).contains("negative"));
    assert!(refusal!(body(-1.0, -1.0, -1.0)).contains("negative"));
    assert!(refusal!(body(0.0, 2.0, 0.0)).contains("singular"));
    assert!(refusal!(body(1.0, -3.0, 4.0)).contains("negative"));
    let rotated = |moments: Vector3<f64>| {
        let turn = *nalgebra::Rotation3::from_euler_angles(0.3, 1.0, -2.0).matrix();
        Body { A: turn * Matrix3::from_diagonal(&moments) * turn.transpose() }
    };
    assert_eq!(refusal!(rotated(Vector3::new(1.0, 2.0, 1e-9))), "");
    assert!(refusal!(rotated(Vector3::new(1.0, -3.0, 1.0))).contains("negative"));
    assert!(refusal!(Point { m: -1.0 }).contains("negative"));
    assert!(refusal!(Point { m: 0.0 }).contains("singular"));
    assert_eq!(refusal!(Point { m: 1e-100 }), "");
    assert_eq!(refusal!(Planar { A: Matrix3::identity() }), "");
    assert!(refusal!(Planar { A: Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, -1.0)) }).contains("negative"));
}

#[test]
fn a_constant_that_is_not_finite() {
    let divided = |m| {
        let J_d = NonstandardInertia::from_diagonal(Vector3::new(1.0, 2.0, 2.0)).unwrap();
        Divided { J_d, k: 1.0, m, rho: Vector3::z(), up: Vector3::z() }
    };
    assert_eq!(refusal!(divided(2.0)), "");
    assert!(refusal!(divided(1.0)).contains("constant"), "{}", refusal!(divided(1.0)));
}
