//! Properties of each group beside the laws: its basis, its constructors, its refusals, and the domains of its
//! retractions.

use core::f64::consts::PI;

use liestep::groups::{CayleyRetraction, ExponentialRetraction, LieGroup, NotInGroup, R3, Retraction, SL2, SU2};
use liestep::laws::samples::Random;
use liestep::prelude::*;
use nalgebra::{
    Isometry2, Isometry3, Matrix2, Matrix3, Matrix4, SVector, UnitComplex, UnitQuaternion, Vector1, Vector2, Vector3,
};

/// The bound is some products of small matrices.
const ROUNDING: f64 = 4e-15;

fn rotation(random: &mut Random) -> UnitQuaternion<f64> {
    UnitQuaternion::from_scaled_axis(random.sample::<Vector3<f64>>())
}

/// The bracket `[(ω, v), (ω', v')] = (ω × ω', ω × v' − ω' × v)`.
#[test]
fn rigid_motions_of_space() {
    let mut random = Random::new(71);
    let (x, y): (SVector<f64, 6>, SVector<f64, 6>) = (random.sample(), random.sample());
    let part = |v: &SVector<f64, 6>, at: usize| v.fixed_rows::<3>(at).into_owned();
    let bracket = SE3::<f64>::lie_bracket(&x, &y);
    assert!((part(&bracket, 0) - part(&x, 0).cross(&part(&y, 0))).norm() < ROUNDING);
    let linear = part(&x, 0).cross(&part(&y, 3)) - part(&y, 0).cross(&part(&x, 3));
    assert!((part(&bracket, 3) - linear).norm() < ROUNDING);

    let (turn, shift): (_, Vector3<f64>) = (rotation(&mut random), random.sample());
    let motion = SE3::from_rotation_and_translation(turn, shift);
    assert!(motion.rotation().angle_to(&turn) < ROUNDING && motion.translation() == shift);
    let isometry = Isometry3::from_parts(shift.into(), turn);
    assert_eq!(SE3::from(isometry), motion);
    assert!((Isometry3::from(motion).to_homogeneous() - motion.matrix()).norm() < ROUNDING);
    assert_eq!(SE3::try_from(motion.matrix()), Ok(motion));

    let mut reflected = motion.matrix();
    reflected.fixed_view_mut::<3, 3>(0, 0).neg_mut();
    assert!(SE3::<f64>::try_from(reflected).unwrap_err().defect > 1.9);
    let mut projective = motion.matrix();
    projective[(3, 0)] = 1e-3;
    assert!((SE3::<f64>::try_from(projective).unwrap_err().defect - 1e-3).abs() < 1e-12);
    assert!(SE3::<f64>::try_from(motion.matrix() * f64::NAN).unwrap_err().defect.is_nan());
}

/// The bracket `[(ω, v), (ω', v')] = (0, ω × v' − ω' × v)`.
#[test]
fn rigid_motions_of_the_plane() {
    let bracket = SE2::<f64>::lie_bracket(&Vector3::new(2.0, 3.0, 5.0), &Vector3::new(7.0, 11.0, 13.0));
    assert_eq!(bracket, Vector3::new(0.0, -2.0 * 13.0 + 7.0 * 5.0, 2.0 * 11.0 - 7.0 * 3.0));
    let motion = SE2::from_rotation_and_translation(UnitComplex::new(2.5_f64), Vector2::new(1.0, 2.0));
    assert!((motion.rotation().angle() - 2.5).abs() < ROUNDING);
    assert_eq!(SE2::from(Isometry2::new(Vector2::new(1.0, 2.0), 2.5)), motion);
    assert!((Isometry2::from(motion).to_homogeneous() - motion.matrix()).norm() < ROUNDING);
    let scaled = SE2::<f64>::try_from(Matrix3::from_diagonal(&Vector3::new(1.1, 1.1, 1.0)));
    // The defect contains both entries of the Gram matrix, and the determinant.
    assert!((scaled.unwrap_err().defect - 0.21 * 3.0_f64.sqrt()).abs() < ROUNDING);
}

