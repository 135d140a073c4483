//! Component vectors of a Lie algebra and its dual, and the small linear systems of a Newton step.

use core::fmt::Debug;
use core::ops::{Add, Mul, Neg, Sub};

use nalgebra::{SMatrix, SVector};

use crate::entries::Entries;
use crate::scalar::{Mask, Real};

/// Components with respect to the declared basis `E_k` of a Lie algebra, or, for a covector, `μ_k = ⟨μ, E_k⟩`.
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

    /// All components zero.
    fn zero() -> Self;

    /// Component `k` one, the others zero.
    ///
    /// # Panics
    ///
    /// Where there is no component `k`.
    fn axis(k: usize) -> Self;

    /// The pairing `Σ a_k b_k`.
    fn dot(&self, other: &Self) -> T;

    /// `a bᵀ`: the map `x ↦ a (b·x)`.
    fn outer(&self, other: &Self) -> Self::Square;

    /// Whether all components are finite.
    fn is_finite(&self) -> bool;

    /// In each lane `self` where the mask is set, and `other` where it isn't.
    #[must_use]
    fn select(self, mask: Mask<T>, other: Self) -> Self;

    /// The solution `z` of `A z = b`, and `det A`.
    ///
    /// There is no pivoting and no branch, so that SIMD lanes stay together, and so that another unit of length, which
    /// scales rows and columns, changes no digit. Where `A` is singular, `z` isn't finite and `det A` is zero or not
    /// finite.
    ///
    /// Up to three dimensions this is Cramer's rule. Beyond, it is elimination in the order of the basis: as accurate
    /// as any for a matrix whose symmetric part is positive definite, like the Jacobian of a kinetic energy near the
    /// identity, and not finite where a leading minor is zero.
    fn solve(matrix: &Self::Square, right_side: &Self) -> (Self, T);

    /// The trace of a square matrix.
    fn trace(matrix: &Self::Square) -> T;
}

impl<T: Real, const D: usize> Coordinates<T> for SVector<T, D> {
    type Square = SMatrix<T, D, D>;

    #[inline(always)]
    fn zero() -> Self {
        Self::zeros()
    }

    fn axis(k: usize) -> Self {
        let mut axis = Self::zeros();
        axis[k] = T::one();
        axis
    }

    #[inline(always)]
    fn dot(&self, other: &Self) -> T {
        sum::<T, D>(|k| self[k] * other[k])
    }

    #[inline(always)]
    fn outer(&self, other: &Self) -> SMatrix<T, D, D> {
        SMatrix::from_fn(|row, column| self[row] * other[column])
    }

    #[inline(always)]
    fn is_finite(&self) -> bool {
        // A finite sum has finite terms. Where it isn't, it may have overflowed.
        crate::scalar::is_finite(sum::<T, D>(|k| self[k])) || are_all_finite(self)
    }

    #[inline(always)]
    fn select(self, mask: Mask<T>, other: Self) -> Self {
        self.zip_map(&other, |a, b| a.select(mask, b))
    }

    #[inline(always)]
    fn solve(matrix: &SMatrix<T, D, D>, b: &Self) -> (Self, T) {
        // `D` is a constant, so that one of these is left.
        match D {
            1 => (b / matrix[(0, 0)], matrix[(0, 0)]),
            2 => cramer_2(matrix, b),
            3 => cramer_3(matrix, b),
            _ => eliminate(*matrix, *b),
        }
    }

    #[inline(always)]
    fn trace(matrix: &SMatrix<T, D, D>) -> T {
        sum::<T, D>(|k| matrix[(k, k)])
    }
}

/// `term(0) + term(1) + …`, in that order.
#[inline(always)]
fn sum<T: Real, const D: usize>(term: impl Fn(usize) -> T) -> T {
    if D == 0 { T::zero() } else { (1..D).fold(term(0), |sum, k| sum + term(k)) }
}

#[inline(always)]
fn cramer_2<T: Real, const D: usize>(m: &SMatrix<T, D, D>, b: &SVector<T, D>) -> (SVector<T, D>, T) {
    let det = m[(0, 0)] * m[(1, 1)] - m[(0, 1)] * m[(1, 0)];
    let inverse = T::one() / det;
    let mut z = SVector::zeros();
    z[0] = (m[(1, 1)] * b[0] - m[(0, 1)] * b[1]) * inverse;
    z[1] = (m[(0, 0)] * b[1] - m[(1, 0)] * b[0]) * inverse;
    (z, det)
}

/// Cramer's rule by cross products of the rows.
#[inline(always)]
fn cramer_3<T: Real, const D: usize>(matrix: &SMatrix<T, D, D>, b: &SVector<T, D>) -> (SVector<T, D>, T) {
    let m = |row: usize, column: usize| matrix[(row - 1, column - 1)];
    // Rows of the adjugate: cofactors of the columns.
    let c11 = m(2, 2) * m(3, 3) - m(2, 3) * m(3, 2);
    let c21 = m(2, 3) * m(3, 1) - m(2, 1) * m(3, 3);
    let c31 = m(2, 1) * m(3, 2) - m(2, 2) * m(3, 1);
    let c12 = m(1, 3) * m(3, 2) - m(1, 2) * m(3, 3);
    let c22 = m(1, 1) * m(3, 3) - m(1, 3) * m(3, 1);
    let c32 = m(1, 2) * m(3, 1) - m(1, 1) * m(3, 2);
    let c13 = m(1, 2) * m(2, 3) - m(1, 3) * m(2, 2);
    let c23 = m(1, 3) * m(2, 1) - m(1, 1) * m(2, 3);
    let c33 = m(1, 1) * m(2, 2) - m(1, 2) * m(2, 1);
    let det = m(1, 1) * c11 + m(1, 2) * c21 + m(1, 3) * c31;
    let inverse = T::one() / det;
    let mut z = SVector::zeros();
    z[0] = (c11 * b[0] + c12 * b[1] + c13 * b[2]) * inverse;
    z[1] = (c21 * b[0] + c22 * b[1] + c23 * b[2]) * inverse;
    z[2] = (c31 * b[0] + c32 * b[1] + c33 * b[2]) * inverse;
    (z, det)
}

/// Gaussian elimination in the given order.
///
/// A zero pivot divides its own component, which then can't be finite; nothing has to be tested.
#[inline]
fn eliminate<T: Real, const D: usize>(mut a: SMatrix<T, D, D>, mut z: SVector<T, D>) -> (SVector<T, D>, T) {
    let mut det = T::one();
    for k in 0..D {
        det *= a[(k, k)];
        for i in k + 1..D {
            let factor = a[(i, k)] / a[(k, k)];
            for j in k + 1..D {
                let product = factor * a[(k, j)];
                a[(i, j)] -= product;
            }
            let product = factor * z[k];
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
    (z, det)
}

/// Zero times an infinity or a NaN is NaN.
#[cold]
fn are_all_finite<T: Real, const D: usize>(v: &SVector<T, D>) -> bool {
    v.iter().all(|&component| crate::scalar::is_finite(component))
}
