//! Linear systems of a Newton step: by Cramer's rule up to three unknowns, by elimination beyond, and block by block
//! for independent blocks.

use nalgebra::{SMatrix, SVector};

use super::blocks::{Blocks, Pattern};
use super::scalar::{Mask, Real, nowhere};

#[hot]
pub(super) fn adjugate_2<T: Real, const D: usize>(m: &SMatrix<T, D, D>) -> (SMatrix<T, D, D>, T) {
    let det = m[(0, 0)] * m[(1, 1)] - m[(0, 1)] * m[(1, 0)];
    let mut adjugate = SMatrix::zeros();
    adjugate[(0, 0)] = m[(1, 1)];
    adjugate[(0, 1)] = -m[(0, 1)];
    adjugate[(1, 0)] = -m[(1, 0)];
    adjugate[(1, 1)] = m[(0, 0)];
    (adjugate, det)
}

/// The adjugate and the determinant; its rows are cross products of columns.
#[hot]
pub(crate) fn adjugate_3<T: Real, const D: usize>(matrix: &SMatrix<T, D, D>) -> (SMatrix<T, D, D>, T) {
    let m = |row: usize, column: usize| matrix[(row - 1, column - 1)];
    let c11 = m(2, 2) * m(3, 3) - m(2, 3) * m(3, 2);
    let c21 = m(2, 3) * m(3, 1) - m(2, 1) * m(3, 3);
    let c31 = m(2, 1) * m(3, 2) - m(2, 2) * m(3, 1);
    let c12 = m(1, 3) * m(3, 2) - m(1, 2) * m(3, 3);
    let c22 = m(1, 1) * m(3, 3) - m(1, 3) * m(3, 1);
    let c32 = m(1, 2) * m(3, 1) - m(1, 1) * m(3, 2);
    let c13 = m(1, 2) * m(2, 3) - m(1, 3) * m(2, 2);
    let c23 = m(1, 3) * m(2, 1) - m(1, 1) * m(2, 3);
    let c33 = m(1, 1) * m(2, 2) - m(1, 2) * m(2, 1);
    // Expansion along the first column gives the shorter code.
    let det = m(1, 1) * c11 + m(2, 1) * c12 + m(3, 1) * c13;
    let rows = [[c11, c12, c13], [c21, c22, c23], [c31, c32, c33]];
    (SMatrix::from_fn(|i, j| rows[i][j]), det)
}

/// Gaussian elimination without pivoting: returns the upper triangle, and below it the factors of the rows.
///
/// A zero pivot makes its component of a solution infinite or NaN, so that nothing needs a test.
#[inline]
pub(super) fn eliminate<T: Real, const D: usize>(mut a: SMatrix<T, D, D>) -> (SMatrix<T, D, D>, T) {
    let mut det = T::one();
    for k in 0..D {
        det *= a[(k, k)];
        for i in k + 1..D {
            let factor = a[(i, k)] / a[(k, k)];
            a[(i, k)] = factor;
            for j in k + 1..D {
                let product = factor * a[(k, j)];
                a[(i, j)] -= product;
            }
        }
    }
    (a, det)
}

/// Forward and back substitution with both triangles of [`eliminate`].
#[inline]
pub(super) fn substitute<T: Real, const D: usize>(a: &SMatrix<T, D, D>, mut z: SVector<T, D>) -> SVector<T, D> {
    for k in 0..D {
        for i in k + 1..D {
            let product = a[(i, k)] * z[k];
            z[i] -= product;
        }
    }
    for k in (0..D).rev() {
        for j in k + 1..D {
            let product = a[(k, j)] * z[j];
            z[k] -= product;
        }
        z[k] /= a[(k, k)];
    }
    z
}

/// A product of the determinants of blocks, each relative to the product of its diagonal entries, so that the units of
/// many unknowns don't accumulate; negative if any factor is.
struct Product<T: Real> {
    value: T,
    is_negative: Mask<T>,
}

#[hot]
impl<T: Real> Product<T> {
    fn one() -> Self {
        Self { value: T::one(), is_negative: nowhere::<T>() }
    }

    fn times(&mut self, determinant: T, diagonal: T) {
        self.value *= determinant / diagonal.simd_abs();
        self.is_negative = self.is_negative | determinant.simd_lt(T::zero());
    }

    fn signed(self) -> T {
        (-self.value.simd_abs()).select(self.is_negative, self.value)
    }
}

