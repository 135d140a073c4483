//! The places of a system that a term is put at.

use core::array::from_fn;
use core::marker::PhantomData;

use super::seen::{Neighbours, SeenBetween, WhereAllAre};
use crate::groups::{Advected, LieGroup, Pair, SeenFrom, SquareOf};
use crate::mechanics::effect::{Effect, Group, Matrix, NewtonUpdate, Square, Vector};
use crate::numbers::{BlockDiagonal, Bodies, Coordinates as _, Pattern, filled, least, most};

/// One place: its number among all, and the body there, or the two bodies.
#[derive(Clone, Copy, Debug)]
pub struct At {
    /// The number of the place, from zero.
    pub place: usize,
    /// The bodies, from zero; of a place at one body twice the same.
    pub bodies: [usize; 2],
}

/// The components of all bodies.
type All<V, const N: usize> = Bodies<V, N>;

/// Where the terms `E` of a [`Placed`](super::Placed) are: [`Each`], [`On`], [`Along`], [`Coupled`],
/// [`Between`] or [`Pairs`].
pub trait Places<E: Effect> {
    /// The group of the system.
    type Group: LieGroup<Scalar = E::Scalar>;
    /// What is advected at all places.
    type Advected: Advected<Self::Group>;
    /// Something for each place where momentum equations have a part.
    type Of<T: Copy>: Copy + AsRef<[T]>;

    /// How many places there are.
    const PLACES: usize;
    /// Whether each place is at one body: what couples velocities there stays within its block of the Newton matrix.
    const AT_ONE_BODY: bool;
    /// Whether what is between two bodies there depends on where both are within the step. They are neighbours then.
    const LINKS_NEIGHBOURS: bool = false;
    /// What they are, for a description, and the bodies if they are fixed.
    const NAME: (&'static str, [usize; 2]);

    /// Visits the places in their order.
    fn visit(each: impl FnMut(At));

    /// Something for each place.
    fn gather<T: Copy>(make: impl FnMut(At) -> T) -> Self::Of<T>;

    /// The spatial values, from those of each place.
    fn spatial(of: impl Fn(usize) -> E::Advected) -> Self::Advected;

    /// What the term at a place sees, and would see in space.
    fn seen(all: &Self::Advected, spatial: &E::Advected, at: At) -> E::Advected;

    /// The matrices of the bodies there.
    fn matrix(all: &<Self::Group as LieGroup>::Matrix, at: At) -> Matrix<E>;

    /// The components of the bodies there.
    fn components(all: &<Self::Group as LieGroup>::Vector, at: At) -> Vector<E>;

    /// The sum of what is at the places, each with components of its bodies.
    fn sum(of: impl FnMut(At) -> Vector<E>) -> <Self::Group as LieGroup>::Vector;

    /// A matrix for all, from one for each place at one body; zero where there is no place.
    fn squares(of: impl FnMut(At) -> Square<E>) -> SquareOf<Self::Group>;

    /// Both, from a vector and a matrix of each place.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn system(
        mut of: impl FnMut(At) -> (Vector<E>, Square<E>),
    ) -> (<Self::Group as LieGroup>::Vector, SquareOf<Self::Group>) {
        (Self::sum(|at| of(at).0), Self::squares(|at| of(at).1))
    }

    /// The same, with the blocks that join neighbours added to those that are given.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn linked(
        _: &mut LinksOf<Self::Group>,
        of: impl FnMut(At) -> (Vector<E>, Square<E>),
    ) -> (<Self::Group as LieGroup>::Vector, SquareOf<Self::Group>) {
        Self::system(of)
    }

    /// One of Newton's iterations, from residual and Jacobian of each place.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn newton_update(
        pattern: Pattern,
        system: impl FnMut(At) -> (Vector<E>, Square<E>),
    ) -> NewtonUpdate<<Self::Group as LieGroup>::Vector, SquareOf<Self::Group>, E::Scalar> {
        let (residual, jacobian) = Self::system(system);
        NewtonUpdate::of(&residual, &jacobian, pattern)
    }
}

/// What joins neighbours in a row of bodies.
type LinksOf<G> = <<G as LieGroup>::Vector as crate::numbers::Coordinates<<G as LieGroup>::Scalar>>::Links;

/// At each of `N` bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Each<const N: usize>;

/// At the body `K` of `N`, counted from zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct On<const K: usize, const N: usize>;

/// At each two neighbours of `N` bodies in a row: the first with the second, the second with the third, and so on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Along<const N: usize>;

