//! Component vectors of a Lie algebra and its dual, and the small linear systems of a Newton step.

use core::fmt::Debug;
use core::ops::{Add, Mul, Neg, Sub};

use nalgebra::{SMatrix, SVector, SimdBool as _};

use crate::numbers::blocks::{Blocks, Pattern};
use crate::numbers::columns::FourVectors;
use crate::numbers::elimination::{self, adjugate_2, adjugate_3, eliminate, substitute};
use crate::numbers::entries::Entries;
use crate::numbers::scalar::{Mask, Real, real};

/// Components with respect to the declared basis `E_k` of a Lie algebra, or, for a covector, `μ_k = ⟨μ, E_k⟩`.
#[hot]
pub trait Coordinates<T: Real>:
    Entries<T> + Debug + PartialEq + Add<Output = Self> + Sub<Output = Self> + Neg<Output = Self> + Mul<T, Output = Self>
{
    /// A linear map from components to components.
    type Square: Copy
        + Debug
        + PartialEq
        + Add<Output = Self::Square>
        + Mul<T, Output = Self::Square>
        + Mul<Self, Output = Self>;

    /// The blocks of a matrix that couple neighbours in a row of bodies; `()` for a single body.
    type Links: Copy;

    /// Four vectors side by side.
    type Four: Entries<T> + Debug + PartialEq + Add<Output = Self::Four> + Sub<Output = Self::Four>;

    /// Stores four vectors side by side.
    fn beside(columns: &[Self; 4]) -> Self::Four;

    /// Vector `k` of four.
    ///
    /// # Panics
    ///
    /// If `k` is above three.
    #[must_use]
    fn of_four(four: &Self::Four, k: usize) -> Self;

    /// Four vectors, each mapped by the matrix.
    fn map_four(matrix: &Self::Square, four: &Self::Four) -> Self::Four;

    /// The matrix with these columns, numbered from zero; for several bodies its diagonal blocks.
    fn square(column: impl Fn(usize) -> Self) -> Self::Square;

    /// A column of a matrix, numbered from zero; for several bodies the column of its diagonal block.
    ///
    /// # Panics
    ///
    /// If there is no column `k`.
    #[must_use]
    fn column(matrix: &Self::Square, k: usize) -> Self;

    /// The vector with all components zero.
    fn zero() -> Self;

    /// The vector with component `k` one, and the others zero.
    ///
    /// # Panics
    ///
    /// If there is no component `k`.
    fn axis(k: usize) -> Self;

    /// The pairing `Σ a_k b_k`.
    fn dot(&self, other: &Self) -> T;

    /// The outer product `a bᵀ`: the map `x ↦ a (b·x)`.
    fn outer(&self, other: &Self) -> Self::Square;

    /// Whether all components are finite.
    fn is_finite(&self) -> bool;

    /// Selects by lanes: `self` where the mask is set, and `other` elsewhere.
    #[must_use]
    fn select(self, mask: Mask<T>, other: Self) -> Self;

    /// The factors from which [`solve_again`](Self::solve_again) solves `A z = b`, and `det A`.
    ///
    /// There is no pivoting and no branch, so that SIMD lanes stay together, and so that another unit of length, which
    /// scales rows and columns, changes no digit. If `A` is singular, `z` isn't finite and `det A` is zero or not
    /// finite.
    ///
    /// Up to three dimensions this is Cramer's rule, and the adjugate is returned. Beyond, it is Gaussian elimination
    /// in the order of the basis, and both triangles are returned. That is as accurate as any elimination if the
    /// symmetric part of the matrix is positive definite, like the Jacobian of a kinetic energy near the identity, and
    /// not finite if a leading minor is zero.
    #[must_use]
    fn factorise(matrix: &Self::Square) -> (Self::Square, T) {
        Self::factorise_with(matrix, Pattern::WHOLE)
    }

    /// The solution `z` of `A z = b` from the factors by [`factorise`](Self::factorise).
    #[must_use]
    fn solve_again(factors: &Self::Square, det: T, right_side: &Self) -> Self {
        Self::solve_again_with(factors, det, Pattern::WHOLE, right_side)
    }

    /// The solution `z` of `A z = b`, and `det A`.
    #[must_use]
    fn solve(matrix: &Self::Square, right_side: &Self) -> (Self, T) {
        let (factors, det) = Self::factorise(matrix);
        (Self::solve_again(&factors, det, right_side), det)
    }

    /// The factors and the determinant of a matrix with this pattern, as by [`factorise`](Self::factorise). Independent
    /// blocks are solved separately. For a product of groups `det A` is relative to the product of the diagonal. It is
    /// negative if the determinant of any factor is, once the factors before it are eliminated: two negative ones don't
    /// cancel.
    fn factorise_with(matrix: &Self::Square, pattern: Pattern) -> (Self::Square, T);

    /// The solution from the factors by [`factorise_with`](Self::factorise_with).
    fn solve_again_with(factors: &Self::Square, det: T, pattern: Pattern, right_side: &Self) -> Self;

    /// `A⁻¹` from the factors by [`factorise_with`](Self::factorise_with), for many right-hand sides; its products are
    /// the solutions of [`solve_again_with`](Self::solve_again_with) to rounding. For several bodies it has a block for
    /// each. If `A` is singular, not all entries are finite.
    fn inverse_with(factors: &Self::Square, det: T, pattern: Pattern) -> Self::Square;

    /// The factors as by [`factorise_with`](Self::factorise_with) for a product of groups, also if it has one block:
    /// the determinant is relative to the product of the diagonal.
    fn factorise_apart(matrix: &Self::Square, pattern: Pattern) -> (Self::Square, T);

    /// The solution from the factors by [`factorise_apart`](Self::factorise_apart).
    fn solve_apart(factors: &Self::Square, pattern: Pattern, right_side: &Self) -> Self;

    /// Zero blocks between neighbours.
    fn no_links() -> Self::Links;

    /// Adds blocks beside the diagonal, each multiplied as the residual of its row is where that is [`raised`](Self::raised).
    fn add_links(links: &mut Self::Links, others: &Self::Links, power: u32, half: &Self);

    /// Solves `A z = b` in place, for a matrix with the blocks `links` beside its diagonal: `right_side` becomes `z`, and
    /// the matrix is overwritten. Returns the determinant, as [`factorise_with`](Self::factorise_with) does. Only the factors
    /// of the pattern are used: the links couple unknowns that are independent without them.
    fn solve_linked(matrix: &mut Self::Square, links: &Self::Links, pattern: Pattern, right_side: &mut Self) -> T;

    /// The least of the traces of the diagonal blocks.
    fn least_trace(matrix: &Self::Square, blocks: Blocks) -> T;

    /// `Dᵏ r` and its derivative, for `D = 1 + |y|²` of half the coordinates `y` and a residual `r` with its
    /// derivative; each of several bodies has its own `D`.
    #[must_use]
    fn raised(residual: &Self, jacobian: &Self::Square, power: u32, half: &Self) -> (Self, Self::Square) {
        if power == 0 {
            return (*residual, *jacobian);
        }
        let d = half.dot(half) + real(1.0);
        // d(Dᵏ r) = Dᵏ dr + k Dᵏ⁻¹ r (2y)ᵀ dy.
        let below = (1..power).fold(real::<T>(1.0), |product, _| product * d);
        let slope = residual.outer(half) * (below * real(2.0 * f64::from(power)));
        (*residual * (below * d), *jacobian * (below * d) + slope)
    }

    /// The product `A B` with a `B` of these diagonal blocks.
    #[must_use]
    fn times_blocks(a: &Self::Square, b: &Self::Square, blocks: Blocks) -> Self::Square;

    /// The trace of a square matrix.
    fn trace(matrix: &Self::Square) -> T;

    /// The transpose of a square matrix.
    #[must_use]
    fn transpose(matrix: &Self::Square) -> Self::Square;

    /// The smallest pivot of a symmetric matrix in the order of the basis, relative to its entry of the diagonal, and
    /// its component, from zero. Pivots after the first that isn't positive are ignored. The smallest is above zero if
    /// the matrix is positive definite, below zero if it is negative along a direction, and of the order of rounding,
    /// or NaN, if it is singular. In a batch the component is that of one of the lanes.
    fn least_pivot(matrix: &Self::Square) -> (T, usize);
}

