//! The rotations of space.

use alloc::vec;
use alloc::vec::Vec;

use nalgebra::{Matrix3, Quaternion, RealField, Rotation3, SimdBool as _, UnitQuaternion, Vector3};
use thiserror::Error;

use super::LieGroup;
use super::layout::{Factor, FactorKind};
use super::rotation_functions::{quaternion, rotation_exp, rotation_log, skew_components};
use crate::numbers::{Mask, Real, real};

/// The rotation group SO(3): `F Fᵀ = I`, `det F = 1`.
///
/// Tangent space: `ξ̂ v = ξ × v`, basis `E_k = ê_k`; `ad_ξ η = ξ × η`. Covector components are those of the physical
/// angular momentum. An attitude maps body to space components.
///
/// # Shape and units
///
/// A 3 × 3 matrix without unit.
///
/// # Examples
///
/// ```
/// use liestep::SO3;
/// use liestep::groups::LieGroup;
/// use nalgebra::{UnitQuaternion, Vector3};
/// let attitude = SO3::from(UnitQuaternion::from_scaled_axis(Vector3::new(0.8, 0.0, 0.0)));
/// assert!(attitude.defect() < 1e-15);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Lanes)]
pub struct SO3<T = f64>(Matrix3<T>);

/// The error for a matrix that isn't a rotation.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error(
    "the matrix is not a rotation: ‖RᵀR − I‖ = {defect:e}, det R = {determinant}; pass a UnitQuaternion or an orthogonal matrix"
)]
pub struct NotARotation {
    /// The departure `‖RᵀR − I‖` in the Frobenius norm, or NaN.
    pub defect: f64,
    /// The determinant, 1 for a rotation.
    pub determinant: f64,
}

impl<T: Real> SO3<T> {
    /// The element with this matrix, without a check; functions that use `RᵀR = I` are only as right as the matrix.
    #[must_use]
    pub fn from_matrix_unchecked(matrix: Matrix3<T>) -> Self {
        Self(matrix)
    }

    /// The matrix that maps body to space components.
    #[must_use]
    pub fn as_matrix(&self) -> &Matrix3<T> {
        &self.0
    }
}

impl<T: Real> SO3<T> {
    /// The identity.
    #[must_use]
    pub fn identity() -> Self {
        Self(Matrix3::identity())
    }

    /// The rotation `exp ξ̂` by a rotation vector `ξ`, rad.
    ///
    /// Dual numbers have the right derivatives at `ξ = 0`, too. `UnitQuaternion::from_scaled_axis` has the same values,
    /// but returns the identity without derivatives at zero.
    #[must_use]
    pub fn exp(rotation_vector: Vector3<T>) -> Self {
        Self(rotation_exp(rotation_vector))
    }

    /// The inverse rotation.
    #[must_use]
    #[inline]
    pub fn inverse(&self) -> Self {
        Self(self.0.transpose())
    }

    /// The product `R S`: first `S`, then this.
    #[must_use]
    #[inline]
    pub fn compose(&self, other: &Self) -> Self {
        Self(self.0 * other.0)
    }
}

impl<T: RealField + Copy> SO3<T> {
    /// The attitude of a top with the Euler angles precession `φ`, nutation `θ` and spin `ψ`, rad:
    /// `R = exp(φ ẑ) exp(θ x̂) exp(ψ ẑ)`.
    ///
    /// Other sequences are in nalgebra, whose rotations convert both ways.
    #[must_use]
    pub fn from_euler_angles(precession: T, nutation: T, spin: T) -> Self {
        let [z, x] = [Vector3::z_axis(), Vector3::x_axis()];
        let tilted = Rotation3::from_axis_angle(&z, precession) * Rotation3::from_axis_angle(&x, nutation);
        Self((tilted * Rotation3::from_axis_angle(&z, spin)).into_inner())
    }

    /// The precession, nutation (0 to π) and spin of this attitude, the arguments of
    /// [`from_euler_angles`](Self::from_euler_angles), rad.
    ///
    /// In an upright or hanging attitude only the sum or the difference of precession and spin is defined; the spin is
    /// zero then.
    #[must_use]
    pub fn euler_angles(&self) -> [T; 3] {
        let r = &self.0;
        let across = r.m13.hypot(r.m23);
        let nutation = across.atan2(r.m33);
        if across <= T::default_epsilon() {
            return [r.m21.atan2(r.m11), nutation, T::zero()];
        }
        [r.m13.atan2(-r.m23), nutation, r.m31.atan2(r.m32)]
    }

    /// The rotation as a unit quaternion: the one in a table, up to its sign.
    #[must_use]
    pub fn to_quaternion(&self) -> UnitQuaternion<T> {
        let [w, x, y, z] = quaternion(&self.0);
        UnitQuaternion::new_unchecked(Quaternion::new(w, x, y, z))
    }