/// [`Coordinates::factorise_with`](super::Coordinates::factorise_with) for dense matrices.
#[hot]
pub(super) fn factorise<T: Real, const D: usize>(matrix: &SMatrix<T, D, D>, pattern: Pattern) -> (SMatrix<T, D, D>, T) {
    let (mut factors, mut product) = (*matrix, Product::one());
    let mut start = 0;
    while start < D {
        let end = pattern.apart.end(start, D);
        match end - start {
            _ if !pattern.factors.are_one(start, end) => {
                eliminate_block(&mut factors, start..end, pattern.factors, &mut product);
            }
            1 => {
                product.times(matrix[(start, start)], matrix[(start, start)]);
                factors[(start, start)] = T::one() / matrix[(start, start)];
            }
            2 => invert(&mut factors, start, &mut product, adjugate_2::<T, 2>),
            3 => invert(&mut factors, start, &mut product, adjugate_3::<T, 3>),
            _ => eliminate_block(&mut factors, start..end, pattern.factors, &mut product),
        }
        start = end;
    }
    (factors, product.signed())
}

/// Replaces a block of at most three unknowns by its inverse.
#[hot]
fn invert<T: Real, const D: usize, const B: usize>(
    matrix: &mut SMatrix<T, D, D>,
    start: usize,
    product: &mut Product<T>,
    adjugate: impl Fn(&SMatrix<T, B, B>) -> (SMatrix<T, B, B>, T),
) {
    let mut block = SMatrix::<T, B, B>::zeros();
    let mut diagonal = T::one();
    for i in 0..B {
        diagonal *= matrix[(start + i, start + i)];
        for j in 0..B {
            block[(i, j)] = matrix[(start + i, start + j)];
        }
    }
    let (adjugate, det) = adjugate(&block);
    product.times(det, diagonal);
    let inverse = T::one() / det;
    for i in 0..B {
        for j in 0..B {
            matrix[(start + i, start + j)] = adjugate[(i, j)] * inverse;
        }
    }
}

/// Gaussian elimination of a block in the order of the basis. The product of the pivots of a factor is the determinant
/// of its block once the factors before it are eliminated.
#[hot]
fn eliminate_block<T: Real, const D: usize>(
    a: &mut SMatrix<T, D, D>,
    block: core::ops::Range<usize>,
    factors: Blocks,
    product: &mut Product<T>,
) {
    let (start, end) = (block.start, block.end);
    let (mut det, mut diagonal) = (T::one(), T::one());
    let original = *a;
    for k in start..end {
        det *= a[(k, k)];
        diagonal *= original[(k, k)];
        if k + 1 == end || factors.end_at(k + 1) {
            product.times(det, diagonal);
            (det, diagonal) = (T::one(), T::one());
        }
        let inverse = T::one() / a[(k, k)];
        for i in k + 1..end {
            let factor = a[(i, k)] * inverse;
            a[(i, k)] = factor;
            for j in k + 1..end {
                let change = factor * a[(k, j)];
                a[(i, j)] -= change;
            }
        }
        // A zero pivot leaves an infinity here, so that no solution is finite.
        a[(k, k)] = inverse;
    }
}

/// [`Coordinates::solve_again_with`](super::Coordinates::solve_again_with) for dense matrices.
#[hot]
pub(super) fn solve_again<T: Real, const D: usize>(
    factors: &SMatrix<T, D, D>,
    pattern: Pattern,
    right_side: &SVector<T, D>,
) -> SVector<T, D> {
    let mut z = *right_side;
    let mut start = 0;
    while start < D {
        let end = pattern.apart.end(start, D);
        if end - start <= 3 && pattern.factors.are_one(start, end) {
            for i in start..end {
                let mut sum = factors[(i, start)] * right_side[start];
                for j in start + 1..end {
                    sum += factors[(i, j)] * right_side[j];
                }
                z[i] = sum;
            }
        } else {
            for k in start..end {
                for i in k + 1..end {
                    let change = factors[(i, k)] * z[k];
                    z[i] -= change;
                }
            }
            for k in (start..end).rev() {
                for j in k + 1..end {
                    let change = factors[(k, j)] * z[j];
                    z[k] -= change;
                }
                z[k] *= factors[(k, k)];
            }
        }
        start = end;
    }
    z
}