#[hot]
impl<T: Real, const D: usize> Coordinates<T> for SVector<T, D> {
    type Square = SMatrix<T, D, D>;
    type Links = ();
    type Four = FourVectors<T, D>;

    fn beside(columns: &[Self; 4]) -> FourVectors<T, D> {
        FourVectors(core::array::from_fn(|row| core::array::from_fn(|k| columns[k][row])))
    }

    fn of_four(four: &FourVectors<T, D>, k: usize) -> Self {
        entries::<T, D>(|row| four.0[row][k])
    }

    fn map_four(matrix: &SMatrix<T, D, D>, four: &FourVectors<T, D>) -> FourVectors<T, D> {
        four.mapped(matrix)
    }

    fn square(column: impl Fn(usize) -> Self) -> SMatrix<T, D, D> {
        let mut square = SMatrix::<T, D, D>::zeros();
        for k in 0..D {
            let column = column(k);
            for row in 0..D {
                square[(row, k)] = column[row];
            }
        }
        square
    }

    fn column(matrix: &SMatrix<T, D, D>, k: usize) -> Self {
        matrix.column(k).into()
    }

    fn zero() -> Self {
        Self::zeros()
    }

    #[inline]
    fn axis(k: usize) -> Self {
        let mut axis = Self::zeros();
        axis[k] = T::one();
        axis
    }

