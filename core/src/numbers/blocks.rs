//! Matrices of several bodies: blocks on the diagonal that belong to one body each, and whether there is anything between
//! them.

use nalgebra::{Const, DimAdd, SMatrix, SVector};

use super::coordinates::{Coordinates, adjugate_2, adjugate_3};
use super::scalar::{Mask, Real, nowhere};

/// Where the blocks on the diagonal of a matrix end: the unknowns of a body are in one block. Of at most
/// [`MOST`](Self::MOST) unknowns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Blocks(u64);

impl Blocks {
    /// As many unknowns as may be in several blocks. A product of groups with more doesn't compile.
    pub const MOST: usize = 64;

    /// One block.
    pub const WHOLE: Self = Self(0);

    /// Blocks of `size` unknowns, and behind them others.
    #[must_use]
    pub const fn then(self, size: usize, behind: Self) -> Self {
        Self(self.0 | 1 << size | behind.0 << size)
    }

    /// The finest blocks that have no end within a block of either: those of a sum of two matrices.
    #[must_use]
    pub const fn or(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    /// Whether there is one block.
    #[must_use]
    pub const fn is_whole(self) -> bool {
        self.0 == 0
    }

    /// Whether a block ends before the unknown `k`.
    #[must_use]
    pub const fn end_at(self, k: usize) -> bool {
        self.0 >> k & 1 == 1
    }

    /// Whether the unknowns from `start` to `end` are in one block.
    const fn are_one(self, start: usize, end: usize) -> bool {
        self.end(start, end) == end
    }

    /// Where the block that begins with the unknown `start` ends, of `dimension` in all.
    const fn end(self, start: usize, dimension: usize) -> usize {
        let mut end = start + 1;
        while end < dimension && !self.end_at(end) {
            end += 1;
        }
        end
    }
}

/// Components side by side: those of a product of groups are those of its factors, one after the other.
#[doc(hidden)]
pub trait Join<T: Real, Other: Coordinates<T>>: Coordinates<T> {
    /// Both.
    type Joined: Coordinates<T> + 'static;

    /// One after the other.
    #[must_use]
    fn join(&self, other: &Other) -> Self::Joined;

    /// Taken apart.
    #[must_use]
    fn split(joined: &Self::Joined) -> (Self, Other);

    /// The map that maps each by itself.
    #[must_use]
    fn join_squares(first: &Self::Square, second: &Other::Square) -> <Self::Joined as Coordinates<T>>::Square;
}

impl<T: Real, const A: usize, const B: usize, const C: usize> Join<T, SVector<T, B>> for SVector<T, A>
where
    Const<A>: DimAdd<Const<B>, Output = Const<C>>,
{
    type Joined = SVector<T, C>;

    #[hot]
    fn join(&self, other: &SVector<T, B>) -> SVector<T, C> {
        let mut joined = SVector::<T, C>::zeros();
        for k in 0..A {
            joined[k] = self[k];
        }
        for k in 0..B {
            joined[A + k] = other[k];
        }
        joined
    }

    #[hot]
    fn split(joined: &SVector<T, C>) -> (Self, SVector<T, B>) {
        let (mut first, mut second) = (Self::zeros(), SVector::<T, B>::zeros());
        for k in 0..A {
            first[k] = joined[k];
        }
        for k in 0..B {
            second[k] = joined[A + k];
        }
        (first, second)
    }

    fn join_squares(first: &SMatrix<T, A, A>, second: &SMatrix<T, B, B>) -> SMatrix<T, C, C> {
        SMatrix::from_fn(|i, j| match (i < A, j < A) {
            (true, true) => first[(i, j)],
            (false, false) => second[(i - A, j - A)],
            _ => T::zero(),
        })
    }
}

/// Components of which those of two equal bodies are put side by side.
pub trait Twice<T: Real>: Join<T, Self> {
    /// The blocks of a matrix of both, row by row.
    #[must_use]
    fn blocks(joined: &<Self::Joined as Coordinates<T>>::Square) -> [[Self::Square; 2]; 2];
}

impl<T: Real, const A: usize, const C: usize> Twice<T> for SVector<T, A>
where
    Const<A>: DimAdd<Const<A>, Output = Const<C>>,
{
    #[hot]
    fn blocks(joined: &SMatrix<T, C, C>) -> [[SMatrix<T, A, A>; 2]; 2] {
        let block = |row: usize, column: usize| joined.fixed_view::<A, A>(row, column).into_owned();
        [[block(0, 0), block(0, A)], [block(A, 0), block(A, A)]]
    }
}

/// What is known of a Newton matrix before it is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pattern {
    /// The unknowns of each factor of the group.
    pub factors: Blocks,
    /// The unknowns that solve together; between these blocks the matrix is zero. They end where factors end.
    pub apart: Blocks,
}