/// At each two neighbours of `N` bodies in a row, as [`Along`], for potentials that depend on where both are within the
/// step: the means of what they are at its ends, or functions of these.
///
/// The momentum equations of the row are solved together, by elimination from the first body to the last, in time
/// proportional to `N`. The step isn't bounded by `2/ω` of what is stiff there: with means a linear spring moves as by the
/// implicit midpoint rule. At [`Along`] places, with half of a potential at either end, a step has to be below `2/ω` of the fastest
/// oscillation.
///
/// # Examples
///
/// Bodies that are translated, tied by springs so stiff that at both ends of a step they would be torn apart.
///
/// ```
/// use liestep::groups::R3;
/// use liestep::mechanics::{Coupled, Each};
/// use liestep::numbers::Bodies;
/// use liestep::{Stepper, lagrangian};
/// use nalgebra::Vector3;
///
/// #[lagrangian(group(d = R3), l_d = m * d.norm_squared() / (2.0 * h))]
/// #[derive(Clone, Copy, Debug, PartialEq)]
/// struct Mass {
///     m: f64,
/// }
///
/// #[lagrangian(
///     group(d_1 = R3, d_2 = R3),
///     advected(r = d_2.seen_from(d_1)),
///     l_d = -0.5 * h * k * (r + 0.5 * (d_2 - d_1)).norm_squared(),
/// )]
/// #[derive(Clone, Copy, Debug, PartialEq)]
/// struct Tied {
///     k: f64,
/// }
///
/// let h = 0.1;
/// let row = Each::<3>::of([Mass { m: 1.0 }]) + Coupled::<3>::of([Tied { k: 1e6 }]); // ω h is above 100
/// let stepper = Stepper::new(row, h)?;
/// let place = |x: f64| R3::from(Vector3::new(x, 0.0, 0.0));
/// let mut state = stepper.start([place(0.0), place(0.01), place(0.0)], Bodies([Vector3::y(); 3]))?;
/// let energy = stepper.energy(&state);
/// for _ in 0..1000 {
///     stepper.step(&mut state)?;
///     assert!((stepper.energy(&state) - energy).abs() < 1e-9 * energy);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Coupled<const N: usize>;

/// At the bodies `A` and `B` of `N`, counted from zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Between<const A: usize, const B: usize, const N: usize>;

/// At each two of `N` bodies, the one that comes first in the row as the first of the two.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pairs<const N: usize>;

/// What places at one body have in common.
macro_rules! at_one_body {
    () => {
        type Group = [Group<E>; N];

        const AT_ONE_BODY: bool = true;

        #[cfg_attr(not(debug_assertions), inline(always))]
        fn matrix(all: &[Matrix<E>; N], at: At) -> Matrix<E> {
            all[at.bodies[0]]
        }

        #[cfg_attr(not(debug_assertions), inline(always))]
        fn components(all: &All<Vector<E>, N>, at: At) -> Vector<E> {
            all.0[at.bodies[0]]
        }
    };
}

impl<E: Effect, const N: usize> Places<E> for Each<N> {
    type Advected = [E::Advected; N];
    type Of<T: Copy> = [T; N];