/// The least of the traces of the diagonal blocks.
pub(super) fn least_trace<T: Real, const D: usize>(matrix: &SMatrix<T, D, D>, blocks: Blocks) -> T {
    let (mut least, mut start) = (None, 0);
    while start < D {
        let end = blocks.end(start, D);
        let trace = (start + 1..end).fold(matrix[(start, start)], |sum, k| sum + matrix[(k, k)]);
        // A NaN is returned.
        least = Some(least.map_or(trace, |least: T| trace.select(trace.simd_lt(least) | trace.simd_ne(trace), least)));
        start = end;
    }
    least.unwrap_or_else(T::zero)
}

#[cfg(test)]
mod tests {
    use super::{Blocks, Pattern};
    use crate::numbers::Coordinates as _;
    use nalgebra::{SMatrix, Vector2, Vector6};

    /// Factors of 3 + 1 + 2 unknowns.
    const FACTORS: Blocks = Blocks::WHOLE.then(3, Blocks::WHOLE.then(1, Blocks::WHOLE));

    fn matrix(pattern: Pattern) -> SMatrix<f64, 6, 6> {
        let block = |k: usize| (1..=k).filter(|&end| pattern.apart.end_at(end)).count();
        SMatrix::from_fn(|i, j| {
            let mixed = f64::from(u8::try_from(7 * i + 3 * j).unwrap()).sin();
            if block(i) == block(j) { mixed + if i == j { 3.0 } else { 0.0 } } else { 0.0 }
        })
    }

    #[test]
    fn what_is_apart_is_solved_apart_and_the_whole_as_by_pivots() {
        assert_eq!(FACTORS, Blocks::WHOLE.then(3, Blocks::WHOLE).then(4, Blocks::WHOLE));
        let pairs = Blocks::WHOLE.then(4, Blocks::WHOLE);
        for apart in [FACTORS, pairs, Blocks::WHOLE, FACTORS.or(pairs)] {
            let pattern = Pattern { factors: FACTORS, apart };
            let (a, b) = (matrix(pattern), Vector6::new(1.0, -2.0, 0.5, 3.0, 0.25, -1.0));
            let (factors, det) = Vector6::factorise_with(&a, pattern);
            let z = Vector6::solve_again_with(&factors, det, pattern, &b);
            assert!((a * z - b).norm() < 1e-13, "{apart:?}: {z}");
            let relative = a.determinant() / a.diagonal().product().abs();
            assert!((det - relative).abs() < 1e-12 * det.abs());
        }
    }

    /// Two factors with negative determinants don't cancel to a positive one.
    #[test]
    fn a_block_with_a_negative_determinant_shows() {
        let diagonal = Vector6::<f64>::new(1.0, 2.0, -1.0, -3.0, 1.0, 2.0);
        let a = SMatrix::from_diagonal(&diagonal);
        for apart in [FACTORS, Blocks::WHOLE] {
            let (_, det) = Vector6::factorise_with(&a, Pattern { factors: FACTORS, apart });
            assert!((det + 1.0).abs() < 1e-15, "{det}");
        }
        let whole = Pattern { factors: Blocks::WHOLE, apart: Blocks::WHOLE };
        assert!((Vector6::factorise_with(&a, whole).1 - 12.0).abs() < 1e-12);
        assert!((Vector6::least_trace(&a, FACTORS) + 3.0).abs() < 1e-12);
        let mut broken: SMatrix<f64, 6, 6> = a;
        broken[(0, 0)] = f64::NAN;
        assert!(Vector6::least_trace(&broken, FACTORS).is_nan());
        // Up to three unknowns, too.
        let two = Pattern { factors: Blocks::WHOLE.then(1, Blocks::WHOLE), apart: Blocks::WHOLE };
        let (_, det) = Vector2::<f64>::factorise_with(&nalgebra::Matrix2::new(-1.0, 0.0, 0.0, -2.0), two);
        assert!((det + 1.0).abs() < 1e-15);
    }

    #[test]
    fn a_singular_matrix_has_no_finite_solution() {
        for apart in [FACTORS, Blocks::WHOLE] {
            let pattern = Pattern { factors: FACTORS, apart };
            let mut a = matrix(pattern);
            for j in 0..6 {
                a[(3, j)] = 0.0;
            }
            let (factors, det) = Vector6::factorise_with(&a, pattern);
            let z = Vector6::solve_again_with(&factors, det, pattern, &Vector6::repeat(1.0));
            assert!(!crate::numbers::Coordinates::is_finite(&z) && (det == 0.0 || !det.is_finite()), "{det} {z}");
        }
    }
}
