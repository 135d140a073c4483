//! The places of a system that a term is put at.

mod coupled;
mod one_body;
mod two_bodies;

pub use coupled::Coupling;
pub use one_body::{Each, On};
pub use two_bodies::{Along, Between, Pairs};

use crate::groups::{Advected, LieGroup, SquareOf};
use crate::mechanics::effect::{Effect, Matrix, NewtonUpdate, Square, Vector};
use crate::numbers::Pattern;

/// One place: its number among all, and the body there, or the two bodies.
#[derive(Clone, Copy, Debug)]
pub struct At {
    /// The number of the place, from zero.
    pub place: usize,
    /// The bodies, from zero; of a place at one body twice the same.
    pub bodies: [usize; 2],
}

/// Where the terms `E` of a [`Placement`](super::Placement) are: [`Each`], [`On`], [`Along`], [`Coupling`], [`Between`] or
/// [`Pairs`].
#[hot]
pub trait Places<E: Effect> {
    /// The group of the system.
    type Group: LieGroup<Scalar = E::Scalar>;
    /// What is advected at all places.
    type Advected: Advected<Self::Group>;
    /// Something for each place where momentum equations have a part.
    type Of<T: Copy>: Copy + AsRef<[T]>;

    /// How many places there are.
    const PLACES: usize;
    /// Why there can't be such places, if there can't.
    const WRONG: Option<&'static str>;
    /// Whether each place is at one body: what couples velocities there stays within its block of the Newton matrix.
    const AT_ONE_BODY: bool;
    /// Whether what is between two bodies there depends on where both are within the step. They are neighbours then.
    const LINKS_NEIGHBOURS: bool = false;
    /// What they are, for a description, and the bodies if they are fixed.
    const NAME: (&'static str, [usize; 2]);

    /// Visits the places in their order.
    fn visit(each: impl FnMut(At));

    /// Something for each place, in a loop: see `filled!` for why not by `from_fn`.
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

    /// The components of all bodies, with those of each body at these places replaced. Places between two bodies replace none.
    fn replaced(
        all: &<Self::Group as LieGroup>::Vector,
        _: impl FnMut(At) -> Vector<E>,
    ) -> <Self::Group as LieGroup>::Vector {
        *all
    }

    /// A matrix for all, from one for each place at one body; zero where there is no place.
    fn squares(of: impl FnMut(At) -> Square<E>) -> SquareOf<Self::Group>;

    /// Both, from a vector and a matrix of each place.
    fn system(
        mut of: impl FnMut(At) -> (Vector<E>, Square<E>),
    ) -> (<Self::Group as LieGroup>::Vector, SquareOf<Self::Group>) {
        (
            Self::sum(
                #[cfg_attr(not(debug_assertions), inline(always))]
                |at| of(at).0,
            ),
            Self::squares(
                #[cfg_attr(not(debug_assertions), inline(always))]
                |at| of(at).1,
            ),
        )
    }

    /// The same, with the blocks that join neighbours added to those that are given.
    fn linked(
        _: &mut LinksOf<Self::Group>,
        of: impl FnMut(At) -> (Vector<E>, Square<E>),
    ) -> (<Self::Group as LieGroup>::Vector, SquareOf<Self::Group>) {
        Self::system(of)
    }

    /// One of Newton's iterations, from residual and Jacobian of each place.
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
