//! Matrices whose last rows are those of the identity, and their differences from `I`, whose last rows are zero.
//!
//! Products with these zeros and ones are left out, in the order of operations of nalgebra: the results have the same bits.

use nalgebra::SMatrix;

use crate::numbers::Real;
use crate::numbers::elimination::adjugate_3;

/// The product `A B` for a `B` whose rows from `rows` on are zero, and an `A` whose rows there are those of the identity.
#[hot]
pub(super) fn times<T: Real, const N: usize, const M: usize>(
    a: &SMatrix<T, N, N>,
    b: &SMatrix<T, N, M>,
    rows: usize,
) -> SMatrix<T, N, M> {
    let mut product = SMatrix::zeros();
    for i in 0..rows.min(N) {
        for j in 0..M {
            let mut sum = a[(i, 0)] * b[(0, j)];
            for k in 1..rows.min(N) {
                sum += a[(i, k)] * b[(k, j)];
            }
            product[(i, j)] = sum;
        }
    }
    product
}

/// The first rows of the product `Aᵀ B` for an `A` whose rows from `rows` on are zero.
#[hot]
pub(super) fn transpose_times<T: Real, const N: usize, const M: usize>(
    a: &SMatrix<T, N, N>,
    b: &SMatrix<T, N, M>,
    rows: usize,
) -> SMatrix<T, N, M> {
    let mut product = SMatrix::zeros();
    for i in 0..rows {
        for j in 0..M {
            let mut sum = a[(0, i)] * b[(0, j)];
            for k in 1..rows {
                sum += a[(k, i)] * b[(k, j)];
            }
            product[(i, j)] = sum;
        }
    }
    product
}

/// The first rows of the product `A Bᵀ` for a `B` whose rows from `rows` on are zero.
#[hot]
pub(super) fn times_transpose<T: Real, const N: usize>(
    a: &SMatrix<T, N, N>,
    b: &SMatrix<T, N, N>,
    rows: usize,
) -> SMatrix<T, N, N> {
    let mut product = SMatrix::zeros();
    for i in 0..rows {
        for j in 0..rows {
            let mut sum = a[(i, 0)] * b[(j, 0)];
            for k in 1..N {
                sum += a[(i, k)] * b[(j, k)];
            }
            product[(i, j)] = sum;
        }
    }
    product
}

/// The inverse of three rows, of which the last is that of the identity.
#[hot]
pub(super) fn inverse_of_three<T: Real, const N: usize>(m: &SMatrix<T, N, N>) -> SMatrix<T, N, N> {
    let m = |row: usize, column: usize| m[(row - 1, column - 1)];
    let det = m(1, 1) * m(2, 2) - m(1, 2) * m(2, 1);
    let mut inverse = SMatrix::identity();
    inverse[(0, 0)] = m(2, 2) / det;
    inverse[(0, 1)] = -m(1, 2) / det;
    inverse[(0, 2)] = (m(1, 2) * m(2, 3) - m(2, 2) * m(1, 3)) / det;
    inverse[(1, 0)] = -m(2, 1) / det;
    inverse[(1, 1)] = m(1, 1) / det;
    inverse[(1, 2)] = (m(1, 3) * m(2, 1) - m(2, 3) * m(1, 1)) / det;
    inverse
}

/// The inverse of four rows, of which the last is that of the identity.
#[hot]
pub(super) fn inverse_of_four<T: Real, const N: usize>(m: &SMatrix<T, N, N>) -> SMatrix<T, N, N> {
    let (adjugate, det) = adjugate_3(&SMatrix::<T, 3, 3>::from_fn(|i, j| m[(i, j)]));
    let factor = T::one() / det;
    let mut inverse = SMatrix::identity();
    for i in 0..3 {
        for j in 0..3 {
            inverse[(i, j)] = adjugate[(i, j)] * factor;
        }
        let (p, q) = [(1, 2), (0, 2), (0, 1)][i];
        let cofactor = m[(0, p)] * m[(2, q)] * m[(1, 3)] - m[(0, p)] * m[(1, q)] * m[(2, 3)]
            + m[(0, q)] * m[(1, p)] * m[(2, 3)]
            - m[(0, q)] * m[(2, p)] * m[(1, 3)]
            - m[(0, 3)] * m[(1, p)] * m[(2, q)]
            + m[(0, 3)] * m[(2, p)] * m[(1, q)];
        inverse[(i, 3)] = if i == 1 { -cofactor } else { cofactor } * factor;
    }
    // One to rounding, as `det` is summed in another order.
    let by_last =
        m[(0, 0)] * m[(1, 1)] * m[(2, 2)] - m[(0, 0)] * m[(2, 1)] * m[(1, 2)] - m[(0, 1)] * m[(1, 0)] * m[(2, 2)]
            + m[(0, 1)] * m[(2, 0)] * m[(1, 2)]
            + m[(0, 2)] * m[(1, 0)] * m[(2, 1)]
            - m[(0, 2)] * m[(2, 0)] * m[(1, 1)];
    inverse[(3, 3)] = by_last * factor;
    inverse
}
