//! Components of many equal bodies, and the block-diagonal matrices that act on them.

use core::array::from_fn;
use core::ops::{Add, Mul, Neg, Sub};

use super::blocks::{Blocks, Pattern};
use super::coordinates::{Coordinates, lesser_pivot};
use super::entries::{Entries, entries_of_value};
use super::scalar::{Mask, Real, real};

/// The components of `N` equal bodies, one after the other.
#[derive(Clone, Copy, Debug, PartialEq, Lanes)]
pub struct Bodies<V, const N: usize>(pub [V; N]);

/// A linear map that acts on each of the [`Bodies`] separately: a block-diagonal matrix.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlockDiagonal<S, const N: usize>(pub [S; N]);

/// An array with a new entry for each body, written over an array that is full already. It is a macro because code that
/// isn't inlined can't use the machine's vector instructions: the compiler doesn't always inline
/// `core::array::from_fn`, which copies besides, nor the closure that a function would take.
macro_rules! filled {
    ($array:expr, |$k:ident| $of:expr $(,)?) => {{
        let mut array = $array;
        for ($k, entry) in array.iter_mut().enumerate() {
            *entry = $of;
        }
        array
    }};
}

pub(crate) use filled;

operation!([V: Copy + Add<Output = V>, const N: usize] Bodies<V, N>, Add add |a, b| Self(filled!(a.0, |k| a.0[k] + b.0[k])));

operation!([V: Copy + Sub<Output = V>, const N: usize] Bodies<V, N>, Sub sub |a, b| Self(filled!(a.0, |k| a.0[k] - b.0[k])));

impl<V: Copy + Neg<Output = V>, const N: usize> Neg for Bodies<V, N> {
    type Output = Self;

    #[hot]
    fn neg(self) -> Self {
        Self(filled!(self.0, |k| -self.0[k]))
    }
}

impl<T: Real, V: Copy + Mul<T, Output = V>, const N: usize> Mul<T> for Bodies<V, N> {
    type Output = Self;

    #[hot]
    fn mul(self, factor: T) -> Self {
        Self(filled!(self.0, |k| self.0[k] * factor))
    }
}

operation!([S: Copy + Add<Output = S>, const N: usize] BlockDiagonal<S, N>, Add add |a, b| Self(filled!(a.0, |k| a.0[k] + b.0[k])));

impl<T: Real, S: Copy + Mul<T, Output = S>, const N: usize> Mul<T> for BlockDiagonal<S, N> {
    type Output = Self;

    #[hot]
    fn mul(self, factor: T) -> Self {
        Self(filled!(self.0, |k| self.0[k] * factor))
    }
}

impl<V: Copy, S: Copy + Mul<V, Output = V>, const N: usize> Mul<Bodies<V, N>> for BlockDiagonal<S, N> {
    type Output = Bodies<V, N>;

    #[hot]
    fn mul(self, components: Bodies<V, N>) -> Bodies<V, N> {
        Bodies(filled!(components.0, |k| self.0[k] * components.0[k]))
    }
}

#[hot]
impl<T: Real, E: Entries<T>, const N: usize> Entries<T> for [E; N] {
    fn from_entries(next: &mut impl FnMut() -> T) -> Self {
        from_fn(|_| E::from_entries(next))
    }

    fn each(&self, visit: &mut impl FnMut(T)) {
        for body in self {
            body.each(visit);
        }
    }

    fn zip(&self, other: &Self, combine: &mut impl FnMut(T, T) -> T) -> Self {
        filled!(*self, |k| self[k].zip(&other[k], combine))
    }
}

entries_of_value!([E: Entries<S>, const N: usize] Bodies<E, N>);

/// Number of components.
#[hot]
fn dimension<T: Real, V: Coordinates<T>>() -> usize {
    let mut dimension = 0;
    V::zero().each(&mut |_| dimension += 1);
    dimension
}

