//! Advected parameters: constants in space, on which the group acts, in the body frame.
//!
//! The spatial value `a_0` is constant; in the body frame it is `w_i = g_i⁻¹ · a_0`. A parameter in `V*` moves by the
//! contragredient action, in columns `w_{i+1} = ρ(f)ᵀ w_i`; on SO(3) that is the rotation `Fᵀ w`. The product `F⁻¹ w`,
//! which is the same on SO(3), belongs to `V` and is another parameter on a group that isn't orthogonal.
//!
//! | parameter in | type | `f⁻¹ · w` | for example |
//! |---|---|---|---|
//! | `V*` | `SVector<T, N>`, as `Vector3` | `Fᵀ w` | a direction, a plane, a potential's gradient |
//! | `V` | [`ContravariantVector`] | `F⁻¹ w` | a displacement fixed in space |
//! | `V`, its last coordinate one | `Point1`, `Point2`, `Point3` of nalgebra | `F⁻¹ (p, 1)` | a point fixed in space |
//! | `V ⊗ V` | [`ContravariantTensor`] | `F⁻¹ S F⁻ᵀ` | a conductivity |
//! | `V* ⊗ V*` | [`CovariantTensor`] | `Fᵀ S F` | a metric, a strain, the gradient of a field of force |
//! | `V ⊗ V*` | [`MixedTensor`] | `F⁻¹ S F` | a velocity gradient |
//! | a trivial representation | [`Given`] | `x` | a torque or a field's strength that is prescribed in each step |
//!
//! On a product of groups, for several bodies, each parameter is [in the frame of one](SeenFrom), or is the
//! configuration of a body [relative to another](Relative) or [in space](Configuration).
//!
//! `V` is the space on which the group's matrices act, `F` the matrix itself. Groups of affine maps, as SE(2) and
//! SE(3), act on points in homogeneous coordinates; vectors with another last coordinate move by the same matrices, but
//! their distances aren't conserved.

use core::fmt::Debug;

mod given;
mod points;
mod several;
mod tensors;

pub use given::Given;
pub(crate) use points::homogeneous;
pub use several::{Configuration, Relative, SeenFrom};
pub use tensors::{ContravariantTensor, ContravariantVector, CovariantTensor, MixedTensor};

use nalgebra::{SMatrix, SVector, SimdBool as _, SimdPartialOrd as _};

use crate::groups::LieGroup;
use crate::numbers::{Coordinates, Entries, Real, of_tuples, real, sum, zero};

/// The advected parameters of a Lagrangian: `()` for none, a vector for one, a tuple for several.
pub trait Advected<G: LieGroup>: Entries<G::Scalar> + Debug + PartialEq {
    /// The spatial value in the frame of a body with the attitude `g`, `g⁻¹ · a_0`.
    #[must_use]
    fn seen_from(&self, attitude: &G) -> Self;

    /// The change `f⁻¹ · w − w` for `f = I + D`, computed without subtracting `w`.
    #[must_use]
    fn change(&self, increment: &G::Matrix) -> Self;

    /// The value after an increment, `f⁻¹ · w` for `f = I + D`, \[RDAE, (2.4)\].
    #[hot]
    #[must_use]
    fn advect(&self, increment: &G::Matrix) -> Self {
        sum(self, &self.change(increment))
    }

    /// The rate `ẇ = −ξ·w` of the value in the frame of a body with the velocity `ξ`, for the matrix `ξ̂`, \[RDAE,
    /// (2.2)\].
    #[must_use]
    fn rate(&self, velocity: &G::Matrix) -> Self;

    /// The action of the inverse of any invertible matrix on the spatial value, as [`seen_from`](Self::seen_from) for
    /// an element of the group.
    #[must_use]
    fn seen_through(&self, matrix: &G::Matrix, inverse: &G::Matrix) -> Self;

    /// The gradient of a scalar by the spatial value, from its gradient by the value in the body frame: the transpose
    /// of the linear part of [`seen_from`](Self::seen_from).
    ///
    /// The default acts on the unit of each scalar in turn, which takes as many actions as there are scalars.
    #[inline]
    #[must_use]
    fn pulled_back(&self, attitude: &G) -> Self {
        let mut number = 0;
        Self::from_entries(&mut || {
            let mut sum = real::<G::Scalar>(0.0);
            let _ = seen_of_unit::<G, Self>(number, attitude).zip(self, &mut |seen, by| {
                sum += seen * by;
                seen
            });
            number += 1;
            sum
        })
    }

