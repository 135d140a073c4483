//! The group of matrices for a set of generators.

use alloc::vec::Vec;
use core::fmt;
use core::marker::PhantomData;

use nalgebra::{RealField, SMatrix, SVector, Vector1};
use thiserror::Error;

use super::LieGroup;
use super::affine::{times, times_transpose, transpose_times};
use super::generators::{
    Generators, NonZero, changed_rows, dual, dynamic, is_orthogonal, nonzero_entries, products_vanish, squared_lengths,
    structure_constants,
};
use super::rigid;
use crate::numbers::{Lanes, Real, real, reported};

/// An element of the matrix group with the [`Generators`] `K`.
///
/// Tangent space: `ξ̂ = Σ ξ_k E_k`; `ad_ξ η` by the structure constants, which are computed when the user's crate is
/// compiled. Covector components are `μ_k = ⟨μ, E_k⟩`; as a matrix a covector is `Σ μ_k E^k` with the dual basis, paired by
/// `tr(AᵀB)`; for an orthogonal basis `E^k = E_k / tr(E_kᵀ E_k)`.
///
/// # Shape and units
///
/// An `N` × `N` matrix; the units of its entries are those on the group's own page.
#[derive(Clone, Copy, PartialEq, Lanes)]
pub struct MatrixGroup<K, T, const N: usize, const D: usize>(SMatrix<T, N, N>, #[shared] PhantomData<K>);

/// The error for a matrix that isn't in the group.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error("the matrix is not in the group: it misses the group's relation by {defect:e}; project it first")]
pub struct NotInGroup {
    /// Residual of the group's relation for the matrix, or NaN.
    pub defect: f64,
}

impl<K: fmt::Debug, T: Real, const N: usize, const D: usize> fmt::Debug for MatrixGroup<K, T, N, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("MatrixGroup").field(&self.0).finish()
    }
}

impl<K, T, const N: usize, const D: usize> MatrixGroup<K, T, N, D> {
    /// The element with this matrix, without a check; functions that use the group's relation are only as right as the
    /// matrix.
    #[must_use]
    pub const fn from_matrix_unchecked(matrix: SMatrix<T, N, N>) -> Self {
        Self(matrix, PhantomData)
    }

    /// The matrix.
    #[must_use]
    pub const fn as_matrix(&self) -> &SMatrix<T, N, N> {
        &self.0
    }
}

impl<K: Generators<N, D>, T: RealField + Copy, const N: usize, const D: usize> TryFrom<SMatrix<T, N, N>>
    for MatrixGroup<K, T, N, D>
{
    type Error = NotInGroup;

    /// Accepts a matrix that satisfies the relation to 10⁴ roundings, so that one printed to a dozen digits passes.
    fn try_from(matrix: SMatrix<T, N, N>) -> Result<Self, NotInGroup> {
        let candidate = Self::from_matrix_unchecked(matrix);
        let defect = candidate.defect();
        if defect < T::default_epsilon() * real(1e4) {
            Ok(candidate)
        } else {
            Err(NotInGroup { defect: reported(defect) })
        }
    }
}

impl<K: Generators<N, D>, T: Real, const N: usize, const D: usize> MatrixGroup<K, T, N, D> {
    const SQUARED_LENGTHS: [f64; D] = squared_lengths(&K::GENERATORS);
    const ENTRIES: [NonZero<N>; D] = nonzero_entries(&K::GENERATORS);
    /// The nonzero entries of the dual basis; none if the basis is orthogonal.
    const DUAL: Option<[NonZero<N>; D]> =
        if is_orthogonal(&K::GENERATORS) { None } else { Some(nonzero_entries(&dual(&K::GENERATORS))) };
    const STRUCTURE: [[[f64; D]; D]; D] = structure_constants(&K::GENERATORS);
    /// The size of the rotations of a group of rigid motions.
    pub(super) const ROTATIONS: Option<usize> = rigid::size_of(&K::GENERATORS);
    /// Whether elements are multiplied by adding their differences from `I`.
    const IS_ADDED: bool = products_vanish(&K::GENERATORS);

    /// The inverse of an element, lane by lane: the group's own formula branches on entries, which differ between
    /// lanes.
    #[inline]
    fn inverse_of(matrix: &SMatrix<T, N, N>) -> SMatrix<T, N, N> {
        lane_by_lane(matrix, K::inverse::<T::Element>)
    }