/// The lesser of two numbers; a NaN in either is returned.
#[hot]
pub(crate) fn least<T: Real>(a: T, b: T) -> T {
    b.select(b.simd_lt(a) | b.simd_ne(b), a)
}

/// Infinity, the initial value of a minimum.
#[hot]
pub(crate) fn most<T: Real>() -> T {
    real(f64::INFINITY)
}

/// Bodies are independent: each operation acts body by body. A determinant is the least of those of the bodies, each
/// relative to the product of its diagonal: the product of a hundred would be out of range, and two negative ones would
/// cancel.
///
/// `a bᵀ` lacks the blocks that couple bodies, so it is the outer product only where they aren't needed.
#[hot]
impl<T: Real, V: Coordinates<T>, const N: usize> Coordinates<T> for Bodies<V, N> {
    type Square = BlockDiagonal<V::Square, N>;
    /// For each body but the last, the block of its rows and the next body's columns, and the block below the diagonal.
    type Links = [[V::Square; 2]; N];
    type Four = Bodies<V::Four, N>;

    fn beside(columns: &[Self; 4]) -> Self::Four {
        Bodies(from_fn(|body| V::beside(&from_fn(|k| columns[k].0[body]))))
    }

    fn of_four(four: &Self::Four, k: usize) -> Self {
        Self(from_fn(|body| V::of_four(&four.0[body], k)))
    }

    fn map_four(matrix: &Self::Square, four: &Self::Four) -> Self::Four {
        Bodies(filled!(four.0, |body| V::map_four(&matrix.0[body], &four.0[body])))
    }

    fn square(column: impl Fn(usize) -> Self) -> Self::Square {
        let dimension = dimension::<T, V>();
        BlockDiagonal(from_fn(|body| V::square(|k| column(body * dimension + k).0[body])))
    }

    #[inline]
    fn column(matrix: &Self::Square, k: usize) -> Self {
        let dimension = dimension::<T, V>();
        let mut column = Self::zero();
        column.0[k / dimension] = V::column(&matrix.0[k / dimension], k % dimension);
        column
    }

    fn zero() -> Self {
        Self([V::zero(); N])
    }

    #[inline]
    fn axis(k: usize) -> Self {
        let dimension = dimension::<T, V>();
        let mut axis = Self::zero();
        axis.0[k / dimension] = V::axis(k % dimension);
        axis
    }

    fn dot(&self, other: &Self) -> T {
        let mut sum = T::zero();
        for k in 0..N {
            sum += self.0[k].dot(&other.0[k]);
        }
        sum
    }

    fn outer(&self, other: &Self) -> Self::Square {
        BlockDiagonal(from_fn(|k| self.0[k].outer(&other.0[k])))
    }

    fn is_finite(&self) -> bool {
        self.0.iter().all(V::is_finite)
    }

    fn select(self, mask: Mask<T>, other: Self) -> Self {
        Self(filled!(self.0, |k| self.0[k].select(mask, other.0[k])))
    }

    fn factorise_with(matrix: &Self::Square, pattern: Pattern) -> (Self::Square, T) {
        Self::factorise_apart(matrix, pattern)
    }

    fn solve_again_with(factors: &Self::Square, _: T, pattern: Pattern, right_side: &Self) -> Self {
        Self::solve_apart(factors, pattern, right_side)
    }

    fn inverse_with(factors: &Self::Square, _: T, pattern: Pattern) -> Self::Square {
        let of_body = |factors| V::square(|k| V::solve_apart(factors, pattern, &V::axis(k)));
        BlockDiagonal(filled!(factors.0, |body| of_body(&factors.0[body])))
    }

    /// The pattern is that of one body.
    fn factorise_apart(matrix: &Self::Square, pattern: Pattern) -> (Self::Square, T) {
        let (mut factors, mut smallest) = (*matrix, most());
        for k in 0..N {
            let (of_body, det) = V::factorise_apart(&matrix.0[k], pattern);
            factors.0[k] = of_body;
            smallest = least(smallest, det);
        }
        (factors, smallest)
    }