    /// Whether all components are finite.
    #[hot]
    #[must_use]
    fn is_finite(&self) -> bool {
        // Zero times an infinity or a NaN is NaN; the plain sum could overflow.
        let (zero, mut sum) = (real::<G::Scalar>(0.0), real::<G::Scalar>(0.0));
        self.each(&mut |entry| sum += entry * zero);
        sum.simd_eq(zero).all()
    }
}

/// The derivative of the value in the body frame by the scalar of this number of the spatial value.
pub(crate) fn seen_of_unit<G: LieGroup, A: Advected<G>>(number: usize, attitude: &G) -> A {
    let mut place = 0;
    let unit = A::from_entries(&mut || {
        place += 1;
        if place == number + 1 { real(1.0) } else { real(0.0) }
    });
    // The action on a point is affine.
    unit.seen_from(attitude).zip(&zero::<G::Scalar, A>().seen_from(attitude), &mut |a, b| a - b)
}

/// A covector, an element of `V*`.
#[hot]
impl<G, T: Real, const N: usize> Advected<G> for SVector<T, N>
where
    G: LieGroup<Scalar = T, Matrix = SMatrix<T, N, N>>,
{
    /// The image `ρ(g)ᵀ a_0`.
    #[inline]
    fn seen_from(&self, attitude: &G) -> Self {
        transpose_mul(&attitude.matrix(), self)
    }

    /// The image `ρ(g)` of the gradient.
    fn pulled_back(&self, attitude: &G) -> Self {
        mul(&attitude.matrix(), self)
    }

    /// The change `Dᵀ w`.
    fn change(&self, increment: &SMatrix<T, N, N>) -> Self {
        transpose_mul_rows(increment, self, G::ROWS.min(N))
    }

    /// The rate `ξ̂ᵀ w`.
    fn rate(&self, velocity: &SMatrix<T, N, N>) -> Self {
        transpose_mul(velocity, self)
    }

    fn seen_through(&self, matrix: &SMatrix<T, N, N>, _: &SMatrix<T, N, N>) -> Self {
        transpose_mul(matrix, self)
    }

    fn is_finite(&self) -> bool {
        Coordinates::is_finite(self)
    }
}

/// The product `Aᵀ v`, unrolled.
#[hot]
fn transpose_mul<T: Real, const N: usize>(a: &SMatrix<T, N, N>, v: &SVector<T, N>) -> SVector<T, N> {
    transpose_mul_rows(a, v, N)
}

/// The product `Aᵀ v` for an `A` whose rows from `rows` on are zero.
#[hot]
fn transpose_mul_rows<T: Real, const N: usize>(a: &SMatrix<T, N, N>, v: &SVector<T, N>, rows: usize) -> SVector<T, N> {
    let mut product = SVector::zeros();
    for i in 0..N {
        let mut sum = a[(0, i)] * v[0];
        for j in 1..rows {
            sum += a[(j, i)] * v[j];
        }
        product[i] = sum;
    }
    product
}

/// The product `A v`, unrolled.
#[hot]
fn mul<T: Real, const N: usize>(a: &SMatrix<T, N, N>, v: &SVector<T, N>) -> SVector<T, N> {
    let mut product = SVector::zeros();
    for i in 0..N {
        let mut sum = a[(i, 0)] * v[0];
        for j in 1..N {
            sum += a[(i, j)] * v[j];
        }
        product[i] = sum;
    }
    product
}

macro_rules! tuple {
    ($($name:ident $index:tt),*) => {
        #[allow(clippy::unused_unit, unused_variables)] // in the impl of the empty tuple
        #[hot]
        impl<G: LieGroup, $($name: Advected<G>),*> Advected<G> for ($($name,)*) {
            fn seen_from(&self, attitude: &G) -> Self {
                ($(self.$index.seen_from(attitude),)*)
            }

            fn pulled_back(&self, attitude: &G) -> Self {
                ($(self.$index.pulled_back(attitude),)*)
            }

            fn change(&self, increment: &G::Matrix) -> Self {
                ($(self.$index.change(increment),)*)
            }

            fn rate(&self, velocity: &G::Matrix) -> Self {
                ($(self.$index.rate(velocity),)*)
            }

            fn seen_through(&self, matrix: &G::Matrix, inverse: &G::Matrix) -> Self {
                ($(self.$index.seen_through(matrix, inverse),)*)
            }
        }
    };
}

of_tuples!(tuple);