    /// The residual of the relation, lane by lane.
    #[inline]
    fn relation(&self) -> T {
        lane_by_lane::<T, Vector1<T>, N>(&self.0, |lane| Vector1::new(K::relation(lane))).x
    }

    /// The pairings `tr(E_kᵀ M)` for all `k`.
    #[inline]
    fn pairings(matrix: &SMatrix<T, N, N>) -> SVector<T, D> {
        paired(&Self::ENTRIES, matrix)
    }

    /// The covector as a matrix, `Σ μ_k E^k`: for an orthogonal basis `Σ μ_k E_k / tr(E_kᵀ E_k)`.
    #[inline]
    fn dual_hat(momentum: &SVector<T, D>) -> SMatrix<T, N, N> {
        if let Some(dual) = const { &Self::DUAL } {
            return combined(dual, momentum);
        }
        Self::hat(&SVector::from_fn(|k, _| momentum[k] * real(1.0 / Self::SQUARED_LENGTHS[k])))
    }
}

/// The pairings `tr(A_kᵀ M)` with matrices by their nonzero entries.
#[inline]
fn paired<T: Real, const N: usize, const D: usize>(all: &[NonZero<N>; D], matrix: &SMatrix<T, N, N>) -> SVector<T, D> {
    SVector::from_fn(|k, _| {
        let (entries, count) = &all[k];
        let entries = entries.as_flattened().iter().take(*count);
        entries.fold(T::zero(), |sum, &(i, j, entry)| sum + matrix[(i, j)] * real(entry))
    })
}

/// The combination `Σ x_k A_k` of matrices by their nonzero entries.
#[hot]
fn combined<T: Real, const N: usize, const D: usize>(all: &[NonZero<N>; D], x: &SVector<T, D>) -> SMatrix<T, N, N> {
    let mut sum = SMatrix::zeros();
    for (k, (entries, count)) in all.iter().enumerate() {
        for &(i, j, entry) in entries.as_flattened().iter().take(*count) {
            sum[(i, j)] += x[k] * real(entry);
        }
    }
    sum
}

/// The values of a function of the matrix in each lane.
#[inline]
pub(crate) fn lane_by_lane<T: Real, V: Lanes, const N: usize>(
    matrix: &SMatrix<T, N, N>,
    of: impl Fn(&SMatrix<T::Element, N, N>) -> V::Lane,
) -> V {
    let mut all = V::splat(&of(&Lanes::lane(matrix, 0)));
    for lane in 1..T::LANES {
        // Plain numbers fit into any lane.
        let _ = all.set_lane(lane, &of(&Lanes::lane(matrix, lane)));
    }
    all
}

/// The nonzero entries with their places.
#[inline]
fn nonzero<const N: usize>(matrix: &[[f64; N]; N]) -> impl Iterator<Item = (usize, usize, f64)> {
    (0..N * N).map(|place| (place / N, place % N, matrix[place / N][place % N])).filter(|entry| entry.2 != 0.0)
}

#[hot]
impl<K: Generators<N, D>, T: Real, const N: usize, const D: usize> LieGroup for MatrixGroup<K, T, N, D> {
    type Scalar = T;
    type Vector = SVector<T, D>;
    type Matrix = SMatrix<T, N, N>;

