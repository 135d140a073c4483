//! Component vectors of a Lie algebra and its dual, and the small linear systems of a Newton step.

use core::fmt::Debug;
use core::ops::{Add, Mul, Neg, Sub};

use nalgebra::{Matrix3, SimdBool as _, Vector3};

use crate::scalar::Real;

/// Components with respect to the declared basis `E_k` of a Lie algebra, or, for a covector, `μ_k = ⟨μ, E_k⟩`.
pub trait Coordinates<T: Real>:
    Copy + Debug + PartialEq + Add<Output = Self> + Sub<Output = Self> + Neg<Output = Self> + Mul<T, Output = Self>
{
    /// A linear map from components to components.
    type Square: Copy + Debug + PartialEq + Mul<Self, Output = Self>;

    /// All components zero.
    fn zero() -> Self;

    /// The pairing `Σ a_k b_k`.
    fn dot(&self, other: &Self) -> T;

    /// Whether all components are finite.
    fn is_finite(&self) -> bool;

    /// The solution `z` of `A z = b`, and `det A`.
    ///
    /// There is no pivoting and no branch, so that SIMD lanes stay together: where `det A` is zero, `z` isn't finite.
    fn solve(matrix: &Self::Square, right_side: &Self) -> (Self, T);

    /// The trace of a square matrix.
    fn trace(matrix: &Self::Square) -> T;
}

impl<T: Real> Coordinates<T> for Vector3<T> {
    type Square = Matrix3<T>;

    #[inline(always)]
    fn zero() -> Self {
        Self::zeros()
    }

    #[inline(always)]
    fn dot(&self, other: &Self) -> T {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    #[inline(always)]
    fn is_finite(&self) -> bool {
        // Zero times an infinity or a NaN is NaN; the sum itself could overflow.
        (self.x * T::zero() + self.y * T::zero() + self.z * T::zero()).simd_eq(T::zero()).all()
    }

    /// Cramer's rule by cross products of the rows.
    #[inline(always)]
    fn solve(matrix: &Matrix3<T>, b: &Self) -> (Self, T) {
        let m = matrix;
        // Rows of the adjugate: cofactors of the columns.
        let c11 = m.m22 * m.m33 - m.m23 * m.m32;
        let c21 = m.m23 * m.m31 - m.m21 * m.m33;
        let c31 = m.m21 * m.m32 - m.m22 * m.m31;
        let c12 = m.m13 * m.m32 - m.m12 * m.m33;
        let c22 = m.m11 * m.m33 - m.m13 * m.m31;
        let c32 = m.m12 * m.m31 - m.m11 * m.m32;
        let c13 = m.m12 * m.m23 - m.m13 * m.m22;
        let c23 = m.m13 * m.m21 - m.m11 * m.m23;
        let c33 = m.m11 * m.m22 - m.m12 * m.m21;
        let det = m.m11 * c11 + m.m12 * c21 + m.m13 * c31;
        let inverse = T::one() / det;
        let z = Self::new(
            (c11 * b.x + c12 * b.y + c13 * b.z) * inverse,
            (c21 * b.x + c22 * b.y + c23 * b.z) * inverse,
            (c31 * b.x + c32 * b.y + c33 * b.z) * inverse,
        );
        (z, det)
    }

    #[inline(always)]
    fn trace(matrix: &Matrix3<T>) -> T {
        matrix.m11 + matrix.m22 + matrix.m33
    }
}
