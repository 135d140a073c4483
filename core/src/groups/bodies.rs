//! Arrays of equal groups, for many bodies.

use alloc::vec::Vec;
use core::array::from_fn;

use super::{Advected, CayleyRetraction, ExponentialRetraction, Factor, LieGroup, Retraction, SquareOf, layout};
use crate::numbers::{BlockDiagonal, Blocks, Bodies, Coordinates, Join, Mask, filled, nowhere};
use nalgebra::SimdBool as _;

/// Zero increments of all bodies.
#[hot]
fn zero<G: LieGroup, const N: usize>() -> [G::Matrix; N] {
    [crate::numbers::zero::<G::Scalar, G::Matrix>(); N]
}

/// The functions act body by body; the [pattern](LieGroup::FACTORS) is that of one body.
#[hot]
impl<G: LieGroup, const N: usize> LieGroup for [G; N] {
    type Scalar = G::Scalar;
    type Vector = Bodies<G::Vector, N>;
    type Matrix = [G::Matrix; N];

    const DIMENSION: usize = N * G::DIMENSION;
    const FACTORS: Blocks = G::FACTORS;
    const BODIES: usize = N * G::BODIES;
    const ATTITUDES: usize = N * G::ATTITUDES;

    fn identity() -> Self {
        [G::identity(); N]
    }

    fn compose(&self, right: &Self) -> Self {
        filled!(*self, |k| self[k].compose(&right[k]))
    }

    fn inverse(&self) -> Self {
        filled!(*self, |k| self[k].inverse())
    }

    fn matrix(&self) -> Self::Matrix {
        filled!(zero::<G, N>(), |k| self[k].matrix())
    }

    fn from_matrix_unchecked(matrix: Self::Matrix) -> Self {
        filled!([G::identity(); N], |k| G::from_matrix_unchecked(matrix[k]))
    }

    fn hat(components: &Self::Vector) -> Self::Matrix {
        filled!(zero::<G, N>(), |k| G::hat(&components.0[k]))
    }

    fn vee(matrix: &Self::Matrix) -> Self::Vector {
        Bodies(filled!([G::Vector::zero(); N], |k| G::vee(&matrix[k])))
    }

    fn adjoint(&self, velocity: &Self::Vector) -> Self::Vector {
        Bodies(filled!(velocity.0, |k| self[k].adjoint(&velocity.0[k])))
    }

    fn adjoint_transpose(&self, momentum: &Self::Vector) -> Self::Vector {
        Bodies(filled!(momentum.0, |k| self[k].adjoint_transpose(&momentum.0[k])))
    }

    fn lie_bracket(xi: &Self::Vector, eta: &Self::Vector) -> Self::Vector {
        Bodies(filled!(xi.0, |k| G::lie_bracket(&xi.0[k], &eta.0[k])))
    }

    fn lie_bracket_transpose(xi: &Self::Vector, momentum: &Self::Vector) -> Self::Vector {
        Bodies(filled!(xi.0, |k| G::lie_bracket_transpose(&xi.0[k], &momentum.0[k])))
    }

    fn from_increment(increment: &Self::Matrix) -> Self {
        filled!([G::identity(); N], |k| G::from_increment(&increment[k]))
    }

    fn increment(&self) -> Self::Matrix {
        filled!(zero::<G, N>(), |k| self[k].increment())
    }

    fn inverse_increment(increment: &Self::Matrix) -> Self::Matrix {
        filled!(*increment, |k| G::inverse_increment(&increment[k]))
    }

    fn change(&self, increment: &Self::Matrix) -> Self::Matrix {
        filled!(*increment, |k| self[k].change(&increment[k]))
    }

    fn advance(&self, increment: &Self::Matrix) -> Self {
        filled!(*self, |k| self[k].advance(&increment[k]))
    }

    fn adjoint_transpose_increment(increment: &Self::Matrix, momentum: &Self::Vector) -> Self::Vector {
        Bodies(filled!(momentum.0, |k| G::adjoint_transpose_increment(&increment[k], &momentum.0[k])))
    }

    fn factors() -> Vec<layout::Factor> {
        (1..=N).flat_map(|place| G::factors().into_iter().map(move |factor| factor.at(place))).collect()
    }

    fn write_numbers<'a>(&self, numbers: &'a mut [G::Scalar]) -> &'a mut [G::Scalar] {
        self.iter().fold(numbers, |numbers, body| body.write_numbers(numbers))
    }

    fn turning_components() -> Vec<bool> {
        G::turning_components().repeat(N)
    }

    /// The sum of the bodies' defects.
    fn defect(&self) -> G::Scalar {
        self.iter().fold(nalgebra::zero(), |sum, body| sum + body.defect())
    }

    #[cold]
    fn restored(&self, beyond: f64) -> Option<(Self, Mask<G::Scalar>)> {
        let (mut elements, mut far) = (*self, nowhere::<G::Scalar>());
        for element in &mut elements {
            if let Some((restored, lanes)) = element.restored(beyond) {
                *element = restored;
                far = far | lanes;
            }
        }
        far.any().then_some((elements, far))
    }
}

