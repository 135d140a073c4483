//! The two families of scalar functions in the exponential and the logarithm of SO(3).
//!
//! ```text
//! exp(v̂) = I + c₁(q) v̂ + c₂(q) v̂²                         q = |v|²
//! log F   = G(n) ½ (F − Fᵀ)^∨                               n = (3 − tr F)/4 = sin²(θ/2)
//! ```
//!
//! with the Stumpff functions `c_k(q) = Σ (−q)ⁱ/(2i + k)!` (`c₁ = sin θ/θ`, `c₂ = (1 − cos θ)/θ²`) and
//! `G(n) = θ/sin θ = Σ nᵐ m!/(3/2)_m`. Both are analytic at the identity, where `θ` isn't, and their derivatives stay
//! in the family: `c_k' = (k c_{k+2} − c_{k+1})/2` and `2n(1 − n) G⁽ᵏ⁺¹⁾ = 2k² G⁽ᵏ⁻¹⁾ − (2k + 1)(1 − 2n) G⁽ᵏ⁾`, with
//! one in place of the first term for `k = 0`.

mod by_halving;
mod quaternion;

pub(crate) use by_halving::rotation_coefficients;
pub(super) use quaternion::quaternion;

use crate::numbers::{Real, real};
use nalgebra::{Matrix3, SMatrix, SimdBool as _, Vector3};

/// Terms of the series near zero, the usual case of a step.
const FEW: usize = 9;
/// Terms of the logarithm's series at large steps, up to 0.7 rad: the full series would take as long as the rest of a
/// residual.
const SOME: usize = 20;
/// Terms of the series up to the bound beyond which the closed forms are as exact.
const MANY: usize = 34;

/// The Stumpff function `c_K(q)` for `q ≥ 0`.
#[inline]
pub fn stumpff<T: Real, const K: usize>(q: T) -> T {
    const { assert!(K > 0, "c₀ is the cosine") };
    if q.simd_le(real(0.5)).all() {
        return polynomial(&const { Series::<FEW>::stumpff(K) }, q);
    }
    let series = polynomial(&const { Series::<MANY>::stumpff(K) }, q);
    let near = q.simd_le(real(12.0));
    if near.all() {
        return series;
    }
    // The recurrence c_{k+2} = (1/k! − c_k)/q gains digits upwards at large q.
    let root = q.simd_sqrt();
    let (mut even, mut odd) = (root.simd_cos(), root.simd_sin() / root);
    let mut reciprocal_factorial = 1.0;
    for k in 0..K.saturating_sub(1) {
        if k > 0 {
            #[allow(clippy::cast_precision_loss)] // a small integer
            let next = k as f64;
            reciprocal_factorial /= next;
        }
        let lower = if k.is_multiple_of(2) { &mut even } else { &mut odd };
        *lower = (real::<T>(reciprocal_factorial) - *lower) / q;
    }
    series.select(near, if K.is_multiple_of(2) { even } else { odd })
}

/// The `K`-th derivative of `G(n)` for `0 ≤ n < 1`.
#[inline]
pub fn log_ratio<T: Real, const K: usize>(n: T) -> T {
    if n.simd_le(real(0.015)).all() {
        return polynomial(&const { Series::<FEW>::log_ratio(K) }, n);
    }
    if n.simd_le(real(0.12)).all() {
        return polynomial(&const { Series::<SOME>::log_ratio(K) }, n);
    }
    let series = polynomial(&const { Series::<MANY>::log_ratio(K) }, n);
    let near = n.simd_le(real(0.25));
    if near.all() {
        return series;
    }
    let (one, two) = (real::<T>(1.0), real::<T>(2.0));
    let (slope, twice) = (one - two * n, two * n * (one - n));
    let mut lower = n.simd_sqrt().simd_asin() / (n * (one - n)).simd_sqrt();
    if K == 0 {
        return series.select(near, lower);
    }
    let mut value = (one - slope * lower) / twice;
    for k in 1..K {
        #[allow(clippy::cast_precision_loss)] // a small integer
        let k = k as f64;
        let next = (real::<T>(2.0 * k * k) * lower - real::<T>(2.0 * k + 1.0) * slope * value) / twice;
        (lower, value) = (value, next);
    }
    series.select(near, value)
}