    /// The rotation vector `ξ` of the smallest angle with `exp ξ̂ = F`.
    ///
    /// The axis at 180° has two signs, of which one is returned. Dual numbers have the right derivatives at the
    /// identity, too, as with [`exp`](Self::exp).
    #[must_use]
    pub fn log(&self) -> Vector3<T> {
        // The logarithm that is smooth at the identity has all its digits below 90°; near 180° it has none.
        if self.0.trace() > T::one() { rotation_log(self.0) } else { self.to_quaternion().scaled_axis() }
    }
}

impl<T> From<UnitQuaternion<T>> for SO3<T>
where
    T: Real,
    T::Element: RealField,
{
    fn from(quaternion: UnitQuaternion<T>) -> Self {
        Self(quaternion.to_rotation_matrix().into_inner())
    }
}

impl<T: RealField + Copy> From<SO3<T>> for UnitQuaternion<T> {
    fn from(attitude: SO3<T>) -> Self {
        attitude.to_quaternion()
    }
}

impl<T: Real> From<SO3<T>> for Rotation3<T> {
    fn from(attitude: SO3<T>) -> Self {
        Self::from_matrix_unchecked(attitude.0)
    }
}

impl<T: Real> From<Rotation3<T>> for SO3<T> {
    fn from(rotation: Rotation3<T>) -> Self {
        Self(rotation.into_inner())
    }
}

impl<T: RealField + Copy> TryFrom<Matrix3<T>> for SO3<T> {
    type Error = NotARotation;

    /// Accepts a matrix that is orthogonal to 10⁴ roundings, so that one printed to a dozen digits passes.
    fn try_from(matrix: Matrix3<T>) -> Result<Self, NotARotation> {
        let candidate = Self(matrix);
        let (defect, determinant) = (candidate.departure(), matrix.determinant());
        if defect < T::default_epsilon() * real(1e4) && determinant > T::zero() {
            Ok(candidate)
        } else {
            Err(NotARotation {
                defect: crate::numbers::reported(defect),
                determinant: crate::numbers::reported(determinant),
            })
        }
    }
}

#[hot]
impl<T: Real> LieGroup for SO3<T> {
    type Scalar = T;
    type Vector = Vector3<T>;
    type Matrix = Matrix3<T>;

    const DIMENSION: usize = 3;
    const ATTITUDES: usize = 1;

    fn identity() -> Self {
        Self(Matrix3::identity())
    }

    fn compose(&self, right: &Self) -> Self {
        Self(self.0 * right.0)
    }

    fn inverse(&self) -> Self {
        Self(self.0.transpose())
    }

    fn matrix(&self) -> Matrix3<T> {
        self.0
    }

    fn from_matrix_unchecked(matrix: Matrix3<T>) -> Self {
        Self(matrix)
    }

    fn hat(v: &Vector3<T>) -> Matrix3<T> {
        let zero = T::zero();
        Matrix3::new(zero, -v.z, v.y, v.z, zero, -v.x, -v.y, v.x, zero)
    }

    /// The components of the skew part of any matrix.
    fn vee(m: &Matrix3<T>) -> Vector3<T> {
        skew_components(m)
    }

    fn adjoint(&self, velocity: &Vector3<T>) -> Vector3<T> {
        self.0 * velocity
    }

    fn adjoint_matrix(&self) -> Matrix3<T> {
        self.0
    }

    fn adjoint_transpose(&self, momentum: &Vector3<T>) -> Vector3<T> {
        transpose_mul(&self.0, momentum)
    }

    fn lie_bracket(xi: &Vector3<T>, eta: &Vector3<T>) -> Vector3<T> {
        xi.cross(eta)
    }

    /// The vector `μ × ξ`.
    fn lie_bracket_transpose(xi: &Vector3<T>, momentum: &Vector3<T>) -> Vector3<T> {
        momentum.cross(xi)
    }

    fn from_increment(increment: &Matrix3<T>) -> Self {
        Self(increment + Matrix3::identity())
    }

    fn increment(&self) -> Matrix3<T> {
        self.0 - Matrix3::identity()
    }

    /// The increment `Dᵀ`.
    fn inverse_increment(increment: &Matrix3<T>) -> Matrix3<T> {
        increment.transpose()
    }

    fn change(&self, increment: &Matrix3<T>) -> Matrix3<T> {
        // The product is unrolled: nalgebra's isn't always inlined, and would then have the target's common
        // instructions in lanes.
        let mut product = Matrix3::zeros();
        for column in 0..3 {
            for row in 0..3 {
                let term = |k: usize| self.0[(row, k)] * increment[(k, column)];
                product[(row, column)] = term(0) + term(1) + term(2);
            }
        }
        product
    }

    fn adjoint_transpose_increment(increment: &Matrix3<T>, momentum: &Vector3<T>) -> Vector3<T> {
        transpose_mul(increment, momentum)
    }

    fn from_rotation(rotation: Matrix3<T>) -> Option<Self> {
        Some(Self(rotation))
    }

    fn factors() -> Vec<Factor> {
        vec![Factor::of(FactorKind::Rotation, 3)]
    }

