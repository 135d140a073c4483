//! About a principal axis the momentum equation (2.7) of (3.13) reads `sin θ = hΩ`, and `π − θ` solves it too. Newton's
//! iteration started near that root settles there; the signs of the Jacobian's determinant and trace tell that it
//! doesn't continue the identity.

use declarations::{FreeBody, HeavyTop};
use liestep::groups::Retraction;
use liestep::mechanics::{DiscreteLagrangian, Effect as _, Regular};
use liestep::motion::DiscreteLiePoisson;
use liestep::{SO3, StepError};
use nalgebra::{UnitQuaternion, Vector3};

const STEP: f64 = 0.1;

/// Retraction coordinates of the rotation by `degrees` about `axis`.
fn guess<L: DiscreteLagrangian<Scalar = f64, Group = SO3>>(_: &L, axis: &Vector3<f64>, degrees: f64) -> Vector3<f64> {
    L::Retraction::local_coordinates(&UnitQuaternion::from_scaled_axis(axis * degrees.to_radians()).into()).unwrap()
}

/// Spins about each principal axis so fast that a step turns the body by 30°.
fn assert_trap_is_seen<L>(lagrangian: &L, w: &L::Advected)
where
    L: DiscreteLagrangian<Scalar = f64, Group = SO3> + Regular + Clone,
{
    let flow = DiscreteLiePoisson::new(lagrangian.clone(), STEP).unwrap();
    for axis in [Vector3::x(), Vector3::y(), Vector3::z()] {
        let momentum = lagrangian.inertia() * axis * (0.5 / STEP);
        let right = axis * 30.0_f64.to_radians();
        let refused = flow.invert_legendre_minus(&momentum, w, &guess(lagrangian, &axis, 150.0));
        assert!(matches!(refused, Err(StepError::WrongBranch { .. })), "from 150° about {axis}: {refused:?}");

        // From elsewhere Newton's iteration may reach either root, but the wrong one never comes out.
        for degrees in (0..=175).step_by(5) {
            match flow.invert_legendre_minus(&momentum, w, &guess(lagrangian, &axis, f64::from(degrees))) {
                // A rounding of the angle and one of the logarithm.
                Ok(found) => assert!((found.log() - right).norm() < 1e-15, "from {degrees}°: {found:?}"),
                Err(_) => assert!(degrees > 90, "no solution from {degrees}°"),
            }
        }

        // A step isn't left without an answer: it starts again at the identity.
        let step = flow.step(&momentum, w, &guess(lagrangian, &axis, 150.0)).unwrap();
        assert!((step.element().log() - right).norm() < 1e-15);
    }
}

#[test]
fn s3_the_determinant_tells() {
    let body = FreeBody::with_moments([3.0, 3.0, 4.0]);
    let flow = DiscreteLiePoisson::new(body.clone(), STEP).unwrap();
    let momentum = Vector3::z() * (4.0 * 0.5 / STEP);
    let refused = flow.invert_legendre_minus(&momentum, &(), &guess(&body, &Vector3::z(), 150.0));
    let Err(StepError::WrongBranch { determinant }) = refused else { panic!("{refused:?}") };
    assert!(determinant < 0.0);
}

/// About the intermediate axis of the flat body two eigenvalues of the Jacobian change sign on the way to the wrong
/// root, so the determinant is positive again; the trace tells.
#[test]
fn s3_the_determinant_alone_does_not_tell() {
    let body = FreeBody::with_moments([1.0, 2.0, 3.0]);
    let wrong = UnitQuaternion::from_scaled_axis(Vector3::y() * 150.0_f64.to_radians());
    let jacobian = body.momentum_jacobian(&wrong.to_rotation_matrix().into_inner(), &(), STEP);
    assert!(jacobian.determinant() > 0.0 && jacobian.trace() < 0.0);
    assert_trap_is_seen(&body, &());
}

#[test]
fn s3_free_bodies() {
    for moments in [[3.0, 3.0, 4.0], [2.0, 3.0, 4.5], [1.0, 1.0, 1.0]] {
        assert_trap_is_seen(&FreeBody::with_moments(moments), &());
    }
}

/// Without weight, so that the half kick doesn't move the root.
#[test]
fn s3_tops() {
    assert_trap_is_seen(&HeavyTop { g: 0.0, ..HeavyTop::thesis() }, &Vector3::z());
    assert_trap_is_seen(&HeavyTop { g: 0.0, ..HeavyTop::asymmetric() }, &Vector3::z());
}
