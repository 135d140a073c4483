//! Distances, orders, and what is left of a run.

use nalgebra::{Dim, Matrix, RawStorage};

pub use crate::tenths::{Tenths, float, greater};

/// `|a − b| / |b|` in the Euclidean (Frobenius) norm.
pub fn relative<R: Dim, C: Dim, A: RawStorage<f64, R, C>, B: RawStorage<f64, R, C>>(
    a: &Matrix<f64, R, C, A>,
    b: &Matrix<f64, R, C, B>,
) -> f64 {
    let squared: f64 = a.iter().zip(b.iter()).map(|(a, b)| (a - b).powi(2)).sum();
    (squared / b.iter().map(|b| b * b).sum::<f64>()).sqrt()
}

/// The steps `coarsest`, `coarsest/2`, … of four halvings.
pub fn four_halvings(coarsest: f64) -> [f64; 5] {
    [1.0, 0.5, 0.25, 0.125, 0.0625].map(|fraction| coarsest * fraction)
}

/// The slope of `ln error` over `ln h` by least squares, over the points above the round-off plateau.
///
/// NaN if fewer than four points are left, so that a slope isn't read off the plateau's edge.
pub fn order(errors: &[(f64, f64)], plateau: f64) -> f64 {
    let above = errors.iter().filter(|(_, error)| *error > plateau);
    let points: Vec<(f64, f64)> = above.map(|(h, error)| (h.ln(), error.ln())).collect();
    if points.len() >= 4 { slope(&points) } else { f64::NAN }
}

/// The slope of a straight line through the points, by least squares.
#[allow(clippy::cast_precision_loss)] // a handful of points
pub fn slope(points: &[(f64, f64)]) -> f64 {
    let count = points.len() as f64;
    let (x, y) = points.iter().fold((0.0, 0.0), |(x, y), point| (x + point.0 / count, y + point.1 / count));
    let covariance: f64 = points.iter().map(|point| (point.0 - x) * (point.1 - y)).sum();
    covariance / points.iter().map(|point| (point.0 - x).powi(2)).sum::<f64>()
}

/// The whole number of steps `h` in the time `t`.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // small positive numbers
pub fn steps_in(t: f64, h: f64) -> u64 {
    (t / h).round() as u64
}