    fn dot(&self, other: &Self) -> T {
        sum::<T, D>(|k| self[k] * other[k])
    }

    fn outer(&self, other: &Self) -> SMatrix<T, D, D> {
        SMatrix::from_fn(|row, column| self[row] * other[column])
    }

    fn is_finite(&self) -> bool {
        // Zero times an infinity or a NaN is NaN; the plain sum could overflow.
        sum::<T, D>(|k| self[k] * T::zero()).simd_eq(T::zero()).all()
    }

    fn select(self, mask: Mask<T>, other: Self) -> Self {
        self.zip_map(&other, |a, b| a.select(mask, b))
    }

    fn factorise_with(matrix: &SMatrix<T, D, D>, pattern: Pattern) -> (SMatrix<T, D, D>, T) {
        if !pattern.factors.is_whole() {
            return Self::factorise_apart(matrix, pattern);
        }
        // The match is resolved at compile time, as `D` is a constant.
        match D {
            1 => (SMatrix::from_element(T::one()), matrix[(0, 0)]),
            2 => adjugate_2(matrix),
            3 => adjugate_3(matrix),
            _ => eliminate(*matrix),
        }
    }

    fn solve_again_with(factors: &SMatrix<T, D, D>, det: T, pattern: Pattern, b: &Self) -> Self {
        if !pattern.factors.is_whole() {
            return Self::solve_apart(factors, pattern, b);
        }
        match D {
            1 => b / det,
            2 | 3 => {
                let inverse = T::one() / det;
                entries::<T, D>(|i| sum::<T, D>(|k| factors[(i, k)] * b[k]) * inverse)
            }
            _ => substitute(factors, *b),
        }
    }

    fn inverse_with(factors: &SMatrix<T, D, D>, det: T, pattern: Pattern) -> SMatrix<T, D, D> {
        if pattern.factors.is_whole() && D <= 3 {
            // The factors are the adjugate up to three dimensions.
            return factors * (T::one() / det);
        }
        Self::square(|k| Self::solve_again_with(factors, det, pattern, &Self::axis(k)))
    }

