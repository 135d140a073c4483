//! Matrix Lie groups, each in a file of its own.
//!
//! The laws that every group satisfies, with `F`, `G` in the group, `ξ`, `η` in the algebra, `μ` in its dual:
//!
//! | law | |
//! |---|---|
//! | `Ad_F ξ = (F ξ̂ F⁻¹)^∨` | [`adjoint`](LieGroup::adjoint) |
//! | `⟨Ad*_F μ, ξ⟩ = ⟨μ, Ad_F ξ⟩` | [`adjoint_transpose`](LieGroup::adjoint_transpose) |
//! | `ad_ξ η = (ξ̂ η̂ − η̂ ξ̂)^∨` | [`lie_bracket`](LieGroup::lie_bracket) |
//! | `⟨ad*_ξ μ, η⟩ = ⟨μ, ad_ξ η⟩` | [`lie_bracket_transpose`](LieGroup::lie_bracket_transpose) |
//! | `{f, k}(μ) = −⟨μ, ad_{δf/δμ} δk/δμ⟩` | [`lie_poisson_bracket`](LieGroup::lie_poisson_bracket) |
//!
//! The groups, and the generators of each:
//!
//! | group | | generators |
//! |---|---|---|
//! | [`SO2`], [`SO3`] | rotations of the plane and of space | [`SO2Generators`]; SO(3) is written out |
//! | [`SE2`], [`SE3`] | rigid motions | [`SE2Generators`], [`SE3Generators`] |
//! | [`SE23`] | extended poses: attitude, velocity and place | [`SE23Generators`] |
//! | [`SU2`] | unit quaternions | [`SU2Generators`] |
//! | [`SL2`] | area-preserving linear maps of the plane | [`SL2Generators`] |
//! | [`Heisenberg`] | unitriangular matrices | [`HeisenbergGenerators`] |
//! | [`R1`], [`R2`], [`R3`] | translations | [`TranslationGenerators`] |
//!
//! Any other group is declared in this way, outside of this crate too: see [`Generators`]. A product of two to four
//! groups is the tuple, as `(SO3, SO3)` for two bodies: its components are those of its [factors](Factor), one after
//! the other. `[SO3; N]` is the product of `N` equal groups, for [systems](crate::mechanics::Placement) of many bodies.

mod advected;
mod affine;
mod bodies;
mod exponential;
mod generators;
mod heisenberg;
pub(crate) mod layout;
mod matrix_group;
mod product;
mod retraction;
mod rigid;
pub(crate) mod rotation_functions;
mod se2;
mod se23;
mod se3;
mod sl2;
mod so2;
mod so3;
mod su2;
mod translations;

pub use advected::{
    Advected, Configuration, ContravariantTensor, ContravariantVector, CovariantTensor, Given, MixedTensor, Relative,
    SeenFrom,
};
pub(crate) use advected::{homogeneous, seen_of_unit};
pub use bodies::Pair;
pub(crate) use exponential::{exponential, logarithm};
pub use generators::{Generators, matrix};
pub(crate) use generators::{cubes, dynamic, inverse, is_closed_under_cayley, products_vanish, squares};
pub use heisenberg::{Heisenberg, HeisenbergGenerators};
pub use liestep_macros::matrix_group;
pub use matrix_group::{MatrixGroup, NotInGroup};
pub(crate) use matrix_group::{basis, lane_by_lane};
pub use product::Factor;
pub use retraction::{CayleyRetraction, ExponentialRetraction, Retraction};
pub(crate) use rotation_functions::rotation_coefficients;
pub use se2::{SE2, SE2Generators};
pub use se3::{SE3, SE3Generators};
pub use se23::{SE23, SE23Generators};
pub use sl2::{SL2, SL2Generators};
pub use so2::{SO2, SO2Generators};
pub use so3::{NotARotation, SO3};
pub use su2::{SU2, SU2Generators};
pub use translations::{R1, R2, R3, TranslationGenerators};

use alloc::vec;
use alloc::vec::Vec;
use core::fmt::Debug;

use nalgebra::Matrix3;

use crate::numbers::{Blocks, Coordinates, Entries, Mask, Real, sum};