/// The rotations, brackets and components are those of SO(3), which is covered twice.
#[test]
fn unit_quaternions() {
    let mut random = Random::new(72);
    for _ in 0..20 {
        let (x, y): (Vector3<f64>, Vector3<f64>) = (random.sample(), random.sample());
        assert!((SU2::<f64>::lie_bracket(&x, &y) - x.cross(&y)).norm() < ROUNDING);
        let q: SU2 = ExponentialRetraction::retract(&x);
        assert!(q.to_quaternion().angle_to(&UnitQuaternion::from_scaled_axis(x)) < ROUNDING);
        assert!((q.adjoint(&y) - UnitQuaternion::from_scaled_axis(x) * y).norm() < ROUNDING);
        let product = SU2::from(rotation(&mut random)).compose(&q);
        assert_eq!(SU2::try_from(product.matrix()), Ok(product));
    }
    let minus = SU2::<f64>::try_from(-Matrix4::identity()).unwrap();
    assert_eq!(minus.to_quaternion().scaled_axis(), Vector3::zeros());
    // A rotation of four dimensions that multiplies from the right isn't in the group.
    let mut right = SU2::<f64>::hat(&Vector3::new(2.0, 0.0, 0.0));
    right.fixed_view_mut::<2, 2>(2, 2).neg_mut();
    assert!(SU2::<f64>::try_from(right).is_err());
}

#[test]
fn rotations_of_the_plane() {
    for angle in [-3.1_f64, -1.0, 0.0, 1e-12, 2.0, 3.1] {
        let turn = SO2::from(UnitComplex::new(angle));
        assert!((turn.angle() - angle).abs() < ROUNDING);
        let xi = ExponentialRetraction::local_coordinates(&turn).unwrap();
        // Near a half turn the root of a matrix loses as many digits as the angle is close to it.
        assert!((xi - Vector1::new(angle)).norm() < 1e-12, "{angle}: {xi}");
        let xi: Vector1<f64> = CayleyRetraction::local_coordinates(&turn).unwrap();
        assert!((xi.x - 2.0 * (angle / 2.0).tan()).abs() < 1e-12 * (1.0 + xi.x * xi.x), "{angle}");
    }
    assert!(SO2::<f64>::try_from(Matrix2::new(1.0, 0.0, 0.0, -1.0)).is_err());
}

/// An eigenvalue of −1 excludes Cayley coordinates, a negative one a real logarithm.
#[test]
fn coordinates_end_where_they_must() {
    let negative = SL2::<f64>::try_from(Matrix2::new(-2.0, 0.0, 0.0, -0.5)).unwrap();
    assert_eq!(ExponentialRetraction::local_coordinates(&negative), None);
    let xi: Vector3<f64> = CayleyRetraction::local_coordinates(&negative).unwrap();
    let back: SL2 = CayleyRetraction::retract(&xi);
    assert!((back.matrix() - negative.matrix()).norm() < ROUNDING);
    let half_turn = SL2::<f64>::try_from(Matrix2::new(-1.0, 0.0, 0.0, -1.0)).unwrap();
    assert_eq!(CayleyRetraction::local_coordinates(&half_turn), None);
    assert_eq!(CayleyRetraction::local_coordinates(&SU2::<f64>::try_from(-Matrix4::identity()).unwrap()), None);
    let unusable = SE3::<f64>::from_matrix_unchecked(Matrix4::identity() * f64::NAN);
    assert_eq!(CayleyRetraction::local_coordinates(&unusable), None);
    assert_eq!(ExponentialRetraction::local_coordinates(&unusable), None);
    // Out of range, neither function loops for ever or panics.
    let huge: SO2 = ExponentialRetraction::retract(&Vector1::new(1e300));
    assert!(!huge.defect().is_finite() || huge.defect() >= 0.0);
}

