//! Places at one body.

use core::array::from_fn;

use super::{At, Places};
use crate::groups::SeenFrom;
use crate::mechanics::effect::{Effect, Group, Matrix, NewtonUpdate, Square, Vector};
use crate::numbers::{BlockDiagonal, Bodies, Coordinates as _, Pattern, filled, least, most};

/// At each of `N` bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Each<const N: usize>;

/// At the body `K` of `N`, counted from zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct On<const K: usize, const N: usize>;

/// The functions that [`Each`] and [`On`] share.
macro_rules! at_one_body {
    () => {
        type Group = [Group<E>; N];

        const AT_ONE_BODY: bool = true;

        #[hot]
        fn matrix(all: &[Matrix<E>; N], at: At) -> Matrix<E> {
            all[at.bodies[0]]
        }

        #[hot]
        fn components(all: &Bodies<Vector<E>, N>, at: At) -> Vector<E> {
            all.0[at.bodies[0]]
        }

        #[hot]
        fn replaced(all: &Bodies<Vector<E>, N>, mut by: impl FnMut(At) -> Vector<E>) -> Bodies<Vector<E>, N> {
            let mut replaced = *all;
            <Self as Places<E>>::visit(
                #[cfg_attr(not(debug_assertions), inline(always))]
                |at| replaced.0[at.bodies[0]] = by(at),
            );
            replaced
        }
    };
}

#[hot]
impl<E: Effect, const N: usize> Places<E> for Each<N> {
    type Advected = [E::Advected; N];
    type Of<T: Copy> = [T; N];

    const PLACES: usize = N;
    const WRONG: Option<&'static str> =
        if N > 0 { None } else { Some("a system has one body at least: write how many, `Each::<N>`") };
    const NAME: (&'static str, [usize; 2]) = ("at each body", [N, N]);

    at_one_body!();

    fn visit(mut each: impl FnMut(At)) {
        for place in 0..N {
            each(At { place, bodies: [place; 2] });
        }
    }

    fn gather<T: Copy>(mut make: impl FnMut(At) -> T) -> [T; N] {
        let mut all = [make(At { place: 0, bodies: [0; 2] }); N];
        for (place, of) in all.iter_mut().enumerate().skip(1) {
            *of = make(At { place, bodies: [place; 2] });
        }
        all
    }

    fn spatial(of: impl Fn(usize) -> E::Advected) -> [E::Advected; N] {
        from_fn(of)
    }

    fn seen(all: &[E::Advected; N], _: &E::Advected, at: At) -> E::Advected {
        all[at.place]
    }

    fn sum(mut of: impl FnMut(At) -> Vector<E>) -> Bodies<Vector<E>, N> {
        Bodies(filled!([Vector::<E>::zero(); N], |place| of(At { place, bodies: [place; 2] })))
    }

    fn squares(mut of: impl FnMut(At) -> Square<E>) -> BlockDiagonal<Square<E>, N> {
        let zero = Vector::<E>::zero();
        BlockDiagonal(filled!([zero.outer(&zero); N], |place| of(At { place, bodies: [place; 2] })))
    }

    /// The system body by body, so that a computation shared by residual and Jacobian is made once.
    fn system(mut of: impl FnMut(At) -> (Vector<E>, Square<E>)) -> (Bodies<Vector<E>, N>, BlockDiagonal<Square<E>, N>) {
        let zero = Vector::<E>::zero();
        let (mut vectors, mut squares) = ([zero; N], [zero.outer(&zero); N]);
        for place in 0..N {
            (vectors[place], squares[place]) = of(At { place, bodies: [place; 2] });
        }
        (Bodies(vectors), BlockDiagonal(squares))
    }

    /// The iteration body by body, so that a body's system stays in registers.
    fn newton_update(
        pattern: Pattern,
        mut system: impl FnMut(At) -> (Vector<E>, Square<E>),
    ) -> NewtonUpdate<Bodies<Vector<E>, N>, BlockDiagonal<Square<E>, N>, E::Scalar> {
        let zero = Vector::<E>::zero();
        let (mut update, mut factors, mut smallest) = ([zero; N], [zero.outer(&zero); N], most());
        for place in 0..N {
            let (residual, jacobian) = system(At { place, bodies: [place; 2] });
            let (of_body, det) = Vector::<E>::factorise_apart(&jacobian, pattern);
            update[place] = Vector::<E>::solve_apart(&of_body, pattern, &residual);
            factors[place] = of_body;
            smallest = least(smallest, det);
        }
        NewtonUpdate { update: Bodies(update), factors: Some(BlockDiagonal(factors)), det: smallest }
    }
}

#[hot]
impl<E: Effect, const K: usize, const N: usize> Places<E> for On<K, N> {
    type Advected = SeenFrom<K, E::Advected>;
    type Of<T: Copy> = [T; 1];

    const PLACES: usize = 1;
    const WRONG: Option<&'static str> = if K < N {
        None
    } else {
        Some("there is no body with this number: in `On::<K, N>` the `N` bodies are counted from zero")
    };
    const NAME: (&'static str, [usize; 2]) = ("on a body", [K, N]);

    at_one_body!();

    fn visit(mut each: impl FnMut(At)) {
        each(At { place: 0, bodies: [K; 2] });
    }

    fn gather<T: Copy>(mut make: impl FnMut(At) -> T) -> [T; 1] {
        [make(At { place: 0, bodies: [K; 2] })]
    }

    fn spatial(of: impl Fn(usize) -> E::Advected) -> Self::Advected {
        SeenFrom(of(0))
    }

    fn seen(all: &Self::Advected, _: &E::Advected, _: At) -> E::Advected {
        all.0
    }

    fn sum(mut of: impl FnMut(At) -> Vector<E>) -> Bodies<Vector<E>, N> {
        let mut all = [Vector::<E>::zero(); N];
        all[K] = of(At { place: 0, bodies: [K; 2] });
        Bodies(all)
    }

    #[inline]
    fn squares(mut of: impl FnMut(At) -> Square<E>) -> BlockDiagonal<Square<E>, N> {
        let zero = Vector::<E>::zero();
        let mut squares = [zero.outer(&zero); N];
        squares[K] = of(At { place: 0, bodies: [K; 2] });
        BlockDiagonal(squares)
    }
}