/// Implements a retraction body by body.
macro_rules! retraction_of_bodies {
    ($retraction:ident) => {
        impl<G: LieGroup, const N: usize> Retraction<[G; N]> for $retraction
        where
            $retraction: Retraction<G>,
        {
            #[hot]
            fn increment(xi: &Bodies<G::Vector, N>) -> [G::Matrix; N] {
                filled!(zero::<G, N>(), |k| <Self as Retraction<G>>::increment(&xi.0[k]))
            }

            #[hot]
            fn increment_of_half(half: &Bodies<G::Vector, N>) -> [G::Matrix; N] {
                filled!(zero::<G, N>(), |k| <Self as Retraction<G>>::increment_of_half(&half.0[k]))
            }

            fn local_coordinates(element: &[G; N]) -> Option<Bodies<G::Vector, N>> {
                let mut coordinates = Bodies::zero();
                for (of_body, body) in coordinates.0.iter_mut().zip(element) {
                    *of_body = <Self as Retraction<G>>::local_coordinates(body)?;
                }
                Some(coordinates)
            }

            fn tangent(xi: &Bodies<G::Vector, N>) -> BlockDiagonal<<G::Vector as Coordinates<G::Scalar>>::Square, N> {
                BlockDiagonal(from_fn(|k| <Self as Retraction<G>>::tangent(&xi.0[k])))
            }

            #[hot]
            fn is_near(coordinates: &Bodies<G::Vector, N>, times: f64) -> Mask<G::Scalar> {
                let mut near = !nowhere::<G::Scalar>();
                for body in &coordinates.0 {
                    near = near & <Self as Retraction<G>>::is_near(body, times);
                }
                near
            }
        }
    };
}

retraction_of_bodies!(CayleyRetraction);
retraction_of_bodies!(ExponentialRetraction);

/// The body `K`, counted from zero.
#[hot]
impl<G: LieGroup, const K: usize, const N: usize> Factor<K> for [G; N] {
    type Of = G;

    fn factor(&self) -> G {
        const { assert!(K < N, "there is no body with this number: they are counted from zero") };
        self[K]
    }

    fn of_matrix(matrix: &[G::Matrix; N]) -> G::Matrix {
        const { assert!(K < N, "there is no body with this number: they are counted from zero") };
        matrix[K]
    }

    fn components(joined: &Bodies<G::Vector, N>) -> G::Vector {
        const { assert!(K < N, "there is no body with this number: they are counted from zero") };
        joined.0[K]
    }
}

/// Parameters of each body, in its own frame.
#[hot]
impl<G: LieGroup, W: Advected<G>, const N: usize> Advected<[G; N]> for [W; N] {
    fn seen_from(&self, attitude: &[G; N]) -> Self {
        filled!(*self, |k| self[k].seen_from(&attitude[k]))
    }

    fn change(&self, increment: &[G::Matrix; N]) -> Self {
        filled!(*self, |k| self[k].change(&increment[k]))
    }

    fn advect(&self, increment: &[G::Matrix; N]) -> Self {
        filled!(*self, |k| self[k].advect(&increment[k]))
    }

    fn rate(&self, velocity: &[G::Matrix; N]) -> Self {
        filled!(*self, |k| self[k].rate(&velocity[k]))
    }

    fn seen_through(&self, matrix: &[G::Matrix; N], inverse: &[G::Matrix; N]) -> Self {
        filled!(*self, |k| self[k].seen_through(&matrix[k], &inverse[k]))
    }
}

/// The product of two equal groups for a declaration on two bodies: `(G, G)`, or `(A, B, A, B)` if each body is the
/// product `(A, B)`.
#[diagnostic::on_unimplemented(
    message = "a term on `{Self}` isn't one on two bodies",
    label = "not declared on two bodies",
    note = "put at two bodies is what is declared on two: `group(F_1 = SO3, F_2 = SO3)`, or `group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3)` where each is translated, too",
    note = "a term on one body is put at bodies by `Each::<N>::of` or `On::<K, N>::of`"
)]
pub trait Pair: LieGroup {
    /// The group of one body.
    type Body: LieGroup<Scalar = Self::Scalar>;

    /// The element for two bodies.
    fn pair(first: &Self::Body, second: &Self::Body) -> Self;

