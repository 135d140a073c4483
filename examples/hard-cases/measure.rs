//! Distances and slopes.

use nalgebra::{Dim, Matrix, RawStorage};

pub(crate) use workbench::newton_tolerance::tenths::{Tenths, float, greater};

/// `|a − b| / |b|` in the Euclidean (Frobenius) norm.
pub(crate) fn relative<R: Dim, C: Dim, A: RawStorage<f64, R, C>, B: RawStorage<f64, R, C>>(
    a: &Matrix<f64, R, C, A>,
    b: &Matrix<f64, R, C, B>,
) -> f64 {
    let squared: f64 = a.iter().zip(b.iter()).map(|(a, b)| (a - b).powi(2)).sum();
    (squared / b.iter().map(|b| b * b).sum::<f64>()).sqrt()
}

/// The whole number of steps `h` in the time `t`.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // small positive numbers
pub(crate) fn steps_in(t: f64, h: f64) -> u64 {
    (t / h).round() as u64
}

/// The exponent of `y ∝ x^k` by least squares in logarithms; NaN below two points.
#[allow(clippy::cast_precision_loss)] // a handful of points
pub(crate) fn exponent(points: &[(f64, f64)]) -> f64 {
    let points: Vec<_> = points.iter().map(|(x, y)| (x.ln(), y.ln())).collect();
    let count = points.len() as f64;
    let (x, y) = points.iter().fold((0.0, 0.0), |(x, y), point| (x + point.0 / count, y + point.1 / count));
    let covariance: f64 = points.iter().map(|point| (point.0 - x) * (point.1 - y)).sum();
    covariance / points.iter().map(|point| (point.0 - x).powi(2)).sum::<f64>()
}

/// The steps `coarsest`, `coarsest/2`, … of four halvings.
pub(crate) fn four_halvings(coarsest: f64) -> [f64; 5] {
    [1.0, 0.5, 0.25, 0.125, 0.0625].map(|fraction| coarsest * fraction)
}
