//! Advected parameters of several bodies: in the frame of one of them, or its configuration.
//!
//! | parameter | spatial value | `f⁻¹ · w` |
//! |---|---|---|
//! | [`SeenFrom<A, W>`](SeenFrom) | that of `W` | by `f_A` alone |
//! | [`Relative<A, B, M>`](Relative) | `I` | `f_A⁻¹ Q f_B` |
//! | [`Configuration<B, M>`](Configuration) | `I` | `R f_B` |

use nalgebra::SMatrix;

use super::Advected;
use crate::groups::{Factor, LieGroup};
use crate::numbers::{Entries, Real, entries_of_value};

/// A parameter in the frame of the factor `A` of a product; the other factors don't act on it.
#[derive(Clone, Copy, Debug, PartialEq, Lanes)]
pub struct SeenFrom<const A: usize, W>(pub W);

/// The configuration `Q = g_A⁻¹ g_B` of the body `B` relative to the body `A`: for two bodies that turn, the matrix
/// that maps components in `B` to those in `A`. Its spatial value is the identity.
#[derive(Clone, Copy, Debug, PartialEq, Lanes)]
pub struct Relative<const A: usize, const B: usize, M>(pub M);

/// The configuration `g_B` of the body `B` in space. Its spatial value is the identity.
///
/// A Lagrangian that depends on it isn't invariant under rotations or translations of the whole in space.
#[derive(Clone, Copy, Debug, PartialEq, Lanes)]
pub struct Configuration<const B: usize, M>(pub M);

impl<const A: usize, const B: usize, T: Real, const N: usize> Default for Relative<A, B, SMatrix<T, N, N>> {
    fn default() -> Self {
        Self(SMatrix::identity())
    }
}

impl<const B: usize, T: Real, const N: usize> Default for Configuration<B, SMatrix<T, N, N>> {
    fn default() -> Self {
        Self(SMatrix::identity())
    }
}

entries_of_value!([const A: usize, W: Entries<S>] SeenFrom<A, W>);
entries_of_value!([const A: usize, const B: usize, W: Entries<S>] Relative<A, B, W>);
entries_of_value!([const B: usize, W: Entries<S>] Configuration<B, W>);

#[hot]
impl<const A: usize, G: Factor<A>, W: Advected<G::Of>> Advected<G> for SeenFrom<A, W> {
    #[inline]
    fn seen_from(&self, attitude: &G) -> Self {
        Self(self.0.seen_from(&attitude.factor()))
    }

    fn pulled_back(&self, attitude: &G) -> Self {
        Self(self.0.pulled_back(&attitude.factor()))
    }

    fn change(&self, increment: &G::Matrix) -> Self {
        Self(self.0.change(&G::of_matrix(increment)))
    }

    fn rate(&self, velocity: &G::Matrix) -> Self {
        Self(self.0.rate(&G::of_matrix(velocity)))
    }

    fn seen_through(&self, matrix: &G::Matrix, inverse: &G::Matrix) -> Self {
        Self(self.0.seen_through(&G::of_matrix(matrix), &G::of_matrix(inverse)))
    }
}

/// The matrices of the factor `K`.
type Of<G, const K: usize> = <<G as Factor<K>>::Of as LieGroup>::Matrix;

#[hot]
impl<const A: usize, const B: usize, G, T, const N: usize> Advected<G> for Relative<A, B, SMatrix<T, N, N>>
where
    T: Real,
    G: Factor<A, Of: LieGroup<Matrix = SMatrix<T, N, N>>> + Factor<B> + LieGroup<Scalar = T>,
    <G as Factor<B>>::Of: LieGroup<Matrix = Of<G, A>>,
{
    #[inline]
    fn seen_from(&self, attitude: &G) -> Self {
        let (from, to) = (Factor::<A>::factor(attitude), Factor::<B>::factor(attitude));
        Self(product(&product(&from.inverse().matrix(), &self.0), &to.matrix()))
    }

    /// The image `g_A⁻ᵀ M g_Bᵀ` of the gradient `M`.
    #[inline]
    fn pulled_back(&self, attitude: &G) -> Self {
        let (from, to) = (Factor::<A>::factor(attitude), Factor::<B>::factor(attitude));
        Self(product(&product(&from.inverse().matrix().transpose(), &self.0), &to.matrix().transpose()))
    }

    /// The change `E Q + (Q + E Q) D_B` with `E = F_A⁻¹ − I`.
    fn change(&self, increment: &G::Matrix) -> Self {
        let (from, to) = (<G as Factor<A>>::of_matrix(increment), <G as Factor<B>>::of_matrix(increment));
        let turned = product(&<G as Factor<A>>::Of::inverse_increment(&from), &self.0);
        Self(turned + product(&(self.0 + turned), &to))
    }

    /// The rate `Q ξ̂_B − ξ̂_A Q`.
    fn rate(&self, velocity: &G::Matrix) -> Self {
        let (from, to) = (<G as Factor<A>>::of_matrix(velocity), <G as Factor<B>>::of_matrix(velocity));
        Self(product(&self.0, &to) - product(&from, &self.0))
    }

    fn seen_through(&self, matrix: &G::Matrix, inverse: &G::Matrix) -> Self {
        let (from, to) = (<G as Factor<A>>::of_matrix(inverse), <G as Factor<B>>::of_matrix(matrix));
        Self(product(&product(&from, &self.0), &to))
    }
}

#[hot]
impl<const B: usize, G, T: Real, const N: usize> Advected<G> for Configuration<B, SMatrix<T, N, N>>
where
    G: Factor<B, Of: LieGroup<Matrix = SMatrix<T, N, N>>> + LieGroup<Scalar = T>,
{
    #[inline]
    fn seen_from(&self, attitude: &G) -> Self {
        Self(product(&self.0, &attitude.factor().matrix()))
    }

    /// The image `M g_Bᵀ` of the gradient `M`.
    #[inline]
    fn pulled_back(&self, attitude: &G) -> Self {
        Self(product(&self.0, &attitude.factor().matrix().transpose()))
    }

    /// The change `R D`.
    fn change(&self, increment: &G::Matrix) -> Self {
        Self(product(&self.0, &G::of_matrix(increment)))
    }

    /// The rate `R ξ̂`.
    fn rate(&self, velocity: &G::Matrix) -> Self {
        Self(product(&self.0, &G::of_matrix(velocity)))
    }

    fn seen_through(&self, matrix: &G::Matrix, _: &G::Matrix) -> Self {
        Self(product(&self.0, &G::of_matrix(matrix)))
    }
}

/// The product `A B`, unrolled. nalgebra's product isn't always inlined, and would then have the target's common
/// instructions in lanes.
#[hot]
fn product<T: Real, const N: usize>(a: &SMatrix<T, N, N>, b: &SMatrix<T, N, N>) -> SMatrix<T, N, N> {
    let mut product = SMatrix::zeros();
    for column in 0..N {
        for row in 0..N {
            let mut sum = a[(row, 0)] * b[(0, column)];
            for k in 1..N {
                sum += a[(row, k)] * b[(k, column)];
            }
            product[(row, column)] = sum;
        }
    }
    product
}
