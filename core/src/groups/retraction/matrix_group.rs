//! The two retractions of a group with generators.

use nalgebra::{RealField, SMatrix, SVector, SimdBool as _, Vector1, one, zero};

use super::{CayleyRetraction, ExponentialRetraction, Retraction, rigid};
use crate::groups::affine::{inverse_of_four, inverse_of_three, times};
use crate::groups::{
    Generators, LieGroup, MatrixGroup, basis, cubes, dynamic, exponential, inverse, is_closed_under_cayley,
    lane_by_lane, logarithm, products_vanish, squares,
};
use crate::numbers::{Coordinates, Mask, Real, nowhere, real};

/// The coordinates of a group: none for the Cayley map, or for a group that it leaves the numbers `c_k` with `E_k³ = c_k E_k`,
/// by which the product of the Cayley maps of all generators stays in it. A basis without them fails to compile.
struct Chart<K, const N: usize, const D: usize>(K);

impl<K: Generators<N, D>, const N: usize, const D: usize> Chart<K, N, D> {
    const CUBES: Option<[f64; D]> = if is_closed_under_cayley(&K::GENERATORS) {
        None
    } else {
        let cubes = cubes(&K::GENERATORS);
        assert!(
            cubes.is_some(),
            "the Cayley map leaves this group, and the cube of a generator isn't a multiple of it: choose generators with E³ = c E"
        );
        cubes
    };
    const SQUARES: [[[f64; N]; N]; D] = squares(&K::GENERATORS);
}

/// The increment `Π cay(2 y_k E_k) − I` for half the coordinates `y`; `tangent` gets each column `2(A E_k A⁻¹)/(1 − c y_k²)` of
/// the tangent, with the product `A` before its factor.
///
/// By `E³ = c E` a factor is `I + (2y E + 2y² E²)/(1 − c y²)`.
#[hot]
fn product<K: Generators<N, D>, T: Real, const N: usize, const D: usize>(
    cubes: &[f64; D],
    half: &SVector<T, D>,
    mut tangent: impl FnMut(usize, SVector<T, D>),
) -> SMatrix<T, N, N> {
    let one = SMatrix::<T, N, N>::identity();
    let (mut increment, mut inverse) = (SMatrix::<T, N, N>::zeros(), one);
    for k in 0..D {
        let (e, y, before) = (basis::<K, T, N, D>(k), half[k], increment + one);
        let squared = y * y;
        let two = real::<T>(2.0) / (T::one() - squared * real(cubes[k]));
        tangent(k, MatrixGroup::<K, T, N, D>::vee(&(before * e * inverse * two)));
        let (linear, square) = (e * (two * y), dynamic(&Chart::<K, N, D>::SQUARES[k]) * (two * squared));
        increment += before * (square + linear);
        inverse = (one + (square - linear)) * inverse;
    }
    increment
}

/// The inverse of `I + ŷ`. A general one is computed lane by lane, as pivots differ between lanes.
#[hot]
fn inverse_of_factor<K: Generators<N, D>, T: Real, const N: usize, const D: usize>(
    half: &SVector<T, D>,
) -> SMatrix<T, N, N> {
    let rows = const { MatrixGroup::<K, T, N, D>::ROWS };
    let matrix = SMatrix::identity() + MatrixGroup::<K, T, N, D>::hat(half);
    match (rows, N) {
        (2, 3) => inverse_of_three(&matrix),
        (3, 4) => inverse_of_four(&matrix),
        _ => lane_by_lane(&matrix, inverse::<T::Element, N>),
    }
}

/// For groups that the Cayley map leaves, like SL(3), the coordinates are those of the product of the Cayley maps of all
/// generators.
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
        if let Some(cubes) = const { &Chart::<K, N, D>::CUBES } {
            return product::<K, T, N, D>(cubes, half, |_, _| {});
        }
        if let Some(size) = const { MatrixGroup::<K, T, N, D>::ROTATIONS } {
            return rigid::increment_of_half(size, half);
        }
        let hat = MatrixGroup::<K, T, N, D>::hat(&(half + half));
        // If products vanish, `(I − ŷ)⁻¹` acts on ŷ as the identity.
        if const { products_vanish(&K::GENERATORS) } {
            return hat;
        }
        times(&inverse_of_factor::<K, T, N, D>(&-half), &hat, MatrixGroup::<K, T, N, D>::ROWS)
    }

    /// The coordinates `2 ((F + I)⁻¹ (F − I))^∨`, or those of a product by Newton's iteration.
    fn local_coordinates(element: &MatrixGroup<K, T, N, D>) -> Option<SVector<T, D>> {
        if const { Chart::<K, N, D>::CUBES.is_some() } {
            return solved(element);
        }
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
        if let Some(cubes) = const { &Chart::<K, N, D>::CUBES } {
            let mut tangent = SMatrix::<T, D, D>::zeros();
            product::<K, T, N, D>(cubes, half, |k, column| tangent.set_column(k, &column));
            return tangent;
        }
        if let Some(size) = const { MatrixGroup::<K, T, N, D>::ROTATIONS } {
            return rigid::tangent_of_half::<T, N, D>(size, half);
        }
        let [minus, plus] = [-half, *half].map(|y| inverse_of_factor::<K, T, N, D>(&y));
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

/// Limit of the iterations for coordinates; quadratic convergence takes fewer wherever it comes about.
const MOST_ITERATIONS: u32 = 50;
/// Limit of the halvings of an update.
const MOST_HALVINGS: u32 = 20;

/// The coordinates of an element by Newton's iteration from zero, `T δy = (F τ⁻¹ − I)^∨`, with updates that are halved until
/// the residual falls; none if it doesn't converge.
fn solved<K: Generators<N, D>, T: Real, const N: usize, const D: usize>(
    element: &MatrixGroup<K, T, N, D>,
) -> Option<SVector<T, D>> {
    let missed = |half: &SVector<T, D>| {
        let now: MatrixGroup<K, T, N, D> = CayleyRetraction::retract(&(half + half));
        (element.increment() - now.increment()) * now.inverse().matrix()
    };
    let size = |matrix: &SMatrix<T, N, N>| matrix.component_mul(matrix).sum();
    let (mut half, mut rest) = (SVector::<T, D>::zeros(), missed(&SVector::zeros()));
    for _ in 0..MOST_ITERATIONS {
        let tangent = <CayleyRetraction as Retraction<MatrixGroup<K, T, N, D>>>::tangent_of_half(&half);
        let mut update = SVector::<T, D>::solve(&tangent, &MatrixGroup::<K, T, N, D>::vee(&rest)).0;
        let (mut next, mut helped) = (half, nowhere::<T>());
        for _ in 0..MOST_HALVINGS {
            let candidate = half + update;
            let helps = size(&missed(&candidate)).simd_lt(size(&rest)) & !helped;
            next = Coordinates::select(candidate, helps, next);
            helped = helped | helps;
            if helped.all() {
                break;
            }
            update *= real::<T>(0.5);
        }
        let change = next - half;
        (half, rest) = (next, missed(&next));
        if change
            .component_mul(&change)
            .sum()
            .simd_le(half.component_mul(&half).sum() * T::simd_default_epsilon())
            .all()
        {
            break;
        }
    }
    // Half of the digits distinguish a solution from a residual that doesn't fall any more.
    let is_solved = size(&rest).simd_le(T::simd_default_epsilon());
    (is_solved.all() && Coordinates::is_finite(&half)).then(|| half + half)
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