    // Inlined, so that the length of the caller's array needs no check.
    fn write_numbers<'a>(&self, numbers: &'a mut [T]) -> &'a mut [T] {
        let quaternion = quaternion(&self.0);
        let Some((own, behind)) = numbers.split_first_chunk_mut::<4>() else { return &mut [] };
        let [w, x, y, z] = quaternion;
        let before = own[0] * w + own[1] * x + own[2] * y + own[3] * z;
        let flips = before.simd_lt(T::zero());
        *own = if flips.any() { quaternion.map(|part| (-part).select(flips, part)) } else { quaternion };
        behind
    }

    fn turning_components() -> Vec<bool> {
        vec![true; 3]
    }

    /// The defect `‖RᵀR − I‖` in the Frobenius norm; for a reflection, which is orthogonal too, plus `|det R − 1|`.
    fn defect(&self) -> T {
        let determinant = self.0.column(0).cross(&self.0.column(1)).dot(&self.0.column(2));
        self.departure() + (T::one() - determinant).select(determinant.simd_lt(T::zero()), T::zero())
    }

    /// The projection by one Newton step of the polar decomposition, `½ R (3 I − RᵀR)`, which squares the defect.
    // Inlined, as the optimiser's own choice depends on the rest of the program.
    fn restored(&self, beyond: f64) -> Option<(Self, Mask<T>)> {
        let far = self.departure().simd_gt(T::simd_default_epsilon() * real(beyond));
        far.any().then(|| (self.nearer(far), far))
    }
}

impl<T: Real> SO3<T> {
    /// The departure `‖RᵀR − I‖` in the Frobenius norm.
    // Inlined into `restored`, which every step calls.
    #[hot]
    fn departure(&self) -> T {
        let entry = |i: usize, j: usize| self.0.column(i).dot(&self.0.column(j));
        let on = [0, 1, 2].map(|i| entry(i, i) - T::one());
        let off = [entry(0, 1), entry(0, 2), entry(1, 2)];
        let square = |[a, b, c]: [T; 3]| a * a + b * b + c * c;
        (square(on) + square(off) * real(2.0)).simd_sqrt()
    }

    /// The projection in these lanes.
    #[cold]
    #[inline(never)]
    fn nearer(&self, far: Mask<T>) -> Self {
        // The correction is small, and so is its rounding.
        let off = Matrix3::identity() - self.0.transpose() * self.0;
        let nearest = self.0 + self.0 * off * real::<T>(0.5);
        Self(nearest.zip_map(&self.0, |nearest, entry| nearest.select(far, entry)))
    }
}

/// The product `Aᵀ v`, unrolled.
#[hot]
pub(crate) fn transpose_mul<T: Real>(a: &Matrix3<T>, v: &Vector3<T>) -> Vector3<T> {
    Vector3::new(
        a.m11 * v.x + a.m21 * v.y + a.m31 * v.z,
        a.m12 * v.x + a.m22 * v.y + a.m32 * v.z,
        a.m13 * v.x + a.m23 * v.y + a.m33 * v.z,
    )
}

#[cfg(test)]
mod tests {
    use super::SO3;
    use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};

    #[test]
    fn conversions_go_both_ways() {
        let quaternion = UnitQuaternion::from_scaled_axis(Vector3::new(0.3, -1.1, 0.7));
        let attitude = SO3::from(quaternion);
        assert!((UnitQuaternion::from(attitude).coords - quaternion.coords).norm() < 1e-15);
        assert_eq!(SO3::from(Rotation3::from(attitude)), attitude);
        let back = attitude.compose(&attitude.inverse());
        assert!((back.as_matrix() - SO3::identity().as_matrix()).norm() < 1e-15);
    }

    /// The matrix of a top's Euler angles agrees with the product of its three factors.
    #[test]
    fn euler_angles_are_precession_nutation_and_spin() {
        let about_z = |a: f64| Matrix3::new(a.cos(), -a.sin(), 0.0, a.sin(), a.cos(), 0.0, 0.0, 0.0, 1.0);
        let about_x = |a: f64| Matrix3::new(1.0, 0.0, 0.0, 0.0, a.cos(), -a.sin(), 0.0, a.sin(), a.cos());
        for [precession, nutation, spin] in [[0.4, 1.1, -2.0], [-3.0, 0.01, 3.0], [2.0, 3.1, 0.0], [1.2, 1e-9, 0.7]] {
            let attitude = SO3::from_euler_angles(precession, nutation, spin);
            let expected = about_z(precession) * about_x(nutation) * about_z(spin);
            assert!((attitude.as_matrix() - expected).norm() < 1e-15);
            let found = attitude.euler_angles();
            let error = Vector3::from(found) - Vector3::new(precession, nutation, spin);
            assert!(error.norm() < 1e-6 * (1.0 + 1e-9 / nutation), "{found:?}");
        }
        // One angle is left at the poles, and it yields the same attitude.
        for nutation in [0.0, core::f64::consts::PI] {
            let attitude = SO3::from_euler_angles(0.4, nutation, 0.3);
            let [precession, nutation, spin] = attitude.euler_angles();
            assert!(spin == 0.0);
            let again = SO3::from_euler_angles(precession, nutation, spin);
            assert!((again.as_matrix() - attitude.as_matrix()).norm() < 1e-15);
        }
    }
}