/// The product of the determinants of blocks, each relative to the product of the diagonal entries, so that the units of
/// many unknowns don't multiply; negative where one of them is.
struct Product<T: Real> {
    value: T,
    is_negative: Mask<T>,
}

impl<T: Real> Product<T> {
    fn one() -> Self {
        Self { value: T::one(), is_negative: nowhere::<T>() }
    }

    #[hot]
    fn times(&mut self, determinant: T, diagonal: T) {
        self.value *= determinant / diagonal.simd_abs();
        self.is_negative = self.is_negative | determinant.simd_lt(T::zero());
    }

    #[hot]
    fn signed(self) -> T {
        (-self.value.simd_abs()).select(self.is_negative, self.value)
    }
}

/// [`Coordinates::factorise_with`] for matrices of numbers.
#[hot]
pub(super) fn factorise<T: Real, const D: usize>(matrix: &SMatrix<T, D, D>, pattern: Pattern) -> (SMatrix<T, D, D>, T) {
    let (mut factors, mut product) = (*matrix, Product::one());
    let mut start = 0;
    while start < D {
        let end = pattern.apart.end(start, D);
        match end - start {
            _ if !pattern.factors.are_one(start, end) => {
                eliminate(&mut factors, start..end, pattern.factors, &mut product);
            }
            1 => {
                product.times(matrix[(start, start)], matrix[(start, start)]);
                factors[(start, start)] = T::one() / matrix[(start, start)];
            }
            2 => invert(&mut factors, start, &mut product, adjugate_2::<T, 2>),
            3 => invert(&mut factors, start, &mut product, adjugate_3::<T, 3>),
            _ => eliminate(&mut factors, start..end, pattern.factors, &mut product),
        }
        start = end;
    }
    (factors, product.signed())
}

/// Puts the inverse of a block of at most three unknowns in its place.
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

/// Gaussian elimination of a block in the order of the basis; its pivots between two ends of factors, multiplied, are the
/// determinant of a factor's block once those before are eliminated.
#[hot]
fn eliminate<T: Real, const D: usize>(
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
        // A zero pivot leaves an infinity here, and no solution is finite.
        a[(k, k)] = inverse;
    }
}

/// [`Coordinates::solve_again_with`] for matrices of numbers.
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

/// The least of the traces of the blocks.
pub(super) fn least_trace<T: Real, const D: usize>(matrix: &SMatrix<T, D, D>, blocks: Blocks) -> T {
    let (mut least, mut start) = (None, 0);
    while start < D {
        let end = blocks.end(start, D);
        let trace = (start + 1..end).fold(matrix[(start, start)], |sum, k| sum + matrix[(k, k)]);
        // What isn't a number stays.
        least = Some(least.map_or(trace, |least: T| trace.select(trace.simd_lt(least) | trace.simd_ne(trace), least)));
        start = end;
    }
    least.unwrap_or_else(T::zero)
}

#[cfg(test)]
mod tests {
    use super::{Blocks, Join as _, Pattern};
    use crate::numbers::Coordinates as _;
    use nalgebra::{Matrix3, SMatrix, SVector, Vector1, Vector2, Vector3, Vector6};

    /// 3 + 1 + 2 unknowns.
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

    /// Two of them make a positive determinant.
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

    #[test]
    fn components_are_joined_and_taken_apart() {
        let (a, b) = (Vector3::new(1.0, 2.0, 3.0), Vector1::new(4.0));
        let joined: SVector<f64, 4> = a.join(&b);
        assert_eq!(joined.as_slice(), [1.0, 2.0, 3.0, 4.0]);
        assert_eq!(Vector3::split(&joined), (a, b));
        let squares: SMatrix<f64, 4, 4> = <Vector3<f64> as super::Join<f64, Vector1<f64>>>::join_squares(
            &(Matrix3::identity() * 2.0),
            &SMatrix::from_element(5.0),
        );
        assert_eq!(squares * joined, SVector::from([2.0, 4.0, 6.0, 20.0]));
    }
}