    const DIMENSION: usize = D;
    const ROWS: usize = changed_rows(&K::GENERATORS);
    const COORDINATES: &'static [&'static str] = K::COORDINATES;

    fn identity() -> Self {
        Self::from_matrix_unchecked(SMatrix::identity())
    }

    fn compose(&self, right: &Self) -> Self {
        Self::from_matrix_unchecked(self.0 * right.0)
    }

    fn inverse(&self) -> Self {
        Self::from_matrix_unchecked(Self::inverse_of(&self.0))
    }

    fn matrix(&self) -> SMatrix<T, N, N> {
        self.0
    }

    fn from_matrix_unchecked(matrix: SMatrix<T, N, N>) -> Self {
        Self(matrix, PhantomData)
    }

    fn hat(components: &SVector<T, D>) -> SMatrix<T, N, N> {
        combined(&Self::ENTRIES, components)
    }

    /// The components of the orthogonal projection, for a matrix that isn't in the algebra.
    fn vee(matrix: &SMatrix<T, N, N>) -> SVector<T, D> {
        if let Some(dual) = const { &Self::DUAL } {
            return paired(dual, matrix);
        }
        let pairings = Self::pairings(matrix);
        SVector::from_fn(|k, _| pairings[k] * real(1.0 / Self::SQUARED_LENGTHS[k]))
    }

    fn adjoint(&self, velocity: &SVector<T, D>) -> SVector<T, D> {
        Self::vee(&(self.0 * Self::hat(velocity) * Self::inverse_of(&self.0)))
    }

    /// The components `⟨μ, F E_k F⁻¹⟩`.
    fn adjoint_transpose(&self, momentum: &SVector<T, D>) -> SVector<T, D> {
        Self::pairings(&(self.0.transpose() * Self::dual_hat(momentum) * Self::inverse_of(&self.0).transpose()))
    }

    fn lie_bracket(xi: &SVector<T, D>, eta: &SVector<T, D>) -> SVector<T, D> {
        let mut bracket = SVector::zeros();
        for (i, constants) in Self::STRUCTURE.iter().enumerate() {
            for (j, k, constant) in nonzero(constants) {
                bracket[k] += xi[i] * eta[j] * real(constant);
            }
        }
        bracket
    }

    fn lie_bracket_transpose(xi: &SVector<T, D>, momentum: &SVector<T, D>) -> SVector<T, D> {
        let mut transposed = SVector::zeros();
        for (i, constants) in Self::STRUCTURE.iter().enumerate() {
            for (j, k, constant) in nonzero(constants) {
                transposed[j] += xi[i] * momentum[k] * real(constant);
            }
        }
        transposed
    }

    fn from_increment(increment: &SMatrix<T, N, N>) -> Self {
        Self::from_matrix_unchecked(increment + SMatrix::identity())
    }

    fn increment(&self) -> SMatrix<T, N, N> {
        self.0 - SMatrix::identity()
    }

    fn inverse_increment(increment: &SMatrix<T, N, N>) -> SMatrix<T, N, N> {
        if const { Self::IS_ADDED } {
            return -increment;
        }
        if let Some(size) = const { Self::ROTATIONS } {
            return rigid::inverse_increment(size, increment);
        }
        -times(&Self::inverse_of(&(increment + SMatrix::identity())), increment, Self::ROWS)
    }

    fn change(&self, increment: &SMatrix<T, N, N>) -> SMatrix<T, N, N> {
        if const { Self::IS_ADDED } {
            return *increment;
        }
        times(&self.0, increment, Self::ROWS)
    }

    /// The components `⟨DᵀM + (M + DᵀM) Eᵀ, E_k⟩` for the covector's matrix `M`, with `F⁻¹ = I + E`, `E = −F⁻¹D`.
    fn adjoint_transpose_increment(increment: &SMatrix<T, N, N>, momentum: &SVector<T, D>) -> SVector<T, D> {
        if const { Self::IS_ADDED } {
            return SVector::zeros();
        }
        if let Some(size) = const { Self::ROTATIONS } {
            return rigid::adjoint_transpose_increment(size, increment, momentum);
        }
        let inverse_increment = Self::inverse_increment(increment);
        let covector = Self::dual_hat(momentum);
        let moved = transpose_times(increment, &covector, Self::ROWS);
        Self::pairings(&(moved + times_transpose(&(covector + moved), &inverse_increment, Self::ROWS)))
    }

    /// The components whose generators are skew.
    #[inline]
    fn turning_components() -> Vec<bool> {
        let is_skew =
            |e: &[[f64; N]; N]| (0..N * N).all(|place| e[place / N][place % N] + e[place % N][place / N] == 0.0);
        K::GENERATORS.iter().map(is_skew).collect()
    }

    /// The residual of the relation, or NaN if an entry isn't finite, whether or not the relation depends on it.
    fn defect(&self) -> T {
        self.relation() + self.0.sum() * T::zero()
    }
}

/// The generators as matrices of the scalar.
pub(crate) fn basis<K: Generators<N, D>, T: Real, const N: usize, const D: usize>(k: usize) -> SMatrix<T, N, N> {
    dynamic(&K::GENERATORS[k])
}
