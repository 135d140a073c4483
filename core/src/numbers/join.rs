//! Components of several bodies side by side.

use nalgebra::{Const, DimAdd, SMatrix, SVector};

use super::coordinates::Coordinates;
use super::scalar::Real;

/// Components of two algebras in one vector: those of a product of groups are those of its factors, one after the
/// other.
#[doc(hidden)]
pub trait Join<T: Real, Other: Coordinates<T>>: Coordinates<T> {
    /// The components of both.
    type Joined: Coordinates<T> + 'static;

    /// The components of both, one after the other.
    #[must_use]
    fn join(&self, other: &Other) -> Self::Joined;

    /// The two vectors of components.
    #[must_use]
    fn split(joined: &Self::Joined) -> (Self, Other);

    /// The block-diagonal map that acts on each separately.
    #[must_use]
    fn join_squares(first: &Self::Square, second: &Other::Square) -> <Self::Joined as Coordinates<T>>::Square;

    /// The four blocks of a matrix of two equal bodies, row by row.
    #[must_use]
    fn blocks(joined: &<Self::Joined as Coordinates<T>>::Square) -> [[Self::Square; 2]; 2];
}

impl<T: Real, const A: usize, const B: usize, const C: usize> Join<T, SVector<T, B>> for SVector<T, A>
where
    Const<A>: DimAdd<Const<B>, Output = Const<C>>,
{
    type Joined = SVector<T, C>;

    #[hot]
    fn join(&self, other: &SVector<T, B>) -> SVector<T, C> {
        let mut joined = SVector::<T, C>::zeros();
        for k in 0..A {
            joined[k] = self[k];
        }
        for k in 0..B {
            joined[A + k] = other[k];
        }
        joined
    }

    #[hot]
    fn split(joined: &SVector<T, C>) -> (Self, SVector<T, B>) {
        let (mut first, mut second) = (Self::zeros(), SVector::<T, B>::zeros());
        for k in 0..A {
            first[k] = joined[k];
        }
        for k in 0..B {
            second[k] = joined[A + k];
        }
        (first, second)
    }

    fn join_squares(first: &SMatrix<T, A, A>, second: &SMatrix<T, B, B>) -> SMatrix<T, C, C> {
        SMatrix::from_fn(|i, j| match (i < A, j < A) {
            (true, true) => first[(i, j)],
            (false, false) => second[(i - A, j - A)],
            _ => T::zero(),
        })
    }

    #[hot]
    fn blocks(joined: &SMatrix<T, C, C>) -> [[SMatrix<T, A, A>; 2]; 2] {
        const { assert!(A == B, "blocks are those of two bodies of equal size") }
        let block = |row: usize, column: usize| joined.fixed_view::<A, A>(row, column).into_owned();
        [[block(0, 0), block(0, A)], [block(A, 0), block(A, A)]]
    }
}

#[cfg(test)]
mod tests {
    use super::Join as _;
    use nalgebra::{Matrix3, SMatrix, SVector, Vector1, Vector3};

    #[test]
    fn components_are_joined_and_taken_apart() {
        let (a, b) = (Vector3::new(1.0, 2.0, 3.0), Vector1::new(4.0));
        let joined: SVector<f64, 4> = a.join(&b);
        assert_eq!(joined.as_slice(), [1.0, 2.0, 3.0, 4.0]);
        assert_eq!(Vector3::split(&joined), (a, b));
        let squares: SMatrix<f64, 4, 4> = <Vector3<f64> as super::Join<f64, Vector1<f64>>>::join_squares(
            &(Matrix3::identity() * 2.0),
            &SMatrix::from_element(5.0),
        );
        assert_eq!(squares * joined, SVector::from([2.0, 4.0, 6.0, 20.0]));
    }
}