/// Linear maps of a group's components.
pub(crate) type SquareOf<G> = <<G as LieGroup>::Vector as Coordinates<<G as LieGroup>::Scalar>>::Square;

/// The body of an array, or the factor of a product, with this component, from zero; none if there is only one.
pub(crate) fn body_of<G: LieGroup>(component: usize) -> Option<usize> {
    if G::BODIES > 1 {
        return Some(component / (G::DIMENSION / G::BODIES));
    }
    (!G::FACTORS.is_whole()).then(|| (1..=component).filter(|&k| G::FACTORS.end_at(k)).count())
}

/// A matrix Lie group with a declared basis `E_k` of its Lie algebra.
///
/// Covectors have the components `μ_k = ⟨μ, E_k⟩`, so that no factor ½ appears anywhere.
pub trait LieGroup: Copy + Debug + PartialEq + 'static {
    /// The scalar of the matrices.
    type Scalar: Real;
    /// The components of algebra elements and of covectors.
    type Vector: Coordinates<Self::Scalar> + 'static;
    /// The ambient matrices.
    type Matrix: Entries<Self::Scalar> + Debug + PartialEq + 'static;

    /// The dimension of the group.
    const DIMENSION: usize;

    /// The components of each factor of a product; for an array of bodies those of one.
    const FACTORS: Blocks = Blocks::WHOLE;

    /// Number of equal bodies in an array; otherwise one.
    const BODIES: usize = 1;

    /// The number of rows of a matrix below which all elements are the identity; by default all may differ from it.
    #[doc(hidden)]
    const ROWS: usize = usize::MAX;

    /// Number of rotations of bodies in an element.
    const ATTITUDES: usize = 0;

    /// The identity `e`.
    fn identity() -> Self;

    /// The product `self · right`.
    #[must_use]
    fn compose(&self, right: &Self) -> Self;

    /// The inverse element.
    #[must_use]
    fn inverse(&self) -> Self;

    /// The element as a matrix.
    fn matrix(&self) -> Self::Matrix;

    /// The element with this matrix, without a check; functions that use the group's relation are only as right as the
    /// matrix.
    #[must_use]
    fn from_matrix_unchecked(matrix: Self::Matrix) -> Self;

    /// The matrix `ξ̂ = Σ ξ_k E_k` of an algebra element.
    fn hat(components: &Self::Vector) -> Self::Matrix;

    /// The components of an algebra element, the inverse of [`hat`](Self::hat).
    fn vee(matrix: &Self::Matrix) -> Self::Vector;

    /// The adjoint action `Ad_F ξ`.
    fn adjoint(&self, velocity: &Self::Vector) -> Self::Vector;

    /// The matrix of `Ad_F`, for many vectors: `D × D` for the `D` components of the algebra, column `k` being
    /// `Ad_F E_k`; for several equal bodies its diagonal blocks, one for each body.
    #[hot]
    #[must_use]
    fn adjoint_matrix(&self) -> <Self::Vector as Coordinates<Self::Scalar>>::Square {
        Self::Vector::square(|k| self.adjoint(&Self::Vector::axis(k)))
    }

    /// The dual `Ad*_F μ` of [`adjoint`](Self::adjoint): its transpose (not the inverse transpose).
    fn adjoint_transpose(&self, momentum: &Self::Vector) -> Self::Vector;

    /// The Lie bracket `ad_ξ η`.
    fn lie_bracket(xi: &Self::Vector, eta: &Self::Vector) -> Self::Vector;

    /// The transpose `ad*_ξ μ` of [`lie_bracket`](Self::lie_bracket), \[RDAE, (1.17)\].
    fn lie_bracket_transpose(xi: &Self::Vector, momentum: &Self::Vector) -> Self::Vector;

    /// The Lie–Poisson bracket `{f, k}(μ) = −⟨μ, ad_{δf/δμ} δk/δμ⟩` of two functions with these derivatives at `μ`,
    /// \[RDAE, (1.11)\]. For axes of the basis it is an entry of the Poisson tensor.
    #[must_use]
    fn lie_poisson_bracket(momentum: &Self::Vector, df: &Self::Vector, dk: &Self::Vector) -> Self::Scalar {
        -momentum.dot(&Self::lie_bracket(df, dk))
    }

    /// The element `I + D`, for an increment `D = F − I` from a retraction.
    fn from_increment(increment: &Self::Matrix) -> Self;

    /// The increment `D = F − I`.
    fn increment(&self) -> Self::Matrix;

    /// The increment `F⁻¹ − I = −F⁻¹D` of the inverse, for `F = I + D`, computed without subtracting `I`.
    #[must_use]
    fn inverse_increment(increment: &Self::Matrix) -> Self::Matrix;

    /// The change `g F − g = g D`.
    #[must_use]
    fn change(&self, increment: &Self::Matrix) -> Self::Matrix;

    /// The reconstruction `g ← g F = g + g D`, \[RDAE, (2.10)\].
    ///
    /// Adding `g D` loses less to rounding than multiplying by `F ≈ I`: the error of a product of size one becomes
    /// one of size `|D|`.
    #[hot]
    #[must_use]
    fn advance(&self, increment: &Self::Matrix) -> Self {
        Self::from_matrix_unchecked(sum(&self.matrix(), &self.change(increment)))
    }

    /// The change `Ad*_F μ − μ` of a covector, for `F = I + D`.
    fn adjoint_transpose_increment(increment: &Self::Matrix, momentum: &Self::Vector) -> Self::Vector;

    /// The element with this rotation, if the group is that of the rotations of space: theorems on rotations hold for
    /// it.
    fn from_rotation(_rotation: Matrix3<Self::Scalar>) -> Option<Self> {
        None
    }

    /// The names of a translation's coordinates, in the last column; empty for other groups.
    #[doc(hidden)]
    const COORDINATES: &'static [&'static str] = &[];

    /// The factors of the group, with the names of their columns and components in tables.
    #[must_use]
    fn factors() -> Vec<layout::Factor> {
        let mut entries = 0;
        Self::identity().matrix().each(&mut |_| entries += 1);
        let rows = (1..=entries).find(|rows| rows * rows >= entries).unwrap_or(1);
        let kind = if Self::COORDINATES.is_empty() {
            layout::FactorKind::Matrix(rows)
        } else {
            layout::FactorKind::Translation(rows)
        };
        let generator = |component: usize| {
            let mut entries = Vec::new();
            let axis = Self::Vector::axis(component);
            Self::hat(&axis).each(&mut |entry| entries.push(f64::from(u8::from(entry != nalgebra::zero()))));
            entries
        };
        let generators: Vec<_> = (0..Self::DIMENSION).map(generator).collect();
        vec![layout::Factor::of(kind, Self::DIMENSION).with_generators(&generators)]
    }

    /// Writes the numbers of the [columns](layout::Factor::columns) of all factors over those of the element before, or over zeros, and returns the rest of the slice. A
    /// quaternion has the sign that is nearer to the one before.
    fn write_numbers<'a>(&self, numbers: &'a mut [Self::Scalar]) -> &'a mut [Self::Scalar] {
        let (mut places, mut entry, rows) = (numbers.iter_mut(), 0, Self::COORDINATES.len() + 1);
        self.matrix().each(&mut |value| {
            // A translation's coordinates are in the last column.
            let is_shown = rows == 1 || entry % rows == rows - 1 && entry / rows < rows - 1;
            entry += 1;
            if let Some(place) = is_shown.then(|| places.next()).flatten() {
                *place = value;
            }
        });
        places.into_slice()
    }

    /// The angular components of a velocity, rad/s: all on SO(3), none of a translation, on a product those of its
    /// factors. Errors compute angles of turns from them. By default none.
    #[must_use]
    fn turning_components() -> Vec<bool> {
        vec![false; Self::DIMENSION]
    }

    /// The residual of the group's relation; zero on the group.
    fn defect(&self) -> Self::Scalar;

    /// The nearest element of the group, if rounding has taken the matrix farther from the group than `beyond` units of
    /// rounding, and the lanes in which it has; none if it hasn't, or if no projection is known, which is the default.
    ///
    /// Random roundings move an attitude by about `ε √N` in `N` steps, which isn't far. A body that turns steadily
    /// makes the same increment, with the same rounding, in every step, and that adds up like `N`.
    #[must_use]
    fn restored(&self, _beyond: f64) -> Option<(Self, Mask<Self::Scalar>)> {
        None
    }
}
