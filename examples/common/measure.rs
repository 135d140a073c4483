//! Distances, orders, and drifts of a run.

use liestep_refinement::Refinement;
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

/// The order by [`Refinement::order_above`] of steps and errors. It is NaN, which fails every bound, if too few errors
/// are above the plateau.
pub fn order(errors: &[(f64, f64)], plateau: f64) -> f64 {
    Refinement::of(errors.iter().copied()).order_above(plateau).unwrap_or(f64::NAN)
}

/// The number of steps `h` in the time `t`.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // small positive numbers
pub fn steps_in(t: f64, h: f64) -> u64 {
    (t / h).round() as u64
}
