//! Scenes that a stepper refuses, each with its message.

use liestep::effects::{Gravity, RigidBody};
use liestep::groups::{R2, SE2};
use liestep::{NonstandardInertia, SO3, SetupError, Stepper, lagrangian};
use nalgebra::{Matrix3, UnitQuaternion, Vector3};

/// A body whose type doesn't guarantee a valid inertia.
#[lagrangian(group = SO3, l_d = ((F - I) * A * (F - I).transpose()).trace() / (2.0 * h))]
struct Body {
    A: nalgebra::Matrix3<f64>,
}

/// A planar body on SE(2) with a symmetric matrix that may be singular.
#[lagrangian(group = SE2, l_d = ((F - I) * (A + A.transpose()) * (F - I).transpose()).trace() / (2.0 * h))]
struct PlanarBody {
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
struct InfiniteConstant {
    J_d: NonstandardInertia,
    k: f64,
    m: f64,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

/// The message of a refused scene, or an empty text.
macro_rules! refusal {
    ($scene:expr) => {
        Stepper::new($scene, 0.01).err().map(|error| error.to_string()).unwrap_or_default()
    };
}

#[test]
fn a_negative_kinetic_part() {
    let body = |x, y, z| Body { A: Matrix3::from_diagonal(&Vector3::new(x, y, z)) };
    // The inertia is J = tr(A) I − A: (2, 2, 2), (−2, 2, −2), (−2, −2, −2), (2, 0, 2), (1, 5, −2).
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
    assert_eq!(refusal!(PlanarBody { A: Matrix3::identity() }), "");
    assert!(refusal!(PlanarBody { A: Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, -1.0)) }).contains("negative"));
}

#[test]
fn a_constant_that_is_not_finite() {
    let divided = |m| {
        let J_d = NonstandardInertia::from_diagonal(Vector3::new(1.0, 2.0, 2.0)).unwrap();
        InfiniteConstant { J_d, k: 1.0, m, rho: Vector3::z(), up: Vector3::z() }
    };
    assert_eq!(refusal!(divided(2.0)), "");
    assert!(refusal!(divided(1.0)).contains("constant"), "{}", refusal!(divided(1.0)));
}

/// An orthogonal matrix that isn't a rotation, and finite numbers that leave the scalar's range in a start.
#[test]
fn a_start_is_looked_at_once_it_is_made() {
    let J_d = NonstandardInertia::from_principal_moments(Vector3::new(1.0, 2.0, 2.5)).unwrap();
    let reflected = SO3::from_matrix_unchecked(-Matrix3::identity());
    let long = Vector3::repeat(1.2e308);
    let turned: SO3 = UnitQuaternion::rotation_between(&Vector3::x(), &Vector3::repeat(1.0)).unwrap().into();
    let scene = RigidBody { J_d } + Gravity { m: 1.0, g: 9.81, rho: Vector3::z(), up: Vector3::z() };
    let far = RigidBody { J_d } + Gravity { m: 1e-300, g: 9.81, rho: Vector3::z(), up: long };
    let velocity = Vector3::new(0.1, 0.2, 0.3);
    let (stepper, distant) = (Stepper::new(scene, 0.01).unwrap(), Stepper::new(far, 0.01).unwrap());
    assert!(stepper.start(turned, velocity).is_ok());
    let refused = |start: Result<(), SetupError>| start.err().map(|error| error.to_string()).unwrap_or_default();
    assert!(refused(stepper.start(reflected, velocity).map(drop)).contains("not in the group (defect 2e0"));
    assert!(refused(distant.start(SO3::identity(), velocity).map(drop)).is_empty());
    assert!(refused(distant.start(turned, velocity).map(drop)).contains("view of what is advected"));
    // Collocation has further requirements.
    let error = Stepper::collocated::<1>(far, 0.01).map(drop).unwrap_err();
    assert!(matches!(error, SetupError::NotSeparable { .. }), "{error}");
    // The memory of collocation contains twice the momentum.
    let collocated = Stepper::collocated::<1>(scene, 0.01).unwrap();
    assert!(refused(collocated.start(reflected, velocity).map(drop)).contains("not in the group (defect 2e0"));
    let refused = collocated.start_with_momentum(turned, Vector3::repeat(1.7e308)).unwrap_err();
    assert_eq!(refused, SetupError::NonFinite { what: "velocity of the momentum" });
}
