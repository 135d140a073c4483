//! About a principal axis the momentum equation (2.7) of (3.13) reads `sin θ = hΩ`, and `π − θ` solves it too. Newton's
//! iteration started near that root settles there; the signs of the Jacobian's determinant and trace tell that it
//! doesn't continue the identity.

use declarations::FreeBody;
use liestep::groups::Retraction;
use liestep::mechanics::{DiscreteLagrangian, Effect as _};
use liestep::motion::DiscreteLiePoisson;
use liestep::{SO3, StepError};
use nalgebra::{UnitQuaternion, Vector3};

const STEP: f64 = 0.1;

/// Retraction coordinates of the rotation by `degrees` about `axis`.
fn guess<L: DiscreteLagrangian<Scalar = f64, Group = SO3>>(_: &L, axis: &Vector3<f64>, degrees: f64) -> Vector3<f64> {
    L::Retraction::local_coordinates(&UnitQuaternion::from_scaled_axis(axis * degrees.to_radians()).into()).unwrap()
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
}