/// The exponential up to some turns, on both sides of each number of halvings.
#[test]
fn exponential_by_its_closed_form() {
    for angle in [1e-160, 1e-8, 0.35, 0.36, 0.7, 0.71, 1.4, 1.5, 2.8, 2.9, 3.1, 6.0, 12.0] {
        let turn: SO2 = ExponentialRetraction::retract(&Vector1::new(angle));
        let expected = Matrix2::new(angle.cos(), -angle.sin(), angle.sin(), angle.cos());
        assert!((turn.matrix() - expected).norm() < ROUNDING * angle.max(1.0), "{angle}");
        let stretch: SL2 = ExponentialRetraction::retract(&Vector3::new(2.0 * angle, 0.0, 0.0));
        let expected = Matrix2::new(angle.exp(), 0.0, 0.0, (-angle).exp());
        assert!((stretch.matrix() - expected).norm() < ROUNDING * angle.max(1.0) * expected.norm(), "{angle}");
    }
}

/// The rotation alone decides, not the translation.
#[test]
fn near_the_identity() {
    let near = |angle: f64, shift: f64| {
        let xi = Vector3::new(angle, shift, 0.0);
        <CayleyRetraction as Retraction<SE2>>::is_near_identity(&xi)
    };
    assert!(near(1.0 - 1e-12, 1e9) && near(1e-12 - 1.0, 0.0) && !near(1.0 + 1e-12, 0.0));
    assert!(<CayleyRetraction as Retraction<R3>>::is_near_identity(&Vector3::repeat(1e9)));
    let stretched = |size: f64| <CayleyRetraction as Retraction<SL2>>::is_near_identity(&(Vector3::x() * size));
    // The size is `‖½ diag(1, −1)‖ = 1/√2`.
    assert!(stretched(2.0_f64.sqrt() - 1e-12) && !stretched(2.0_f64.sqrt() + 1e-12));
}

#[test]
fn a_refusal_says_by_how_much() {
    let error = SL2::<f64>::try_from(Matrix2::new(2.0, 0.0, 0.0, 1.0)).unwrap_err();
    assert_eq!(error, NotInGroup { defect: 1.0 });
    assert!(error.to_string().contains("misses the group's relation by 1e0"));
}

/// In single precision only the rounding is larger.
#[test]
fn single_precision() {
    let mut random = Random::new(73);
    for _ in 0..20 {
        let xi: SVector<f64, 6> = random.sample();
        let (double, single): (SE3, SE3<f32>) =
            (CayleyRetraction::retract(&xi), CayleyRetraction::retract(&xi.cast::<f32>()));
        assert!((single.matrix().cast::<f64>() - double.matrix()).norm() < 1e-5);
        let back: SVector<f32, 6> = ExponentialRetraction::local_coordinates(&single).unwrap();
        let expected: SVector<f64, 6> = ExponentialRetraction::local_coordinates(&double).unwrap();
        assert!((back.cast::<f64>() - expected).norm() < 1e-5 * (1.0 + PI));
    }
}

/// Components in angles, metres and stretches are distinguished.
#[test]
fn components_that_turn() {
    let turning = |components: &[usize], of: Vec<bool>| {
        let found: Vec<usize> = (0..of.len()).filter(|&component| of[component]).collect();
        assert_eq!(found, components);
    };
    turning(&[0, 1, 2], SO3::<f64>::turning_components());
    turning(&[0], SO2::<f64>::turning_components());
    turning(&[0], SE2::<f64>::turning_components());
    turning(&[0, 1, 2], SE3::<f64>::turning_components());
    turning(&[0, 1, 2], SU2::<f64>::turning_components());
    turning(&[2], SL2::<f64>::turning_components());
    turning(&[], R3::<f64>::turning_components());
    turning(&[3, 4, 5, 9, 10, 11], <[(R3, SO3); 2]>::turning_components());
}