/// The coefficients of the longest series of `c_k(q)`, of which the shorter ones are the first, for texts in other languages.
#[must_use]
pub const fn stumpff_series(k: usize) -> [f64; MANY] {
    Series::stumpff(k)
}

/// The coefficients of the longest series of `G⁽ᵏ⁾(n)`, of which the shorter ones are the first.
#[must_use]
pub const fn log_ratio_series(k: usize) -> [f64; MANY] {
    Series::log_ratio(k)
}

/// The rotation vector `ξ` of `F = exp(ξ̂)`, rad.
#[inline]
pub fn rotation_log<T: Real>(rotation: Matrix3<T>) -> Vector3<T> {
    let n = (real::<T>(3.0) - rotation.trace()) * real(0.25);
    skew_components(&rotation) * log_ratio::<T, 0>(n)
}

/// The components of the skew part of a matrix: `v` of `v̂`.
#[inline]
pub(super) fn skew_components<T: Real>(m: &Matrix3<T>) -> Vector3<T> {
    Vector3::new(m.m32 - m.m23, m.m13 - m.m31, m.m21 - m.m12) * real::<T>(0.5)
}

/// The rotation `exp(v̂)`.
#[inline]
pub fn rotation_exp<T: Real>(v: Vector3<T>) -> Matrix3<T> {
    let (q, hat) = (v.norm_squared(), v.cross_matrix());
    Matrix3::identity() + hat * stumpff::<T, 1>(q) + hat * hat * stumpff::<T, 2>(q)
}

/// The inverse `A⁻¹` of a matrix of up to three rows by Cramer's rule, not finite if `A` is singular.
#[inline]
pub fn inverse<T: Real, const N: usize>(matrix: SMatrix<T, N, N>) -> SMatrix<T, N, N> {
    const { assert!(N <= 3) };
    // Minors with rows and columns in cyclic order include their sign, except for 2 × 2.
    let adjugate = SMatrix::<T, N, N>::from_fn(|column, row| {
        let at = |i: usize, j: usize| matrix[((row + i) % N, (column + j) % N)];
        match N {
            1 => T::one(),
            2 if row == column => at(1, 1),
            2 => -at(1, 1),
            _ => at(1, 1) * at(2, 2) - at(1, 2) * at(2, 1),
        }
    });
    let determinant = (0..N).fold(T::zero(), |sum, k| sum + matrix[(0, k)] * adjugate[(k, 0)]);
    adjugate / determinant
}

/// The first coefficients of a power series.
struct Series<const N: usize>;

impl<const N: usize> Series<N> {
    #[allow(clippy::cast_precision_loss)] // indices
    const fn stumpff(k: usize) -> [f64; N] {
        let (mut coefficients, mut m) = ([0.0; N], 0);
        let mut coefficient = 1.0;
        let mut i = 2;
        while i <= k {
            coefficient /= i as f64;
            i += 1;
        }
        while m < N {
            coefficients[m] = coefficient;
            coefficient = -coefficient / (((2 * m + k + 1) * (2 * m + k + 2)) as f64);
            m += 1;
        }
        coefficients
    }

    #[allow(clippy::cast_precision_loss)] // indices
    const fn log_ratio(derivative: usize) -> [f64; N] {
        let (mut coefficients, mut m) = ([0.0; N], 0);
        let mut coefficient = 1.0;
        while m < N + derivative {
            if m >= derivative {
                let (mut falling, mut i) = (1.0, 0);
                while i < derivative {
                    falling *= (m - i) as f64;
                    i += 1;
                }
                coefficients[m - derivative] = coefficient * falling;
            }
            coefficient *= ((m + 1) as f64) / (m as f64 + 1.5);
            m += 1;
        }
        coefficients
    }
}

/// A polynomial by Horner's rule in `x⁴`: four chains that the processor runs side by side. The latency of a single one
/// would be that of the step.
#[hot]
fn polynomial<T: Real, const N: usize>(coefficients: &[f64; N], x: T) -> T {
    let square = x * x;
    let fourth = square * square;
    let chain = |first: usize| {
        let mut links = coefficients.iter().skip(first).step_by(4).rev();
        let last = links.next().map_or(T::zero(), |&last| real(last));
        links.fold(last, |sum, &coefficient| sum * fourth + real(coefficient))
    };
    (chain(0) + chain(2) * square) + (chain(1) + chain(3) * square) * x
}

