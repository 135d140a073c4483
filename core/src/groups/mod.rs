//! Matrix Lie groups, one to a file.
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
//! The groups, and what declares each:
//!
//! | group | | declared by |
//! |---|---|---|
//! | [`SO2`], [`SO3`] | rotations of the plane and of space | [`SO2Generators`]; SO(3) is written out |
//! | [`SE2`], [`SE3`] | rigid motions | [`SE2Generators`], [`SE3Generators`] |
//! | [`SE23`] | extended poses: attitude, velocity and place | [`SE23Generators`] |
//! | [`SU2`] | unit quaternions | [`SU2Generators`] |
//! | [`SL2`] | area-preserving linear maps of the plane | [`SL2Generators`] |
//! | [`Heisenberg`] | unitriangular matrices | [`HeisenbergGenerators`] |
//! | [`R1`], [`R2`], [`R3`] | translations | [`TranslationGenerators`] |
//!
//! Any other is declared in the same way, outside of this crate too: see [`Generators`]. A product of two to four of them
//! is the tuple, as `(SO3, SO3)` for two bodies: its components are those of its [factors](Factor), one after the other.
//! `[SO3; N]` is the product of `N` equal groups, for [systems](crate::mechanics::Placement) of many bodies.

mod advected;
mod bodies;
mod exponential;
mod generators;
mod heisenberg;
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
pub(crate) use generators::{inverse, is_closed_under_cayley, products_vanish};
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

use alloc::format;
use alloc::string::String;
use alloc::string::ToString as _;
use alloc::vec;
use alloc::vec::Vec;
use core::fmt::Debug;

use nalgebra::Matrix3;

use crate::numbers::{Blocks, Coordinates, Entries, Mask, Real, sum};

/// Linear maps of a group's components.
pub(crate) type SquareOf<G> = <<G as LieGroup>::Vector as Coordinates<<G as LieGroup>::Scalar>>::Square;

/// The body of an array that a component belongs to, or the factor of a product, from zero; none where there is but one.
pub(crate) fn body_of<G: LieGroup>(component: usize) -> Option<usize> {
    if G::BODIES > 1 {
        return Some(component / (G::DIMENSION / G::BODIES));
    }
    (!G::FACTORS.is_whole()).then(|| (1..=component).filter(|&k| G::FACTORS.end_at(k)).count())
}

