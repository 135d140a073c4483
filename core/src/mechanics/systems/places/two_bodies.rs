//! Places at two bodies.

use core::marker::PhantomData;

use super::{At, Places};
use crate::groups::{Advected as _, LieGroup, Pair, SquareOf};
use crate::mechanics::effect::{Effect, Group, Matrix, Square, Vector};
use crate::mechanics::systems::seen::{Neighbours, SeenBetween, WhereAllAre};
use crate::numbers::{BlockDiagonal, Bodies, Coordinates as _};

/// At each two neighbours of `N` bodies in a row: the first with the second, the second with the third, and so on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Along<const N: usize>;

/// At the bodies `A` and `B` of `N`, counted from zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Between<const A: usize, const B: usize, const N: usize>;

/// At each two of `N` bodies, the one that comes first in the row as the first of the two. One body alone has no pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pairs<const N: usize>;

/// The body of a term on two.
pub(super) type Body<E> = <Group<E> as Pair>::Body;
/// Matrices and components of one of the two bodies.
pub(super) type BodyMatrix<E> = <Body<E> as LieGroup>::Matrix;
pub(super) type BodyVector<E> = <Body<E> as LieGroup>::Vector;

/// The functions that all places at two bodies share.
macro_rules! at_two_bodies {
    () => {
        type Group = [Body<E>; N];

        const AT_ONE_BODY: bool = false;

        #[hot]
        fn matrix(all: &[BodyMatrix<E>; N], at: At) -> Matrix<E> {
            Group::<E>::matrices(&all[at.bodies[0]], &all[at.bodies[1]])
        }

        #[hot]
        fn components(all: &Bodies<BodyVector<E>, N>, at: At) -> Vector<E> {
            Group::<E>::joined(&all.0[at.bodies[0]], &all.0[at.bodies[1]])
        }

        #[hot]
        fn sum(mut of: impl FnMut(At) -> Vector<E>) -> Bodies<BodyVector<E>, N> {
            let mut all = [BodyVector::<E>::zero(); N];
            <Self as Places<E>>::visit(
                #[cfg_attr(not(debug_assertions), inline(always))]
                |at| add_parts::<E, N>(&mut all, at, &of(at)),
            );
            Bodies(all)
        }
    };
}

/// The functions of places whose terms have no part in the momentum equations: [`Along`], [`Between`] and [`Pairs`].
macro_rules! of_ends {
    () => {
        type Of<T: Copy> = [T; 0];

        fn gather<T: Copy>(_: impl FnMut(At) -> T) -> [T; 0] {
            []
        }

        /// A term without an unknown part has a zero Jacobian.
        fn squares(_: impl FnMut(At) -> Square<E>) -> SquareOf<Self::Group> {
            let zero = BodyVector::<E>::zero();
            BlockDiagonal([zero.outer(&zero); N])
        }
    };
}

/// The advected parameters of neighbours in a row.
macro_rules! neighbours {
    ($name:literal) => {
        type Advected = Neighbours<Group<E>, E::Advected, N>;

        const PLACES: usize = N.saturating_sub(1);
        const WRONG: Option<&'static str> =
            if N > 1 { None } else { Some("neighbours are two bodies at least: write how many there are") };
        const NAME: (&'static str, [usize; 2]) = ($name, [0, N]);

        #[hot]
        fn visit(mut each: impl FnMut(At)) {
            for place in 1..N {
                each(At { place: place - 1, bodies: [place - 1, place] });
            }
        }

        fn spatial(of: impl Fn(usize) -> E::Advected) -> Self::Advected {
            // The last body has no next one: its entry is padding.
            Neighbours(core::array::from_fn(|place| of(place.min(N - 2))), PhantomData)
        }

        #[hot]
        fn seen(all: &Self::Advected, _: &E::Advected, at: At) -> E::Advected {
            all.0[at.place]
        }
    };
}

pub(super) use {at_two_bodies, neighbours};

/// Adds the components of each of the two bodies to its place in the row.
#[hot]
pub(super) fn add_parts<E: Effect<Group: Pair>, const N: usize>(
    all: &mut [BodyVector<E>; N],
    at: At,
    both: &Vector<E>,
) {
    for (body, part) in at.bodies.into_iter().zip(Group::<E>::parts(both)) {
        all[body] = all[body] + part;
    }
}

impl<E: Effect<Group: Pair>, const N: usize> Places<E> for Along<N> {
    at_two_bodies!();
    of_ends!();
    neighbours!("along the row");
}

#[hot]
impl<E: Effect<Group: Pair>, const A: usize, const B: usize, const N: usize> Places<E> for Between<A, B, N> {
    type Advected = SeenBetween<Group<E>, E::Advected, A, B>;

    const PLACES: usize = 1;
    const WRONG: Option<&'static str> = if A >= N || B >= N {
        Some("there are no two bodies with these numbers: in `Between::<A, B, N>` the `N` bodies are counted from zero")
    } else if A == B {
        Some("a body isn't between itself: in `Between::<A, B, N>` the numbers `A` and `B` differ")
    } else {
        None
    };
    const NAME: (&'static str, [usize; 2]) = ("between two bodies", [A, B]);

    at_two_bodies!();
    of_ends!();

    fn visit(mut each: impl FnMut(At)) {
        each(At { place: 0, bodies: [A, B] });
    }

    fn spatial(of: impl Fn(usize) -> E::Advected) -> Self::Advected {
        SeenBetween(of(0), PhantomData)
    }

    fn seen(all: &Self::Advected, _: &E::Advected, _: At) -> E::Advected {
        all.0
    }
}

#[hot]
impl<E: Effect<Group: Pair>, const N: usize> Places<E> for Pairs<N> {
    type Advected = WhereAllAre<Body<E>, N>;

    const PLACES: usize = N * N.saturating_sub(1) / 2;
    const WRONG: Option<&'static str> =
        if N > 0 { None } else { Some("a system has one body at least: write how many, `Pairs::<N>`") };
    const NAME: (&'static str, [usize; 2]) = ("at all pairs", [N, N]);

    at_two_bodies!();
    of_ends!();

    fn visit(mut each: impl FnMut(At)) {
        let mut place = 0;
        for first in 0..N {
            for second in first + 1..N {
                each(At { place, bodies: [first, second] });
                place += 1;
            }
        }
    }

    fn spatial(_: impl Fn(usize) -> E::Advected) -> Self::Advected {
        WhereAllAre::default()
    }

    /// The relative configuration is computed when a term needs it: registers don't hold those of all pairs.
    fn seen(all: &Self::Advected, spatial: &E::Advected, at: At) -> E::Advected {
        let [first, second] = at.bodies.map(|body| Body::<E>::from_matrix_unchecked(all.0[body]));
        spatial.seen_from(&Group::<E>::pair(&first, &second))
    }
}