    fn solve_apart(factors: &Self::Square, pattern: Pattern, right_side: &Self) -> Self {
        Self(filled!(right_side.0, |k| V::solve_apart(&factors.0[k], pattern, &right_side.0[k])))
    }

    fn no_links() -> Self::Links {
        let zero = V::zero();
        [[zero.outer(&zero); 2]; N]
    }

    fn add_links(links: &mut Self::Links, others: &Self::Links, power: u32, half: &Self) {
        let zero = V::zero();
        // A pair of links has a block in the row of this body and one in the row of the next.
        let raised = |block: &V::Square, body: usize| V::raised(&zero, block, power, &half.0[body]).1;
        for (k, (links, [upper, lower])) in links.iter_mut().zip(others).enumerate().take(N.saturating_sub(1)) {
            *links = [links[0] + raised(upper, k), links[1] + raised(lower, k + 1)];
        }
    }

    /// Solves by elimination from the first body to the last, `A_{k+1} ← A_{k+1} − L_k A_k⁻¹ U_k`.
    fn solve_linked(matrix: &mut Self::Square, links: &Self::Links, pattern: Pattern, right_side: &mut Self) -> T {
        let pattern = Pattern { apart: Blocks::WHOLE, ..pattern };
        let (BlockDiagonal(own), Bodies(solution), mut smallest) = (matrix, right_side, most());
        for k in 0..N {
            let (factors, det) = V::factorise_apart(&own[k], pattern);
            smallest = least(smallest, det);
            solution[k] = V::solve_apart(&factors, pattern, &solution[k]);
            if k + 1 == N {
                break;
            }
            let [upper, lower] = &links[k];
            // The back substitution needs `A_k⁻¹ U_k` alone.
            let eliminated = V::square(
                #[cfg_attr(not(debug_assertions), inline(always))]
                |column| V::solve_apart(&factors, pattern, &V::column(upper, column)),
            );
            let taken = V::square(
                #[cfg_attr(not(debug_assertions), inline(always))]
                |column| *lower * V::column(&eliminated, column),
            );
            own[k] = eliminated;
            own[k + 1] = own[k + 1] + taken * real::<T>(-1.0);
            solution[k + 1] = solution[k + 1] - *lower * solution[k];
        }
        for k in (1..N).rev() {
            solution[k - 1] = solution[k - 1] - own[k - 1] * solution[k];
        }
        smallest
    }

    fn least_trace(matrix: &Self::Square, blocks: Blocks) -> T {
        matrix.0.iter().fold(most(), |smallest, body| least(smallest, V::least_trace(body, blocks)))
    }

    fn times_blocks(a: &Self::Square, b: &Self::Square, blocks: Blocks) -> Self::Square {
        BlockDiagonal(filled!(a.0, |k| V::times_blocks(&a.0[k], &b.0[k], blocks)))
    }

    fn trace(matrix: &Self::Square) -> T {
        matrix.0.iter().fold(T::zero(), |sum, body| sum + V::trace(body))
    }

    fn transpose(matrix: &Self::Square) -> Self::Square {
        BlockDiagonal(filled!(matrix.0, |k| V::transpose(&matrix.0[k])))
    }

    #[inline]
    fn least_pivot(matrix: &Self::Square) -> (T, usize) {
        let dimension = dimension::<T, V>();
        let of_bodies = matrix.0.iter().enumerate().map(|(body, square)| {
            let (pivot, component) = V::least_pivot(square);
            (pivot, body * dimension + component)
        });
        of_bodies.fold((most(), 0), lesser_pivot)
    }

    fn raised(residual: &Self, jacobian: &Self::Square, power: u32, half: &Self) -> (Self, Self::Square) {
        let mut raised = (*residual, *jacobian);
        for k in 0..N {
            (raised.0.0[k], raised.1.0[k]) = V::raised(&residual.0[k], &jacobian.0[k], power, &half.0[k]);
        }
        raised
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix2, Matrix6, SMatrix, SVector, SimdValue as _, Vector2, Vector6};
    use simba::simd::WideF64x4;