/// A matrix Lie group with a declared basis `E_k` of its Lie algebra.
///
/// Covectors are given by their components `μ_k = ⟨μ, E_k⟩`, so that no factor ½ appears anywhere.
pub trait LieGroup: Copy + Debug + PartialEq + 'static {
    /// The scalar of the matrices.
    type Scalar: Real;
    /// Components of algebra elements and of covectors.
    type Vector: Coordinates<Self::Scalar> + 'static;
    /// The ambient matrices.
    type Matrix: Entries<Self::Scalar> + Debug + PartialEq + 'static;

    /// The dimension of the group.
    const DIMENSION: usize;

    /// The components that belong to each factor, where the group is a product; of an array of bodies, those of one.
    const FACTORS: Blocks = Blocks::WHOLE;

    /// How many equal bodies are in an array; otherwise one.
    const BODIES: usize = 1;

    /// How many rotations of bodies are in an element.
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

    /// Takes the matrix as it is; what depends on the relation of the group is then only as right as the matrix.
    #[must_use]
    fn from_matrix_unchecked(matrix: Self::Matrix) -> Self;

    /// `ξ̂ = Σ ξ_k E_k`.
    fn hat(components: &Self::Vector) -> Self::Matrix;

    /// The components of an algebra element, the inverse of [`hat`](Self::hat).
    fn vee(matrix: &Self::Matrix) -> Self::Vector;

    /// `Ad_F ξ`.
    fn adjoint(&self, velocity: &Self::Vector) -> Self::Vector;

    /// `Ad_F` as a matrix, where it is to map many: `D × D` for the `D` components of the algebra, column `k` being
    /// `Ad_F E_k`; for several equal bodies its blocks on the diagonal, one of each body.
    #[hot]
    #[must_use]
    fn adjoint_matrix(&self) -> <Self::Vector as Coordinates<Self::Scalar>>::Square {
        Self::Vector::square(|k| self.adjoint(&Self::Vector::axis(k)))
    }

    /// `Ad*_F μ`, the transpose of [`adjoint`](Self::adjoint) (not the inverse transpose).
    fn adjoint_transpose(&self, momentum: &Self::Vector) -> Self::Vector;

    /// `ad_ξ η`.
    fn lie_bracket(xi: &Self::Vector, eta: &Self::Vector) -> Self::Vector;

    /// `ad*_ξ μ`, the transpose of [`lie_bracket`](Self::lie_bracket), \[RDAE, (1.17)\].
    fn lie_bracket_transpose(xi: &Self::Vector, momentum: &Self::Vector) -> Self::Vector;

    /// `{f, k}(μ) = −⟨μ, ad_{δf/δμ} δk/δμ⟩`, the Lie–Poisson bracket of two functions with these derivatives at `μ`,
    /// \[RDAE, (1.11)\]. For axes of the basis it is an entry of the Poisson tensor.
    #[must_use]
    fn lie_poisson_bracket(momentum: &Self::Vector, df: &Self::Vector, dk: &Self::Vector) -> Self::Scalar {
        -momentum.dot(&Self::lie_bracket(df, dk))
    }

    /// The element `I + D`, for an increment `D = F − I` that a retraction has formed.
    fn from_increment(increment: &Self::Matrix) -> Self;

    /// The increment `D = F − I`.
    fn increment(&self) -> Self::Matrix;

    /// `F⁻¹ − I = −F⁻¹D`, for `F = I + D`, formed without subtracting `I`.
    #[must_use]
    fn inverse_increment(increment: &Self::Matrix) -> Self::Matrix;

    /// `g F − g = g D`.
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

    /// `Ad*_F μ − μ` for `F = I + D`.
    fn adjoint_transpose_increment(increment: &Self::Matrix, momentum: &Self::Vector) -> Self::Vector;

    /// The element that is this rotation, if the group is that of the rotations of space: what is proved of rotations
    /// holds for it.
    fn from_rotation(_rotation: Matrix3<Self::Scalar>) -> Option<Self> {
        None
    }

    /// Of translations the names of what the last column has; else nothing.
    #[doc(hidden)]
    const COORDINATES: &'static [&'static str] = &[];

    /// The numbers by which a table shows an element, a name and a unit each: on SO(3) its unit quaternion, of translations
    /// `x`, `y` and `z`, on a product those of its factors, elsewhere the entries of the matrix, row by row: `g_12`, and
    /// `g_1_12` of ten rows or more. Where nothing is known of a unit it is empty.
    #[must_use]
    fn named_numbers() -> Vec<(String, &'static str)> {
        let translations = Self::COORDINATES;
        if !translations.is_empty() {
            return translations.iter().map(|name| ((*name).into(), "m")).collect();
        }
        let mut entries = 0;
        Self::identity().matrix().each(&mut |_| entries += 1);
        let rows = (1..=entries).find(|rows| rows * rows >= entries).unwrap_or(1);
        // Without a separator, 1 and 11 would read as 11 and 1.
        let between = if rows > 9 { "_" } else { "" };
        (0..entries).map(|entry| (format!("g_{}{between}{}", entry / rows + 1, entry % rows + 1), "")).collect()
    }

    /// Writes these numbers over those of the element before, or over zeros, and returns the places behind them. Of two
    /// quaternions it is the nearer one.
    fn write_numbers<'a>(&self, numbers: &'a mut [Self::Scalar]) -> &'a mut [Self::Scalar] {
        let (mut places, mut entry, rows) = (numbers.iter_mut(), 0, Self::COORDINATES.len() + 1);
        self.matrix().each(&mut |value| {
            // Of translations the last column.
            let is_shown = rows == 1 || entry % rows == rows - 1 && entry / rows < rows - 1;
            entry += 1;
            if let Some(place) = is_shown.then(|| places.next()).flatten() {
                *place = value;
            }
        });
        places.into_slice()
    }

    /// The components of algebra elements and covectors: a name, and the units of a velocity and of a momentum. They are
    /// `x`, `y`, `z` on SO(3), on a product those of its factors, elsewhere numbers from one. Where nothing is known of a
    /// unit it is empty.
    #[must_use]
    fn named_components() -> Vec<(String, [&'static str; 2])> {
        (1..=Self::DIMENSION).map(|component| (component.to_string(), [""; 2])).collect()
    }

    /// Which components of a velocity are angular ones, rad/s: all of SO(3), none of a translation, on a product those of its
    /// factors. Errors say by these how far a body would turn. Nothing is known of a group by default.
    #[must_use]
    fn turning_components() -> Vec<bool> {
        vec![false; Self::DIMENSION]
    }

    /// How far the matrix is from satisfying the relation of the group; zero on it.
    fn defect(&self) -> Self::Scalar;

    /// The nearest element of the group, if roundings have taken the matrix farther from it than `beyond` units of rounding,
    /// and the lanes in which they have; nothing where they haven't, or where no way back is known, which is the default.
    ///
    /// Roundings at random take an attitude about `ε √N` away in `N` steps, and that isn't far. A body that turns
    /// steadily makes the same increment, with the same rounding, step by step, and that grows like `N`.
    #[must_use]
    fn restored(&self, _beyond: f64) -> Option<(Self, Mask<Self::Scalar>)> {
        None
    }
}