    fn factorise_apart(matrix: &SMatrix<T, D, D>, pattern: Pattern) -> (SMatrix<T, D, D>, T) {
        elimination::factorise(matrix, pattern)
    }

    fn solve_apart(factors: &SMatrix<T, D, D>, pattern: Pattern, b: &Self) -> Self {
        elimination::solve_again(factors, pattern, b)
    }

    fn no_links() {}

    fn add_links((): &mut (), (): &(), _: u32, _: &Self) {}

    fn solve_linked(matrix: &mut SMatrix<T, D, D>, (): &(), pattern: Pattern, right_side: &mut Self) -> T {
        let (factors, det) = Self::factorise_with(matrix, pattern);
        *right_side = Self::solve_again_with(&factors, det, pattern, right_side);
        det
    }

    fn least_trace(matrix: &SMatrix<T, D, D>, blocks: Blocks) -> T {
        elimination::least_trace(matrix, blocks)
    }

    fn times_blocks(a: &SMatrix<T, D, D>, b: &SMatrix<T, D, D>, blocks: Blocks) -> SMatrix<T, D, D> {
        let (mut product, mut start) = (SMatrix::<T, D, D>::zeros(), 0);
        while start < D {
            let end = blocks.end(start, D);
            for i in 0..D {
                for j in start..end {
                    let mut sum = a[(i, start)] * b[(start, j)];
                    for k in start + 1..end {
                        sum += a[(i, k)] * b[(k, j)];
                    }
                    product[(i, j)] = sum;
                }
            }
            start = end;
        }
        product
    }

    fn trace(matrix: &SMatrix<T, D, D>) -> T {
        sum::<T, D>(|k| matrix[(k, k)])
    }

    fn transpose(matrix: &SMatrix<T, D, D>) -> SMatrix<T, D, D> {
        matrix.transpose()
    }

    #[inline]
    fn least_pivot(matrix: &SMatrix<T, D, D>) -> (T, usize) {
        let (factors, _) = eliminate(*matrix);
        let relative = |k: usize| (factors[(k, k)] / matrix[(k, k)].simd_abs(), k);
        (1..D).fold(relative(0), |least, k| lesser_pivot(least, relative(k)))
    }
}

/// The lesser of two pivots, each with its component. NaN, the quotient of two zeros, is less than any number. Pivots
/// after one that isn't positive are ignored. The component changes only to that of a pivot that isn't positive, so
/// that in a batch it names a fault.
pub(super) fn lesser_pivot<T: Real>((pivot, place): (T, usize), (next, behind): (T, usize)) -> (T, usize) {
    let is_less = pivot.simd_gt(T::zero()) & !next.simd_ge(pivot);
    let is_fault = is_less & !next.simd_gt(T::zero());
    (next.select(is_less, pivot), if is_fault.any() { behind } else { place })
}

// Loops in lanes: the compiler doesn't always inline `fold` and `from_fn` there, and code that isn't inlined can't use
// the machine's vector instructions. For single bodies loops make a step slower by up to a sixth.

/// The sum `term(0) + term(1) + …`, in that order.
#[hot]
fn sum<T: Real, const D: usize>(term: impl Fn(usize) -> T) -> T {
    if D == 0 {
        return T::zero();
    }
    if T::LANES == 1 {
        return (1..D).fold(term(0), |sum, k| sum + term(k));
    }
    let mut sum = term(0);
    for k in 1..D {
        sum += term(k);
    }
    sum
}

/// The vector of `entry(0), entry(1), …`.
#[hot]
fn entries<T: Real, const D: usize>(entry: impl Fn(usize) -> T) -> SVector<T, D> {
    if T::LANES == 1 {
        return SVector::from_fn(|i, _| entry(i));
    }
    let mut entries = SVector::<T, D>::zeros();
    for i in 0..D {
        entries[i] = entry(i);
    }
    entries
}
