//! Retractions: coordinates for the increments of a step.
//!
//! A retraction `τ` maps the Lie algebra to the group with `τ(0) = e` and derivative the identity there. The unknown
//! of a Newton solve is such a coordinate vector, and `F` is rebuilt from it in every step: composing small
//! corrections onto the previous `F` would let its rounding errors pile up.

mod matrix_group;
mod rigid;

use nalgebra::{Matrix3, RealField, Vector3};

use crate::groups::{LieGroup, SO3, SquareOf};
use crate::numbers::{Coordinates as _, Mask, Real, real};

/// Coordinates `ξ ↦ τ(ξ)` of a group about its identity.
#[hot]
pub trait Retraction<G: LieGroup> {
    /// The increment `D = τ(ξ) − I`, computed without subtracting `I`, so that no digit of a small `ξ` is lost.
    fn increment(xi: &G::Vector) -> G::Matrix;

    /// The increment for half the coordinates, `y = ξ/2`, which are the unknowns of Newton's iteration: on SO(3) in
    /// Cayley coordinates `tan(θ/2) n`, in which formulas are shortest.
    #[must_use]
    fn increment_of_half(half: &G::Vector) -> G::Matrix {
        Self::increment(&(*half + *half))
    }

    /// The element `τ(ξ)`.
    #[must_use]
    fn retract(xi: &G::Vector) -> G {
        G::from_increment(&Self::increment(xi))
    }

    /// The coordinates `ξ` with `τ(ξ) = F`, or `None` if `F` is out of their reach.
    fn local_coordinates(element: &G) -> Option<G::Vector>;

    /// The right-trivialised tangent `T` at `ξ`: `dF F⁻¹ = (T dξ)^`.
    fn tangent(xi: &G::Vector) -> SquareOf<G>;

    /// The tangent for half the coordinates, `y = ξ/2`: `dF F⁻¹ = (T dy)^`.
    #[must_use]
    fn tangent_of_half(half: &G::Vector) -> SquareOf<G> {
        Self::tangent(&(*half + *half)) * real::<G::Scalar>(2.0)
    }

    /// The derivative by half the coordinates, from the `jacobian` along `F ↦ exp(t E_j) F`: its product with
    /// [`tangent_of_half`](Self::tangent_of_half).
    #[doc(hidden)]
    fn in_coordinates(jacobian: &SquareOf<G>, half: &G::Vector) -> SquareOf<G> {
        G::Vector::times_blocks(jacobian, &Self::tangent_of_half(half), G::FACTORS)
    }

    /// Whether `times ξ` is so near to the identity that a solution there is on the branch of the identity.
    ///
    /// `times` is a positive number: 2 for a solver with half the coordinates. On SO(3) the bound is an angle of 90°:
    /// for a body whose `J_d` is positive semidefinite there is at most one such solution. On a
    /// [`MatrixGroup`](crate::groups::MatrixGroup) it is that of the
    /// [`Generators`](crate::groups::Generators::is_near_identity). Beyond it a solver makes another check. The result
    /// is per lane.
    fn is_near(xi: &G::Vector, times: f64) -> Mask<G::Scalar>;

    /// Whether `ξ` is near to the identity, by [`is_near`](Self::is_near).
    #[must_use]
    fn is_near_identity(xi: &G::Vector) -> Mask<G::Scalar> {
        Self::is_near(xi, 1.0)
    }

    /// Whether `ξ` is near to the identity, for `half = ξ/2`.
    #[must_use]
    fn is_half_near_identity(half: &G::Vector) -> Mask<G::Scalar> {
        Self::is_near(half, 2.0)
    }

    /// Whether `3/2 ξ` is near to the identity, for `half = ξ/2`. Such a `ξ` is far from the region where increments
    /// change fast from step to step.
    #[must_use]
    fn is_half_well_near_identity(half: &G::Vector) -> Mask<G::Scalar> {
        Self::is_near(half, 3.0)
    }
}

/// The Cayley map `cay(ξ) = (I − ξ̂/2)⁻¹ (I + ξ̂/2)`.
///
/// No transcendental function is evaluated, so a step in these coordinates gives the same bits on every IEEE machine.
/// On SO(3) `ξ = 2 tan(θ/2) n` for the rotation by `θ` about `n`, and only half turns are out of reach; on other groups
/// the elements with the eigenvalue −1 are.
///
/// A group by [`Generators`](crate::groups::Generators) that the map leaves, like SL(3), has coordinates of the second kind
/// instead: the product `Π cay(ξ_k E_k)` over its generators, which stays in it if each `E_k³` is a multiple of `E_k`.
#[derive(Clone, Copy, Debug)]
pub struct CayleyRetraction;

#[hot]
impl<T: Real> Retraction<SO3<T>> for CayleyRetraction {
    /// The increment `D = (ξ̂ + ξ̂²/2) · 4/(4 + |ξ|²)`.
    fn increment(xi: &Vector3<T>) -> Matrix3<T> {
        let squared = xi.x * xi.x + xi.y * xi.y + xi.z * xi.z;
        let four = real::<T>(4.0);
        let scale = four / (four + squared);
        quadratic_increment(xi, scale, scale * real(0.5))
    }

