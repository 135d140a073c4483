//! The laws of `LieGroup` on SO(3): `Ad_F ξ = (F ξ̂ F⁻¹)^∨`, `ad_ξ η = (ξ̂η̂ − η̂ξ̂)^∨`, their transposes by the pairing,
//! hat and vee, exp and log, and the reconstruction.

use checks::random::Random;
use liestep::SO3;
use liestep::groups::{ExponentialRetraction, LieGroup as _, Retraction as _};
use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use num_dual::Dual64;
use workbench::measure::relative;

/// The bound is a product of three 3 × 3 matrices of size one.
const ROUNDING: f64 = 4e-15;

/// The basis element `E_k`, written out.
fn basis(k: usize) -> Matrix3<f64> {
    [
        Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0),
        Matrix3::new(0.0, 0.0, 1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0),
        Matrix3::new(0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    ][k]
}

/// The exponential of the library, through the general trait.
fn exponential(xi: &Vector3<f64>) -> SO3 {
    ExponentialRetraction::retract(xi)
}

#[test]
fn adjoint_actions_and_their_pairings() {
    let mut random = Random::new(53);
    for f in random.hard_rotations() {
        let (xi, eta, momentum) = (random.vector(), random.vector(), random.vector());
        let conjugated = f.matrix() * SO3::hat(&xi) * f.inverse().matrix();
        assert!((SO3::hat(&f.adjoint(&xi)) - conjugated).norm() < ROUNDING);
        assert!((f.adjoint_transpose(&momentum).dot(&xi) - momentum.dot(&f.adjoint(&xi))).abs() < ROUNDING);
        let commutator = SO3::hat(&xi) * SO3::hat(&eta) - SO3::hat(&eta) * SO3::hat(&xi);
        assert!((SO3::hat(&SO3::lie_bracket(&xi, &eta)) - commutator).norm() < ROUNDING);
        let paired = SO3::lie_bracket_transpose(&xi, &momentum).dot(&eta);
        assert!((paired - momentum.dot(&SO3::lie_bracket(&xi, &eta))).abs() < ROUNDING);

        let g = random.rotation();
        assert!((f.compose(&g).adjoint(&xi) - f.adjoint(&g.adjoint(&xi))).norm() < ROUNDING);
        let twice = g.adjoint_transpose(&f.adjoint_transpose(&momentum));
        assert!((f.compose(&g).adjoint_transpose(&momentum) - twice).norm() < ROUNDING);
    }
}

#[test]
fn logarithm_inverts_the_exponential() {
    let mut random = Random::new(55);
    for f in random.hard_rotations() {
        assert!(relative(&exponential(&f.log()).matrix(), &f.matrix()) < ROUNDING);
    }
    for angle in [1e-8, 1e-4, 0.1, 1.0, 2.0, 3.0, core::f64::consts::PI - 1e-6] {
        for _ in 0..20 {
            let xi = random.direction() * angle;
            let log = SO3::from(UnitQuaternion::from_scaled_axis(xi)).log();
            // The entries of a matrix determine a small angle to a rounding of the angle, and a larger one to a
            // rounding of one.
            assert!((log - xi).norm() < ROUNDING * angle.max(1e-1), "{angle}: {:e}", (log - xi).norm());
        }
    }
    assert_eq!(SO3::<f64>::identity().log(), Vector3::zeros());
}

#[test]
fn what_is_not_a_rotation_is_refused() {
    let mut random = Random::new(57);
    for f in random.hard_rotations() {
        let matrix = f.matrix();
        assert_eq!(SO3::try_from(matrix).unwrap(), f);
        // A reflection is orthogonal, too.
        let reflected = SO3::try_from(-matrix).unwrap_err();
        assert!((reflected.determinant + 1.0).abs() < ROUNDING && reflected.defect < ROUNDING);
        // The defect is `‖(1 + 10⁻⁹)² I − I‖ = 2√3 10⁻⁹`.
        let scaled = SO3::try_from(matrix * (1.0 + 1e-9)).unwrap_err();
        assert!((scaled.defect / (2.0 * 3.0_f64.sqrt() * 1e-9) - 1.0).abs() < 1e-5);
        assert!(SO3::try_from(matrix * f64::NAN).is_err());
    }
}

/// Dual numbers have correct derivatives at the identity: that of `exp` is the basis, `log` inverts it, and a velocity
/// at rest changes the attitude.
#[test]
fn derivatives_are_kept_at_zero() {
    for k in 0..3 {
        let along = Vector3::<f64>::ith(k, 1.0).map(|x| Dual64::new(0.0, x));
        let turned = SO3::exp(along);
        assert_eq!(turned.as_matrix().map(|x| x.eps), basis(k));
        assert_eq!(turned.log().map(|x| x.eps), Vector3::ith(k, 1.0));
        // The pitfall in the documentation of `exp`; if it is gone, the sentence can go, too.
        let lost = SO3::from(UnitQuaternion::from_scaled_axis(along));
        assert_eq!(lost.as_matrix().map(|x| x.eps), Matrix3::zeros());
    }
    for scale in [1e-9_f64, 0.3, 1.5, 1.6, 3.0] {
        let vector = Vector3::new(0.4, -0.7, 0.5).normalize() * scale;
        let same = SO3::from(UnitQuaternion::from_scaled_axis(vector));
        assert!((SO3::exp(vector).as_matrix() - same.as_matrix()).norm() < 1e-15);
        assert!((same.log() - vector).norm() < 1e-14 * scale.max(1e-2), "{scale}");
    }
}
