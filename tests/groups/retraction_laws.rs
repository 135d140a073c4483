//! The laws of `Retraction` on SO(3): `τ(0) = e`, `τ(ξ)` is a rotation, `local_coordinates` is its inverse, the tangent
//! is `dF F⁻¹ = (T dξ)^`, and `D = τ(ξ) − I` keeps the digits of a small `ξ`.

use core::f64::consts::{FRAC_PI_2, PI};

use checks::random::Random;
use liestep::SO3;
use liestep::groups::{CayleyRetraction, ExponentialRetraction, LieGroup as _, Retraction};
use nalgebra::{Matrix3, Vector3};

/// Angles on both sides of the limits of formulas: `θ² = 0.01` and `0.04`, the latter also by way of `θ/2`.
const ANGLES: [f64; 14] =
    [0.0, 1e-300, 1e-160, 1e-12, 1e-8, 1e-4, 0.099_999, 0.100_001, 0.199_999, 0.200_001, 0.7, 1.5, 2.5, 3.1];

/// The bound is some products of 3 × 3 matrices.
const ROUNDING: f64 = 4e-15;

fn samples(seed: u64) -> Vec<(f64, Vector3<f64>)> {
    let mut random = Random::new(seed);
    ANGLES.iter().flat_map(|&angle| [angle; 10]).map(|angle| (angle, random.direction() * angle)).collect()
}

/// The series `Σ ξ̂ᵏ/(k + offset)!`: the exponential for zero, its right-trivialised tangent for one.
fn series(xi: &Vector3<f64>, offset: u32) -> Matrix3<f64> {
    let (hat, mut sum, mut term) = (SO3::hat(xi), Matrix3::zeros(), Matrix3::identity());
    for k in 0..40 {
        sum += term;
        term = term * hat / f64::from(k + 1 + offset);
    }
    sum
}

fn assert_round_trips<R: Retraction<SO3>>() {
    let mut random = Random::new(62);
    assert_eq!(R::local_coordinates(&SO3::identity()), Some(Vector3::zeros()));
    for f in random.hard_rotations() {
        let xi = R::local_coordinates(&f).unwrap();
        // The Cayley coordinates of a turn by `π − δ` are `4/δ`. The relative rounding `ε/δ` of `1 + tr F`, which is
        // `δ²/2`, changes them by `4ε/δ²`, and the angle by a `δ`-th part of that.
        let distance = R::retract(&xi).inverse().compose(&f).log().norm();
        let allowed = ROUNDING / (PI - f.log().norm()).min(1.0);
        assert!(distance < allowed, "{}: {distance:e}", f.log().norm());
    }
    for (angle, xi) in samples(63) {
        // The rounding of `F` is absolute, so coordinates are recovered to a rounding of one.
        let returned = R::local_coordinates(&R::retract(&xi)).unwrap();
        let back = R::retract(&returned).inverse().compose(&R::retract(&xi)).log().norm();
        assert!(back < ROUNDING / (PI - angle).min(1.0), "{angle}: {back:e}");
        if angle < 1.0 {
            assert!((returned - xi).norm() < ROUNDING, "{angle}");
        }
    }
}

/// The function `is_near_identity` tests for an angle below 90°.
fn assert_knows_a_quarter_turn<R: Retraction<SO3>>() {
    let mut random = Random::new(64);
    for _ in 0..20 {
        let near = R::local_coordinates(&random.rotation_by(FRAC_PI_2 - 1e-9)).unwrap();
        let far = R::local_coordinates(&random.rotation_by(FRAC_PI_2 + 1e-9)).unwrap();
        assert!(R::is_near_identity(&near) && !R::is_near_identity(&far));
        assert!(R::is_half_near_identity(&(near * 0.5)) && !R::is_half_near_identity(&(far * 0.5)));
        assert!(R::is_half_well_near_identity(&(near / 3.0)) && !R::is_half_well_near_identity(&(far / 3.0)));
    }
    assert!(R::is_near_identity(&Vector3::zeros()));
}

#[test]
fn cayley() {
    assert_round_trips::<CayleyRetraction>();
    assert_knows_a_quarter_turn::<CayleyRetraction>();
}

#[test]
fn exponential() {
    assert_round_trips::<ExponentialRetraction>();
    assert_knows_a_quarter_turn::<ExponentialRetraction>();
}

/// The Cayley map is `cay(ξ) = (I − ξ̂/2)⁻¹ (I + ξ̂/2)`, with nalgebra's inverse; the angle is `2 atan(|ξ|/2)`.
#[test]
fn cayley_map_by_its_definition() {
    for (angle, xi) in samples(65) {
        let half = SO3::hat(&xi) * 0.5;
        let defined = (Matrix3::identity() - half).try_inverse().unwrap() * (Matrix3::identity() + half);
        let f: SO3 = CayleyRetraction::retract(&xi);
        assert!((f.matrix() - defined).norm() < ROUNDING, "{angle}");
        assert!((f.log().norm() - 2.0 * (0.5 * xi.norm()).atan()).abs() < ROUNDING, "{angle}");
    }
}

/// Only half turns are out of range.
#[test]
fn cayley_map_does_not_reach_half_turns() {
    let half_turn: SO3 = SO3::try_from(Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, -1.0))).unwrap();
    assert_eq!(CayleyRetraction::local_coordinates(&half_turn), None);
    let log: Vector3<f64> = ExponentialRetraction::local_coordinates(&half_turn).unwrap();
    assert!((log.norm() - PI).abs() < ROUNDING);
}

#[test]
fn exponential_and_its_tangent_by_their_series() {
    for (angle, xi) in samples(66) {
        let f: SO3 = ExponentialRetraction::retract(&xi);
        let tangent = <ExponentialRetraction as Retraction<SO3>>::tangent(&xi);
        // The series loses the digits by which its largest term exceeds one, some units.
        assert!((f.matrix() - series(&xi, 0)).norm() < ROUNDING, "{angle}");
        assert!((tangent - series(&xi, 1)).norm() < ROUNDING, "{angle}");
    }
}
