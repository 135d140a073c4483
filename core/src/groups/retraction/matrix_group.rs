//! The two retractions of a group with generators.

use nalgebra::{RealField, SMatrix, SVector, Vector1, one, zero};

use super::{CayleyRetraction, ExponentialRetraction, Retraction};
use crate::groups::affine::{inverse_by_elimination, inverse_of_four, inverse_of_three, times};
use crate::groups::{
    Generators, LieGroup, MatrixGroup, basis, exponential, inverse, is_closed_under_cayley, lane_by_lane, logarithm,
    products_vanish, rigid,
};
use crate::numbers::{Coordinates as _, Mask, Real, real};

/// A check that fails to compile for a group that the Cayley map leaves.
struct Closure<K, const N: usize, const D: usize>(K);

impl<K: Generators<N, D>, const N: usize, const D: usize> Closure<K, N, D> {
    const CHECKED: () =
        assert!(is_closed_under_cayley(&K::GENERATORS), "the Cayley map leaves this group; use ExponentialRetraction");
}

/// The inverse of `I + ŷ`. A general one is computed lane by lane, as pivots differ between lanes.
#[hot]
fn inverse_of_factor<K: Generators<N, D>, T: Real, const N: usize, const D: usize>(
    half: &SVector<T, D>,
) -> SMatrix<T, N, N> {
    let rows = const { MatrixGroup::<K, T, N, D>::ROWS };
    let matrix = match const { MatrixGroup::<K, T, N, D>::ROTATIONS } {
        Some(size) => rigid::factor(size, half),
        None => SMatrix::identity() + MatrixGroup::<K, T, N, D>::hat(half),
    };
    match (rows, N) {
        (2, 3) => inverse_of_three(&matrix),
        (3, 4) => inverse_of_four(&matrix),
        (_, 5..) if const { MatrixGroup::<K, T, N, D>::ROTATIONS.is_some() } => inverse_by_elimination(&matrix, rows),
        _ => lane_by_lane(&matrix, inverse::<T::Element, N>),
    }
}

/// The Cayley map compiles for groups that it doesn't leave; it is an error for others, like SL(3).
impl<K: Generators<N, D>, T: Real, const N: usize, const D: usize> Retraction<MatrixGroup<K, T, N, D>>
    for CayleyRetraction
{
    /// The increment `D = (I − ξ̂/2)⁻¹ ξ̂`.
    #[hot]
    fn increment(xi: &SVector<T, D>) -> SMatrix<T, N, N> {
        <Self as Retraction<MatrixGroup<K, T, N, D>>>::increment_of_half(&(xi * real::<T>(0.5)))
    }

    /// The increment `D = (I − ŷ)⁻¹ 2ŷ`.
    #[hot]
    fn increment_of_half(half: &SVector<T, D>) -> SMatrix<T, N, N> {
        let () = Closure::<K, N, D>::CHECKED;
        let hat = MatrixGroup::<K, T, N, D>::hat(&(half + half));
        // If products vanish, `(I − ŷ)⁻¹` acts on ŷ as the identity.
        if const { products_vanish(&K::GENERATORS) } {
            return hat;
        }
        times(&inverse_of_factor::<K, T, N, D>(&-half), &hat, MatrixGroup::<K, T, N, D>::ROWS)
    }

    /// The coordinates `2 ((F + I)⁻¹ (F − I))^∨`.
    fn local_coordinates(element: &MatrixGroup<K, T, N, D>) -> Option<SVector<T, D>> {
        let sum = element.matrix() + SMatrix::identity();
        let sum_inverse: SMatrix<T, N, N> = lane_by_lane(&sum, inverse::<T::Element, N>);
        let xi = MatrixGroup::<K, T, N, D>::vee(&(sum_inverse * element.increment())) * real::<T>(2.0);
        xi.is_finite().then_some(xi)
    }

    fn tangent(xi: &SVector<T, D>) -> SMatrix<T, D, D> {
        <Self as Retraction<MatrixGroup<K, T, N, D>>>::tangent_of_half(&(xi * real::<T>(0.5))) * real::<T>(0.5)
    }

    /// The tangent with the columns `2 ((I − ŷ)⁻¹ E_j (I + ŷ)⁻¹)^∨`.
    #[hot]
    fn tangent_of_half(half: &SVector<T, D>) -> SMatrix<T, D, D> {
        if const { products_vanish(&K::GENERATORS) } {
            return SMatrix::from_diagonal_element(real(2.0));
        }
        let [minus, plus] = [-half, *half].map(|y| inverse_of_factor::<K, T, N, D>(&y));
        if let Some(size) = const { MatrixGroup::<K, T, N, D>::ROTATIONS } {
            return rigid::tangent_of_half(size, &minus, &plus);
        }
        let mut tangent = SMatrix::<T, D, D>::zeros();
        for j in 0..D {
            let moved = minus * basis::<K, T, N, D>(j) * plus;
            tangent.set_column(j, &(MatrixGroup::<K, T, N, D>::vee(&moved) * real::<T>(2.0)));
        }
        tangent
    }

    #[hot]
    fn in_coordinates(jacobian: &SMatrix<T, D, D>, half: &SVector<T, D>) -> SMatrix<T, D, D> {
        let tangent = <Self as Retraction<MatrixGroup<K, T, N, D>>>::tangent_of_half(half);
        if let Some(size) = const { MatrixGroup::<K, T, N, D>::ROTATIONS } {
            return rigid::times_tangent::<T, N, D>(size, jacobian, &tangent);
        }
        jacobian * tangent
    }

    /// The group's own criterion takes one lane at a time.
    #[hot]
    fn is_near(xi: &SVector<T, D>, times: f64) -> Mask<T> {
        let far = lane_by_lane::<T, Vector1<T>, N>(&MatrixGroup::<K, T, N, D>::hat(&(xi * real::<T>(times))), |lane| {
            Vector1::new(if K::is_near_identity(lane) { zero() } else { one() })
        });
        far.x.simd_eq(T::zero())
    }
}

impl<K: Generators<N, D>, T: RealField + Copy, const N: usize, const D: usize> Retraction<MatrixGroup<K, T, N, D>>
    for ExponentialRetraction
{
    fn increment(xi: &SVector<T, D>) -> SMatrix<T, N, N> {
        exponential(&MatrixGroup::<K, T, N, D>::hat(xi)).0
    }

    /// The principal logarithm, if its exponential is `F`.
    fn local_coordinates(element: &MatrixGroup<K, T, N, D>) -> Option<SVector<T, D>> {
        let xi = MatrixGroup::<K, T, N, D>::vee(&logarithm(&element.increment()));
        let missed = <Self as Retraction<MatrixGroup<K, T, N, D>>>::increment(&xi) - element.increment();
        // Half of the digits distinguish a logarithm from a divergent series.
        (missed.norm() <= T::default_epsilon().sqrt() * element.matrix().norm()).then_some(xi)
    }

    /// The tangent `T = Σ ad_ξ^k / (k + 1)!`.
    fn tangent(xi: &SVector<T, D>) -> SMatrix<T, D, D> {
        let mut bracket = SMatrix::<T, D, D>::zeros();
        for j in 0..D {
            let mut unit = SVector::zeros();
            unit[j] = T::one();
            bracket.set_column(j, &MatrixGroup::<K, T, N, D>::lie_bracket(xi, &unit));
        }
        exponential(&bracket).1
    }

    fn is_near(xi: &SVector<T, D>, times: f64) -> Mask<T> {
        K::is_near_identity(&MatrixGroup::<K, T, N, D>::hat(&(xi * real::<T>(times))))
    }
}