    const PLACES: usize = N;
    const NAME: (&'static str, [usize; 2]) = ("at each body", [N, N]);

    at_one_body!();

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn visit(mut each: impl FnMut(At)) {
        for place in 0..N {
            each(At { place, bodies: [place; 2] });
        }
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn gather<T: Copy>(mut make: impl FnMut(At) -> T) -> [T; N] {
        from_fn(|place| make(At { place, bodies: [place; 2] }))
    }

    fn spatial(of: impl Fn(usize) -> E::Advected) -> [E::Advected; N] {
        from_fn(of)
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn seen(all: &[E::Advected; N], _: &E::Advected, at: At) -> E::Advected {
        all[at.place]
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn sum(mut of: impl FnMut(At) -> Vector<E>) -> All<Vector<E>, N> {
        Bodies(filled([Vector::<E>::zero(); N], |place| of(At { place, bodies: [place; 2] })))
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn squares(mut of: impl FnMut(At) -> Square<E>) -> BlockDiagonal<Square<E>, N> {
        let zero = Vector::<E>::zero();
        BlockDiagonal(filled([zero.outer(&zero); N], |place| of(At { place, bodies: [place; 2] })))
    }

    /// Body by body: what both have in common is computed once.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn system(mut of: impl FnMut(At) -> (Vector<E>, Square<E>)) -> (All<Vector<E>, N>, BlockDiagonal<Square<E>, N>) {
        let zero = Vector::<E>::zero();
        let (mut vectors, mut squares) = ([zero; N], [zero.outer(&zero); N]);
        for place in 0..N {
            (vectors[place], squares[place]) = of(At { place, bodies: [place; 2] });
        }
        (Bodies(vectors), BlockDiagonal(squares))
    }

    /// Body by body, so that what is solved for one stays in registers.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn newton_update(
        pattern: Pattern,
        mut system: impl FnMut(At) -> (Vector<E>, Square<E>),
    ) -> NewtonUpdate<All<Vector<E>, N>, BlockDiagonal<Square<E>, N>, E::Scalar> {
        let zero = Vector::<E>::zero();
        let mut all =
            NewtonUpdate { update: Bodies([zero; N]), factors: BlockDiagonal([zero.outer(&zero); N]), det: most() };
        for place in 0..N {
            let (residual, jacobian) = system(At { place, bodies: [place; 2] });
            let (factors, det) = Vector::<E>::factorise_apart(&jacobian, pattern);
            all.update.0[place] = Vector::<E>::solve_apart(&factors, pattern, &residual);
            all.factors.0[place] = factors;
            all.det = least(all.det, det);
        }
        all
    }
}

impl<E: Effect, const K: usize, const N: usize> Places<E> for On<K, N> {
    type Advected = SeenFrom<K, E::Advected>;
    type Of<T: Copy> = [T; 1];

    const PLACES: usize = 1;
    const NAME: (&'static str, [usize; 2]) = ("on a body", [K, N]);

    at_one_body!();

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn visit(mut each: impl FnMut(At)) {
        const { assert!(K < N, "there is no body with this number: they are counted from zero") };
        each(At { place: 0, bodies: [K; 2] });
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn gather<T: Copy>(mut make: impl FnMut(At) -> T) -> [T; 1] {
        [make(At { place: 0, bodies: [K; 2] })]
    }

    fn spatial(of: impl Fn(usize) -> E::Advected) -> Self::Advected {
        SeenFrom(of(0))
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn seen(all: &Self::Advected, _: &E::Advected, _: At) -> E::Advected {
        all.0
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn sum(mut of: impl FnMut(At) -> Vector<E>) -> All<Vector<E>, N> {
        let mut all = [Vector::<E>::zero(); N];
        all[K] = of(At { place: 0, bodies: [K; 2] });
        Bodies(all)
    }

    fn squares(mut of: impl FnMut(At) -> Square<E>) -> BlockDiagonal<Square<E>, N> {
        let zero = Vector::<E>::zero();
        let mut squares = [zero.outer(&zero); N];
        squares[K] = of(At { place: 0, bodies: [K; 2] });
        BlockDiagonal(squares)
    }
}

/// The body of a term on two.
type Body<E> = <Group<E> as Pair>::Body;
/// Its matrices and its components.
type BodyMatrix<E> = <Body<E> as LieGroup>::Matrix;
type BodyVector<E> = <Body<E> as LieGroup>::Vector;

/// What places at two bodies have in common.
macro_rules! at_two_bodies {
    () => {
        type Group = [Body<E>; N];

        const AT_ONE_BODY: bool = false;

        #[cfg_attr(not(debug_assertions), inline(always))]
        fn matrix(all: &[BodyMatrix<E>; N], at: At) -> Matrix<E> {
            Group::<E>::matrices(&all[at.bodies[0]], &all[at.bodies[1]])
        }

        #[cfg_attr(not(debug_assertions), inline(always))]
        fn components(all: &All<BodyVector<E>, N>, at: At) -> Vector<E> {
            Group::<E>::joined(&all.0[at.bodies[0]], &all.0[at.bodies[1]])
        }

        #[cfg_attr(not(debug_assertions), inline(always))]
        fn sum(mut of: impl FnMut(At) -> Vector<E>) -> All<BodyVector<E>, N> {
            let mut all = [BodyVector::<E>::zero(); N];
            <Self as Places<E>>::visit(|at| add_parts::<E, N>(&mut all, at, &of(at)));
            Bodies(all)
        }
    };
}

/// What such places have in common whose momentum equations have no part there.
macro_rules! of_ends {
    () => {
        type Of<T: Copy> = [T; 0];

        fn gather<T: Copy>(_: impl FnMut(At) -> T) -> [T; 0] {
            []
        }

        /// A term that has no unknown part has none.
        fn squares(_: impl FnMut(At) -> Square<E>) -> SquareOf<Self::Group> {
            let zero = BodyVector::<E>::zero();
            BlockDiagonal([zero.outer(&zero); N])
        }
    };
}

/// What is where neighbours are.
macro_rules! neighbours {
    ($name:literal) => {
        type Advected = Neighbours<Group<E>, E::Advected, N>;

        const PLACES: usize = N - 1;
        const NAME: (&'static str, [usize; 2]) = ($name, [0, N]);

        #[cfg_attr(not(debug_assertions), inline(always))]
        fn visit(mut each: impl FnMut(At)) {
            const { assert!(N > 1, "neighbours are two bodies at least") };
            for place in 0..N - 1 {
                each(At { place, bodies: [place, place + 1] });
            }
        }

        fn spatial(of: impl Fn(usize) -> E::Advected) -> Self::Advected {
            // The last has no next.
            Neighbours(from_fn(|place| of(place.min(N - 2))), PhantomData)
        }

        #[cfg_attr(not(debug_assertions), inline(always))]
        fn seen(all: &Self::Advected, _: &E::Advected, at: At) -> E::Advected {
            all.0[at.place]
        }
    };
}

/// Adds the part of each of the two bodies.
#[cfg_attr(not(debug_assertions), inline(always))]
fn add_parts<E: Effect<Group: Pair>, const N: usize>(all: &mut [BodyVector<E>; N], at: At, both: &Vector<E>) {
    for (body, part) in at.bodies.into_iter().zip(Group::<E>::parts(both)) {
        all[body] = all[body] + part;
    }
}

impl<E: Effect<Group: Pair>, const N: usize> Places<E> for Along<N> {
    at_two_bodies!();
    of_ends!();
    neighbours!("along the row");
}

impl<E: Effect<Group: Pair>, const N: usize> Places<E> for Coupled<N> {
    /// Behind them there is one more, which isn't used.
    type Of<T: Copy> = [T; N];

    const LINKS_NEIGHBOURS: bool = true;

    at_two_bodies!();
    neighbours!("coupled along the row");

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn gather<T: Copy>(mut make: impl FnMut(At) -> T) -> [T; N] {
        let mut all = [make(At { place: 0, bodies: [0, 1] }); N];
        for (place, of) in all.iter_mut().enumerate().take(N - 1).skip(1) {
            *of = make(At { place, bodies: [place, place + 1] });
        }
        all
    }

    fn squares(mut of: impl FnMut(At) -> Square<E>) -> SquareOf<Self::Group> {
        <Self as Places<E>>::system(|at| (Vector::<E>::zero(), of(at))).1
    }

    fn system(of: impl FnMut(At) -> (Vector<E>, Square<E>)) -> (All<BodyVector<E>, N>, SquareOf<Self::Group>) {
        <Self as Places<E>>::linked(&mut All::<BodyVector<E>, N>::no_links(), of)
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn linked(
        links: &mut LinksOf<Self::Group>,
        mut of: impl FnMut(At) -> (Vector<E>, Square<E>),
    ) -> (All<BodyVector<E>, N>, SquareOf<Self::Group>) {
        let zero = BodyVector::<E>::zero();
        let (mut vectors, mut squares) = ([zero; N], [zero.outer(&zero); N]);
        for place in 0..N - 1 {
            let at = At { place, bodies: [place, place + 1] };
            let (both, matrix) = of(at);
            add_parts::<E, N>(&mut vectors, at, &both);
            let [[first, upper], [lower, second]] = Group::<E>::blocks(&matrix);
            squares[place] = squares[place] + first;
            squares[place + 1] = squares[place + 1] + second;
            links[place] = [links[place][0] + upper, links[place][1] + lower];
        }
        (Bodies(vectors), BlockDiagonal(squares))
    }
}

impl<E: Effect<Group: Pair>, const A: usize, const B: usize, const N: usize> Places<E> for Between<A, B, N> {
    type Advected = SeenBetween<Group<E>, E::Advected, A, B>;

    const PLACES: usize = 1;
    const NAME: (&'static str, [usize; 2]) = ("between two bodies", [A, B]);

    at_two_bodies!();
    of_ends!();

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn visit(mut each: impl FnMut(At)) {
        const { assert!(A < N && B < N && A != B, "there are no two bodies with these numbers, counted from zero") };
        each(At { place: 0, bodies: [A, B] });
    }

    fn spatial(of: impl Fn(usize) -> E::Advected) -> Self::Advected {
        SeenBetween(of(0), PhantomData)
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn seen(all: &Self::Advected, _: &E::Advected, _: At) -> E::Advected {
        all.0
    }
}

impl<E: Effect<Group: Pair>, const N: usize> Places<E> for Pairs<N> {
    type Advected = WhereAllAre<Body<E>, N>;

    const PLACES: usize = N * (N - 1) / 2;
    const NAME: (&'static str, [usize; 2]) = ("at all pairs", [N, N]);

    at_two_bodies!();
    of_ends!();

    #[cfg_attr(not(debug_assertions), inline(always))]
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

    /// Formed where it is needed: so many wouldn't be kept.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn seen(all: &Self::Advected, spatial: &E::Advected, at: At) -> E::Advected {
        let [first, second] = at.bodies.map(|body| Body::<E>::from_matrix_unchecked(all.0[body]));
        spatial.seen_from(&Group::<E>::pair(&first, &second))
    }
}