    /// The matrix for two bodies.
    fn matrices(first: &<Self::Body as LieGroup>::Matrix, second: &<Self::Body as LieGroup>::Matrix) -> Self::Matrix;

    /// The components of each body.
    fn parts(joined: &Self::Vector) -> [<Self::Body as LieGroup>::Vector; 2];

    /// The components of both bodies.
    fn joined(first: &<Self::Body as LieGroup>::Vector, second: &<Self::Body as LieGroup>::Vector) -> Self::Vector;

    /// The four blocks of a matrix of both bodies, row by row.
    fn blocks(matrix: &SquareOf<Self>) -> [[SquareOf<Self::Body>; 2]; 2];
}

#[hot]
impl<G: LieGroup> Pair for (G, G)
where
    (G, G): LieGroup<Scalar = G::Scalar, Matrix = (G::Matrix, G::Matrix), Vector = JoinedVector<G>>,
    G::Vector: Join<G::Scalar, G::Vector>,
{
    type Body = G;

    fn pair(first: &G, second: &G) -> Self {
        (*first, *second)
    }

    fn matrices(first: &G::Matrix, second: &G::Matrix) -> Self::Matrix {
        (*first, *second)
    }

    fn parts(joined: &Self::Vector) -> [G::Vector; 2] {
        G::Vector::split(joined).into()
    }

    fn joined(first: &G::Vector, second: &G::Vector) -> Self::Vector {
        first.join(second)
    }

    fn blocks(matrix: &SquareOf<Self>) -> [[SquareOf<G>; 2]; 2] {
        G::Vector::blocks(matrix)
    }
}

/// The components of two bodies.
type JoinedVector<G> = <<G as LieGroup>::Vector as Join<<G as LieGroup>::Scalar, <G as LieGroup>::Vector>>::Joined;

#[hot]
impl<A, B> Pair for (A, B, A, B)
where
    A: LieGroup,
    B: LieGroup<Scalar = A::Scalar>,
    (A, B): LieGroup<Scalar = A::Scalar, Matrix = (A::Matrix, B::Matrix)> + Factor<0, Of = A> + Factor<1, Of = B>,
    A::Vector: Join<A::Scalar, B::Vector, Joined = <(A, B) as LieGroup>::Vector>,
    <(A, B) as LieGroup>::Vector: Join<A::Scalar, <(A, B) as LieGroup>::Vector>,
    Self: LieGroup<
            Scalar = A::Scalar,
            Matrix = (A::Matrix, B::Matrix, A::Matrix, B::Matrix),
            Vector = JoinedVector<(A, B)>,
        >,
{
    type Body = (A, B);

    fn pair(first: &(A, B), second: &(A, B)) -> Self {
        (first.0, first.1, second.0, second.1)
    }

    fn matrices(first: &(A::Matrix, B::Matrix), second: &(A::Matrix, B::Matrix)) -> Self::Matrix {
        (first.0, first.1, second.0, second.1)
    }

    fn parts(joined: &Self::Vector) -> [<(A, B) as LieGroup>::Vector; 2] {
        <(A, B) as LieGroup>::Vector::split(joined).into()
    }

    fn joined(first: &<(A, B) as LieGroup>::Vector, second: &<(A, B) as LieGroup>::Vector) -> Self::Vector {
        first.join(second)
    }

    fn blocks(matrix: &SquareOf<Self>) -> [[SquareOf<(A, B)>; 2]; 2] {
        <(A, B) as LieGroup>::Vector::blocks(matrix)
    }
}

#[cfg(test)]
mod tests {
    use super::Pair as _;
    use crate::groups::{LieGroup, R3, SO3};
    use nalgebra::{SVector, Vector3, Vector6};

    type Body = (SO3, R3);

    /// The components in a declaration on two bodies have the order of those in a system of them.
    #[test]
    fn two_bodies_are_put_together_and_taken_apart() {
        let joined = SVector::<f64, 12>::from_fn(|k, _| f64::from(u8::try_from(k).unwrap()));
        let [first, second] = <(SO3, R3, SO3, R3)>::parts(&joined);
        assert_eq!((first[0], first[5], second[0]), (0.0, 5.0, 6.0));
        assert_eq!(<(SO3, R3, SO3, R3)>::joined(&first, &second), joined);
        let element = <Body as LieGroup>::identity();
        assert_eq!(<(SO3, R3, SO3, R3)>::pair(&element, &element), LieGroup::identity());
        let halves = <(SO3, SO3)>::parts(&Vector6::new(1.0, 2.0, 3.0, 4.0, 5.0, 6.0));
        assert_eq!(halves[1], Vector3::new(4.0, 5.0, 6.0));
    }
}
