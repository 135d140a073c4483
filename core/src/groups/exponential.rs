//! The exponential of a matrix, what its derivative is made of, and the logarithm.

use nalgebra::{RealField, SMatrix};

use super::generators::inverse;
use crate::numbers::real;

/// Beyond `2⁶⁴` a matrix is scaled no further; its exponential overflows or means nothing.
const MAX_HALVINGS: u32 = 64;

/// `(e^X − I, Σ X^k/(k + 1)!)`, neither formed by a subtraction of `I`.
///
/// The series are summed for `X` of a norm up to ½ and doubled by `e^{2X} − I = 2D + D²`, and with
/// `P(X) = X⁻¹(e^X − I)` by `P(2X) = ½ (e^X + I) P(X) = P + ½ D P`.
pub(crate) fn exponential<T: RealField + Copy, const N: usize>(
    x: &SMatrix<T, N, N>,
) -> (SMatrix<T, N, N>, SMatrix<T, N, N>) {
    let half = real::<T>(0.5);
    let (mut scaled, mut halvings) = (*x, 0);
    while scaled.norm() > half && halvings < MAX_HALVINGS {
        scaled *= half;
        halvings += 1;
    }
    // `½¹⁵/16!` is below half a rounding of one.
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

/// `log(I + D)`, or what isn't one where the principal logarithm doesn't exist.
///
/// Square roots bring `D` down to a norm of ¼; then `log F = 2 artanh Z` with `Z = (F + I)⁻¹ (F − I)`.
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
    // `‖Z‖ ≤ 1/7`: `7⁻²⁰/21` is below half a rounding of one.
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
    // It converges quadratically, after one iteration for each halving of the angle to the negative axis.
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