#[cfg(test)]
mod tests {
    use super::{inverse, log_ratio, rotation_exp, rotation_log, stumpff};
    use nalgebra::{Matrix1, Matrix2, Matrix3, Vector3};

    /// Both sides of every threshold, the thresholds themselves, and the ends of the range.
    const STUMPFF: [f64; 9] = [0.0, 1e-9, 0.3, 0.5, 0.500_001, 4.0, 11.999, 12.001, 60.0];
    const LOG: [f64; 11] = [0.0, 1e-9, 0.01, 0.015, 0.015_001, 0.1, 0.12, 0.120_001, 0.249_999, 0.250_001, 0.95];

    fn close(found: f64, expected: f64, tolerance: f64) {
        assert!((found - expected).abs() <= tolerance * expected.abs(), "{found:e}, not {expected:e}");
    }

    #[test]
    fn stumpff_functions_are_sine_and_cosine() {
        for q in STUMPFF.into_iter().skip(1) {
            let theta = q.sqrt();
            let half: f64 = (0.5 * theta).sin();
            close(stumpff::<_, 1>(q), theta.sin() / theta, 1e-14 + 1e-15 * q * q);
            close(stumpff::<_, 2>(q), 2.0 * half * half / q, 1e-14 + 1e-15 * q * q);
        }
    }

    #[test]
    fn stumpff_functions_satisfy_their_recurrence() {
        for q in STUMPFF {
            for (lower, upper, factorial) in [
                (stumpff::<_, 1>(q), stumpff::<_, 3>(q), 1.0),
                (stumpff::<_, 2>(q), stumpff::<_, 4>(q), 2.0),
                (stumpff::<_, 3>(q), stumpff::<_, 5>(q), 6.0),
                (stumpff::<_, 4>(q), stumpff::<_, 6>(q), 24.0),
            ] {
                close(lower + q * upper, 1.0 / factorial, 1e-14);
            }
        }
    }

    #[test]
    fn the_ratio_is_an_angle_over_its_sine() {
        for n in LOG.into_iter().skip(1) {
            let theta = 2.0 * n.sqrt().asin();
            close(log_ratio::<_, 0>(n), theta / theta.sin(), 1e-14);
        }
    }

    #[test]
    fn its_derivatives_satisfy_their_recurrence() {
        for n in LOG {
            let [g0, g1, g2, g3] =
                [log_ratio::<_, 0>(n), log_ratio::<_, 1>(n), log_ratio::<_, 2>(n), log_ratio::<_, 3>(n)];
            let (slope, twice) = (1.0 - 2.0 * n, 2.0 * n * (1.0 - n));
            close(twice * g1 + slope * g0, 1.0, 1e-14);
            close(twice * g2 + 3.0 * slope * g1, 2.0 * g0, 1e-13);
            close(twice * g3 + 5.0 * slope * g2, 8.0 * g1, 1e-12);
        }
        close(log_ratio::<f64, 1>(0.0), 2.0 / 3.0, 1e-15);
        close(log_ratio::<f64, 2>(0.0), 16.0 / 15.0, 1e-15);
    }

    #[test]
    fn exponential_and_logarithm_are_inverse() {
        for angle in [0.0, 1e-9, 0.1, 1.0, 3.0] {
            let v = Vector3::new(2.0, -1.0, 2.0) * (angle / 3.0);
            let rotation = nalgebra::Rotation3::new(v).into_inner();
            assert!((rotation_exp(v) - rotation).norm() < 1e-14);
            assert!((rotation_log(rotation) - v).norm() <= 1e-13 * angle);
        }
    }

    #[test]
    fn an_inverse_is_one() {
        let three = Matrix3::new(2.0, 0.3, 0.1, -0.4, 3.0, 0.2, 0.5, -0.6, 4.0);
        assert!((three * inverse(three) - Matrix3::identity()).norm() < 1e-15);
        let two = Matrix2::new(2.0, 0.3, -0.4, 3.0);
        assert!((two * inverse(two) - Matrix2::identity()).norm() < 1e-15);
        assert!((inverse(Matrix1::new(4.0))[0] - 0.25_f64).abs() < 1e-16);
    }
}