    use super::{BlockDiagonal, Blocks, Bodies, Coordinates as _, Pattern};
    use crate::laws::samples::Random;

    /// Factors of a body with three rotations and three translations.
    const PATTERN: Pattern = Pattern { factors: Blocks::WHOLE.then(3, Blocks::WHOLE), apart: Blocks::WHOLE };

    /// The least pivot in a batch whose first lane has a zero inertia in the first body, and whose second lane a small,
    /// regular one in the second body.
    #[test]
    fn the_least_pivot_is_that_of_a_fault() {
        let lanes = |first: f64, second: f64| WideF64x4::from([first, second, second, second]);
        let body = |none: WideF64x4, beside: WideF64x4| {
            let one = lanes(1.0, 1.0);
            Matrix2::new(none, beside, beside, one)
        };
        let bodies = BlockDiagonal([body(lanes(0.0, 1.0), lanes(0.0, 0.0)), body(lanes(1.0, 1.0), lanes(0.0, 0.9))]);
        let (pivot, component) = Bodies::<Vector2<WideF64x4>, 2>::least_pivot(&bodies);
        assert!(component == 0 && pivot.extract(0).is_nan() && pivot.extract(1) > 0.0, "{component}");
    }

    #[test]
    fn a_row_is_solved_as_the_whole_matrix() {
        let mut random = Random::new(7);
        let mut block =
            |diagonal: f64| Matrix6::<f64>::from_fn(|i, j| random.signed() + if i == j { diagonal } else { 0.0 });
        let (matrix, links) = ([(); 3].map(|()| block(9.0)), [(); 3].map(|()| [block(0.0), block(0.0)]));
        let mut dense = SMatrix::<f64, 18, 18>::zeros();
        for (k, own) in matrix.iter().enumerate() {
            dense.fixed_view_mut::<6, 6>(6 * k, 6 * k).copy_from(own);
        }
        // The last body has no successor.
        for (k, [upper, lower]) in links.iter().enumerate().take(2) {
            dense.fixed_view_mut::<6, 6>(6 * k, 6 * k + 6).copy_from(upper);
            dense.fixed_view_mut::<6, 6>(6 * k + 6, 6 * k).copy_from(lower);
        }
        let right_side = SVector::<f64, 18>::from_fn(|k, _| [1.0, -2.0, 0.5, 3.0][k % 4]);
        let mut solution = Bodies([0, 6, 12].map(|start| right_side.fixed_rows::<6>(start).into_owned()));
        let det = Bodies::solve_linked(&mut BlockDiagonal(matrix), &links, PATTERN, &mut solution);
        let expected = dense.lu().solve(&right_side).unwrap();
        for (k, own) in solution.0.iter().enumerate() {
            let off = (own - expected.fixed_rows::<6>(6 * k)).amax();
            assert!(off < 1e-13 * expected.amax(), "{k}: {off:e}");
        }
        assert!(det > 0.0);
    }

    /// A negative determinant of the rotations and one of the translations don't cancel.
    #[test]
    fn two_negative_factors_of_a_body_show() {
        let negative = Matrix6::from_diagonal(&Vector6::new(1.0, 2.0, -1.0, 1.0, -3.0, 1.0));
        let mut matrix = BlockDiagonal([Matrix6::identity(), negative]);
        let links = Bodies::<Vector6<f64>, 2>::no_links();
        let right_side = Bodies([Vector6::repeat(1.0), Vector6::repeat(6.0)]);
        let mut solution = right_side;
        let det = Bodies::solve_linked(&mut matrix, &links, PATTERN, &mut solution);
        assert!((det + 1.0).abs() < 1e-15, "{det}");
        assert!((negative * solution.0[1] - right_side.0[1]).amax() < 1e-14);
    }
}
