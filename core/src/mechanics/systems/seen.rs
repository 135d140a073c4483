//! Advected parameters of the places at two bodies of a system.

use core::marker::PhantomData;

use crate::groups::{Advected, LieGroup, Pair};
use crate::numbers::{Entries, entries_of_value, filled, zero};

/// The parameters of each two neighbours, which a group `P` of two bodies advects. The last of the `N` entries is
/// padding and never changes: stable Rust has no arrays of `N − 1`.
#[derive(Clone, Copy, Debug, PartialEq, Lanes)]
#[doc(hidden)]
pub struct Neighbours<P, W, const N: usize>(pub [W; N], pub(super) PhantomData<P>);

/// The parameters of the bodies `A` and `B`, which a group `P` of two bodies advects.
#[derive(Clone, Copy, Debug, PartialEq, Lanes)]
#[doc(hidden)]
pub struct SeenBetween<P, W, const A: usize, const B: usize>(pub W, pub(super) PhantomData<P>);

/// The configurations of all bodies in space, from which the parameters of each pair are computed.
#[derive(Clone, Copy, Debug, PartialEq, Lanes)]
pub struct WhereAllAre<G: LieGroup, const N: usize>(pub [G::Matrix; N]);

impl<G: LieGroup, const N: usize> Default for WhereAllAre<G, N> {
    fn default() -> Self {
        Self([G::identity().matrix(); N])
    }
}

entries_of_value!([P: Copy, W: Entries<S>, const N: usize] Neighbours<P, W, N>, PhantomData);
entries_of_value!([P: Copy, W: Entries<S>, const A: usize, const B: usize] SeenBetween<P, W, A, B>, PhantomData);
entries_of_value!([G: LieGroup<Scalar = S>, const N: usize] WhereAllAre<G, N>);

impl<P, W: Copy, const N: usize> Neighbours<P, W, N> {
    /// Replaces the parameters of each two neighbours; the padding stays.
    #[hot]
    fn with(mut self, each: impl Fn(usize) -> W) -> Self {
        for k in 1..N {
            self.0[k - 1] = each(k - 1);
        }
        self
    }
}

#[hot]
impl<G, P, W, const N: usize> Advected<[G; N]> for Neighbours<P, W, N>
where
    G: LieGroup,
    P: Pair<Body = G, Scalar = G::Scalar>,
    W: Advected<P>,
{
    fn seen_from(&self, attitude: &[G; N]) -> Self {
        Self(self.0, PhantomData).with(|k| self.0[k].seen_from(&P::pair(&attitude[k], &attitude[k + 1])))
    }

    fn change(&self, increment: &[G::Matrix; N]) -> Self {
        Self([zero::<G::Scalar, W>(); N], PhantomData).with(
            #[cfg_attr(not(debug_assertions), inline(always))]
            |k| self.0[k].change(&P::matrices(&increment[k], &increment[k + 1])),
        )
    }

    fn advect(&self, increment: &[G::Matrix; N]) -> Self {
        Self(self.0, PhantomData).with(
            #[cfg_attr(not(debug_assertions), inline(always))]
            |k| self.0[k].advect(&P::matrices(&increment[k], &increment[k + 1])),
        )
    }

    fn rate(&self, velocity: &[G::Matrix; N]) -> Self {
        Self([zero::<G::Scalar, W>(); N], PhantomData)
            .with(|k| self.0[k].rate(&P::matrices(&velocity[k], &velocity[k + 1])))
    }

    fn seen_through(&self, matrix: &[G::Matrix; N], inverse: &[G::Matrix; N]) -> Self {
        let pair = |of: &[G::Matrix; N], k: usize| P::matrices(&of[k], &of[k + 1]);
        Self(self.0, PhantomData).with(|k| self.0[k].seen_through(&pair(matrix, k), &pair(inverse, k)))
    }
}

#[hot]
impl<G, P, W, const A: usize, const B: usize, const N: usize> Advected<[G; N]> for SeenBetween<P, W, A, B>
where
    G: LieGroup,
    P: Pair<Body = G, Scalar = G::Scalar>,
    W: Advected<P>,
{
    fn seen_from(&self, attitude: &[G; N]) -> Self {
        Self(self.0.seen_from(&P::pair(&attitude[A], &attitude[B])), PhantomData)
    }

    fn change(&self, increment: &[G::Matrix; N]) -> Self {
        Self(self.0.change(&P::matrices(&increment[A], &increment[B])), PhantomData)
    }

    fn rate(&self, velocity: &[G::Matrix; N]) -> Self {
        Self(self.0.rate(&P::matrices(&velocity[A], &velocity[B])), PhantomData)
    }

    fn seen_through(&self, matrix: &[G::Matrix; N], inverse: &[G::Matrix; N]) -> Self {
        let pair = |of: &[G::Matrix; N]| P::matrices(&of[A], &of[B]);
        Self(self.0.seen_through(&pair(matrix), &pair(inverse)), PhantomData)
    }
}

impl<G: LieGroup, const N: usize> Advected<[G; N]> for WhereAllAre<G, N> {
    fn seen_from(&self, attitude: &[G; N]) -> Self {
        self.seen_through(&attitude.map(|body| body.matrix()), &[G::identity().matrix(); N])
    }

    /// The change `R D`.
    #[hot]
    fn change(&self, increment: &[G::Matrix; N]) -> Self {
        Self(filled!(self.0, |k| G::from_matrix_unchecked(self.0[k]).change(&increment[k])))
    }

    /// The rate `R ξ̂`.
    fn rate(&self, velocity: &[G::Matrix; N]) -> Self {
        self.change(velocity)
    }

    fn seen_through(&self, matrix: &[G::Matrix; N], _: &[G::Matrix; N]) -> Self {
        let moved = |k: usize| G::from_matrix_unchecked(self.0[k]).compose(&G::from_matrix_unchecked(matrix[k]));
        Self(filled!(self.0, |k| moved(k).matrix()))
    }
}
