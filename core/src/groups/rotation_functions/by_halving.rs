//! Coefficients of rotations by small and large angles without a library function, for the same bits on every machine.
//!
//! The functions beside it use the library's sines at large angles: they serve declarations with `log` and `exp`, and
//! single elements. This one serves steps.

use nalgebra::SimdBool as _;

use crate::numbers::Number;

/// Bound of `q` up to which the polynomials are exact to a rounding.
const SMALL: f64 = 0.5;

/// Limit of the doublings, enough for any angle of a double with a digit left for its direction.
const MOST_DOUBLINGS: u32 = 53;

/// Bound of the squared angle beyond which the rounding of the doublings is visible in `sin² + cos² = 1`.
const FAR: f64 = 100.0;

/// The coefficients `sin θ/θ` and `(1 − cos θ)/θ²` as functions of `q = θ²`.
///
/// Up to `q = 0.5` these are Taylor polynomials. A larger angle is halved until it is that small; doubling it again
/// takes two products and no cancellation: with `S` and `V` at `q/4`, `S(q) = S (1 − q V/4)` and `V(q) = S²/2`. Each
/// doubling doubles the absolute error, as the angle's own rounding does. The error in the length of `(cos θ, sin θ)`
/// is normalised away, so that large angles are those of rotations, too; an angle without a digit left gives NaN.
#[hot]
pub(crate) fn rotation_coefficients<T: Number>(q: T) -> (T, T) {
    if q.simd_le(T::number(SMALL)).all() { small(q) } else { large(q) }
}

#[hot]
fn small<T: Number>(q: T) -> (T, T) {
    const SINC: [f64; 8] = coefficients(1);
    const VERSINE: [f64; 8] = coefficients(2);
    let (q2, q4) = (q * q, q * q * (q * q));
    (polynomial(&SINC, q, q2, q4), polynomial(&VERSINE, q, q2, q4))
}

fn large<T: Number>(q: T) -> (T, T) {
    let quarter = T::number(0.25);
    let mut reduced = q;
    let mut doublings = 0;
    // Lanes whose angles are small already stay as they are. A NaN never becomes small.
    while doublings < MOST_DOUBLINGS && reduced.simd_gt(T::number(SMALL)).any() {
        reduced = (reduced * quarter).select(reduced.simd_gt(T::number(SMALL)), reduced);
        doublings += 1;
    }
    let (mut sinc, mut versine) = small(reduced);
    for _ in 0..doublings {
        let behind = reduced.simd_lt(q);
        let next = (sinc * (T::one() - reduced * versine), sinc * sinc * T::number(0.5));
        sinc = next.0.select(behind, sinc);
        versine = next.1.select(behind, versine);
        reduced = (reduced * T::number(4.0)).select(behind, reduced);
    }
    let far = q.simd_gt(T::number(FAR));
    if far.any() {
        let cosine = T::one() - q * versine;
        let length = (q * sinc * sinc + cosine * cosine).simd_sqrt();
        sinc = (sinc / length).select(far, sinc);
        versine = ((T::one() - cosine / length) / q).select(far, versine);
        let epsilon = T::simd_default_epsilon();
        let is_known = (q * epsilon * epsilon).simd_lt(T::one());
        sinc = sinc.select(is_known, T::number(f64::NAN));
        versine = versine.select(is_known, T::number(f64::NAN));
    }
    (sinc, versine)
}

/// The polynomial `Σ a_k q^k` in pairs, independent of each other; small terms are added first, as a large sum would
/// round each of them off.
#[hot]
fn polynomial<T: Number>(a: &[f64; 8], q: T, q2: T, q4: T) -> T {
    let pair = |k: usize| T::number(a[k]) + q * T::number(a[k + 1]);
    pair(0) + (q2 * pair(2) + q4 * (pair(4) + q2 * pair(6)))
}

/// The coefficients `(−1)^k/(2k + first)!`.
#[allow(clippy::cast_precision_loss)] // small integers
const fn coefficients(first: usize) -> [f64; 8] {
    let (mut coefficients, mut k) = ([0.0; 8], 0);
    let mut coefficient = if first == 1 { 1.0 } else { 0.5 };
    while k < 8 {
        coefficients[k] = coefficient;
        coefficient = -coefficient / (((2 * k + first + 1) * (2 * k + first + 2)) as f64);
        k += 1;
    }
    coefficients
}

#[cfg(test)]
mod tests {
    use super::{rotation_coefficients, small};

    /// Angles on both sides of each change of the number of doublings, and some beyond a turn.
    #[test]
    fn they_are_sine_and_cosine() {
        for q in [1e-20, 0.3, 0.5, 0.500_001, 1.999_999, 2.000_001, 8.0, 9.8, 30.0, 200.0] {
            let angle: f64 = f64::sqrt(q);
            let (sinc, versine) = rotation_coefficients(q);
            let half = (0.5 * angle).sin() / angle;
            assert!((sinc - angle.sin() / angle).abs() < 4e-16, "{q}: {sinc}");
            assert!((versine - 2.0 * half * half).abs() < 4e-16, "{q}: {versine}");
        }
        assert_eq!(rotation_coefficients(0.0), (1.0, 0.5));
    }

    /// Large angles are exact to the rounding of the angle, and on the unit circle.
    #[test]
    fn large_angles_are_angles() {
        for angle in [11.0, 1e2, 1.3e3, 1e4, 7e5, 1e6, 1e9, 3e9, 1e12, 1e15_f64] {
            let (sinc, versine) = rotation_coefficients(angle * angle);
            let (sine, cosine) = (angle * sinc, 1.0 - angle * angle * versine);
            assert!((sine * sine + cosine * cosine - 1.0).abs() < 1e-15, "{angle:e}");
            assert!((sine - angle.sin()).abs() < 8e-16 * angle, "{angle:e}");
            assert!((cosine - angle.cos()).abs() < 8e-16 * angle, "{angle:e}");
        }
        for angle in [5e15, 1e20, 1e150_f64] {
            assert!(rotation_coefficients(angle * angle).0.is_nan());
        }
        let (sinc, versine) = rotation_coefficients(1e10_f32);
        assert!((1e10 * sinc * sinc + (1.0 - 1e10 * versine).powi(2) - 1.0).abs() < 1e-6);
        assert!(rotation_coefficients(1e16_f32).0.is_nan());
    }

    #[test]
    fn neither_a_nan_nor_an_infinity_is_waited_for() {
        assert!(rotation_coefficients(f64::NAN).0.is_nan());
        assert!(!rotation_coefficients(f64::INFINITY).0.is_finite());
    }

    #[test]
    fn the_polynomials_are_long_enough() {
        let (sinc, versine) = small(0.5);
        assert!((sinc - 0.5_f64.sqrt().sin() / 0.5_f64.sqrt()).abs() < 2e-16);
        assert!((versine - (1.0 - 0.5_f64.sqrt().cos()) / 0.5).abs() < 4e-16);
    }
}
