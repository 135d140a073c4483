//! The exponential of a matrix, the series of its derivative, and the logarithm.

use nalgebra::{RealField, SMatrix};

use super::generators::inverse;
use crate::numbers::real;

/// Limit of the halvings. The exponential of a matrix beyond `2⁶⁴` overflows or has no digits.
const MAX_HALVINGS: u32 = 64;

/// The pair `(e^X − I, Σ X^k/(k + 1)!)`, neither computed by subtracting `I`.
///
/// The series are summed for `X` of a norm up to ½ and doubled: `e^{2X} − I = 2D + D²`, and
/// `P(2X) = ½ (e^X + I) P(X) = P + ½ D P` for `P(X) = X⁻¹(e^X − I)`.
pub(crate) fn exponential<T: RealField + Copy, const N: usize>(
    x: &SMatrix<T, N, N>,
) -> (SMatrix<T, N, N>, SMatrix<T, N, N>) {
    let half = real::<T>(0.5);
    let (mut scaled, mut halvings) = (*x, 0);
    while scaled.norm() > half && halvings < MAX_HALVINGS {
        scaled *= half;
        halvings += 1;
    }
    // The first omitted term, `½¹⁵/16!`, is below half a rounding.
    let mut mean = SMatrix::identity();
    for k in (2..=15).rev() {
        mean = SMatrix::identity() + scaled * mean / real::<T>(f64::from(k));
    }
    let mut increment = scaled * mean;
    for _ in 0..halvings {
        mean += increment * mean * half;
        increment = increment * real::<T>(2.0) + increment * increment;
    }
    (increment, mean)
}

/// The logarithm `log(I + D)`, meaningless if the principal one doesn't exist.
///
/// Square roots reduce `D` to a norm of ¼; then `log F = 2 artanh Z` with `Z = (F + I)⁻¹ (F − I)`.
pub(crate) fn logarithm<T: RealField + Copy, const N: usize>(increment: &SMatrix<T, N, N>) -> SMatrix<T, N, N> {
    let identity = SMatrix::<T, N, N>::identity();
    let (mut root, mut factor) = (*increment, real::<T>(2.0));
    for _ in 0..MAX_HALVINGS {
        if root.norm() <= real(0.25) {
            break;
        }
        root = square_root(&(root + identity)) - identity;
        factor += factor;
    }
    let z = inverse(&(root + identity + identity)) * root;
    let squared = z * z;
    // The first omitted term, `7⁻²⁰/21` for `‖Z‖ ≤ 1/7`, is below half a rounding.
    let mut series = SMatrix::zeros();
    for k in (0..10).rev() {
        series = identity / real::<T>(f64::from(2 * k + 1)) + squared * series;
    }
    z * series * factor
}

/// The principal square root by the iteration of Denman and Beavers (1976).
fn square_root<T: RealField + Copy, const N: usize>(matrix: &SMatrix<T, N, N>) -> SMatrix<T, N, N> {
    let half = real::<T>(0.5);
    let (mut root, mut inverse_root) = (*matrix, SMatrix::identity());
    // The iteration converges quadratically, after one step for each halving of the angle to the negative axis.
    for _ in 0..30 {
        let next = (root + inverse(&inverse_root)) * half;
        inverse_root = (inverse_root + inverse(&root)) * half;
        let change = (next - root).norm();
        root = next;
        // The next change is the square of this one.
        if change <= T::default_epsilon().sqrt() * root.norm() * real(0.125) {
            break;
        }
    }
    root
}