    /// The increment `(ŷ + ŷ²) · 2/(1 + |y|²)`, with the same bits.
    fn increment_of_half(half: &Vector3<T>) -> Matrix3<T> {
        let squared = half.x * half.x + half.y * half.y + half.z * half.z;
        let scale = real::<T>(2.0) / (T::one() + squared);
        quadratic_increment(half, scale, scale)
    }

    /// The coordinates `2 (F − Fᵀ)^∨ / (1 + tr F)`.
    #[inline]
    fn local_coordinates(element: &SO3<T>) -> Option<Vector3<T>> {
        let f = element.as_matrix();
        let scale = real::<T>(2.0) / (T::one() + f.m11 + f.m22 + f.m33);
        let xi = SO3::vee(f) * (scale + scale);
        crate::numbers::Coordinates::is_finite(&xi).then_some(xi)
    }

    /// The tangent `T = (I + ξ̂/2) · 4/(4 + |ξ|²)`.
    #[inline]
    fn tangent(xi: &Vector3<T>) -> Matrix3<T> {
        let four = real::<T>(4.0);
        let scale = four / (four + xi.norm_squared());
        (Matrix3::identity() + SO3::hat(xi) * real::<T>(0.5)) * scale
    }

    fn is_near(xi: &Vector3<T>, times: f64) -> Mask<T> {
        (xi.x * xi.x + xi.y * xi.y + xi.z * xi.z).simd_lt(real(4.0 / (times * times)))
    }
}

/// The exponential map; on SO(3) `ξ = θ n`.
///
/// For a group with [`Generators`](crate::groups::Generators) it is a series with scaling and squaring, exact to some
/// roundings for `‖ξ̂‖` up to a few; coordinates are the principal logarithm, `None` if an eigenvalue is negative.
#[derive(Clone, Copy, Debug)]
pub struct ExponentialRetraction;

impl<T: RealField + Copy> Retraction<SO3<T>> for ExponentialRetraction {
    /// Rodrigues' formula, `D = (sin θ/θ) ξ̂ + ½ (sin(θ/2)/(θ/2))² ξ̂²`, free of cancellation.
    fn increment(xi: &Vector3<T>) -> Matrix3<T> {
        let angle_squared = xi.norm_squared();
        let (first, half) = (sinc(angle_squared), sinc(angle_squared * real(0.25)));
        quadratic_increment(xi, first, half * half * real(0.5))
    }

    fn local_coordinates(element: &SO3<T>) -> Option<Vector3<T>> {
        let xi = element.log();
        crate::numbers::Coordinates::is_finite(&xi).then_some(xi)
    }

    /// The tangent `T = I + (1 − cos θ)/θ² ξ̂ + (θ − sin θ)/θ³ ξ̂²`.
    fn tangent(xi: &Vector3<T>) -> Matrix3<T> {
        let angle_squared = xi.norm_squared();
        let half = sinc(angle_squared * real(0.25));
        // Digits of (θ − sin θ)/θ³ cancel at small θ; below this bound its Taylor polynomial is exact to a rounding.
        let third = if angle_squared < real(0.04) {
            let t = angle_squared;
            let [a, b, c, d, e] =
                [1.0 / 6.0, -1.0 / 120.0, 1.0 / 5040.0, -1.0 / 362_880.0, 1.0 / 39_916_800.0].map(real::<T>);
            a + t * (b + t * (c + t * (d + t * e)))
        } else {
            (T::one() - sinc(angle_squared)) / angle_squared
        };
        Matrix3::identity() + quadratic_increment(xi, half * half * real(0.5), third)
    }

    fn is_near(xi: &Vector3<T>, times: f64) -> Mask<T> {
        (xi * real::<T>(times)).norm_squared() < T::frac_pi_2() * T::frac_pi_2()
    }
}

/// The matrix `a ξ̂ + b ξ̂²`.
#[hot]
fn quadratic_increment<T: Real>(xi: &Vector3<T>, a: T, b: T) -> Matrix3<T> {
    let (x, y, z) = (xi.x, xi.y, xi.z);
    let (bx, by, bz) = (b * x, b * y, b * z);
    let (ax, ay, az) = (a * x, a * y, a * z);
    let (xx, yy, zz) = (bx * x, by * y, bz * z);
    let (xy, xz, yz) = (bx * y, bx * z, by * z);
    Matrix3::new(-(yy + zz), xy - az, xz + ay, xy + az, -(xx + zz), yz - ax, xz - ay, yz + ax, -(xx + yy))
}

/// The function `sin θ / θ` of `θ²`.
///
/// The Taylor polynomial to `θ¹⁰` is exact to a rounding below `θ² = 0.01`. It has no square root at zero, whose
/// derivative doesn't exist in a dual number.
fn sinc<T: RealField + Copy>(angle_squared: T) -> T {
    if angle_squared < real(0.01) {
        let t = angle_squared;
        let [a, b, c, d, e] =
            [-1.0 / 6.0, 1.0 / 120.0, -1.0 / 5040.0, 1.0 / 362_880.0, -1.0 / 39_916_800.0].map(real::<T>);
        T::one() + t * (a + t * (b + t * (c + t * (d + t * e))))
    } else {
        let angle = angle_squared.sqrt();
        angle.sin() / angle
    }
}
