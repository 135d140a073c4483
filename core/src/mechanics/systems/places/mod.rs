//! The places of a term in a system: bodies, or pairs of bodies.

mod coupled;
mod one_body;
mod two_bodies;

pub use coupled::Coupling;
pub use one_body::{Each, On};
pub use two_bodies::{Along, Between, Pairs};

use crate::groups::{Advected, LieGroup, SquareOf};
use crate::mechanics::effect::{Effect, Matrix, NewtonUpdate, Square, Vector};
use crate::numbers::Pattern;

/// One place: its number, and its body or its two bodies.
#[derive(Clone, Copy, Debug)]
pub struct At {
    /// The number of the place, from zero.
    pub place: usize,
    /// The bodies, from zero; a place at one body has it twice.
    pub bodies: [usize; 2],
}

/// The places of the terms `E` of a [`Placement`](super::Placement): [`Each`], [`On`], [`Along`], [`Coupling`], [`Between`] or
/// [`Pairs`].
#[hot]
pub trait Places<E: Effect> {
    /// The group of the system.
    type Group: LieGroup<Scalar = E::Scalar>;
    /// The advected parameters of the terms at all places.
    type Advected: Advected<Self::Group>;
    /// A list with an entry for each place, empty where terms have no part in the momentum equations.
    type Of<T: Copy>: Copy + AsRef<[T]>;

    /// Number of the places.
    const PLACES: usize;
    /// The reason why these places can't exist, as the pair of a body with itself; none if they can.
    const WRONG: Option<&'static str>;
    /// Whether each place is at one body, so that a term that couples velocities stays within the body's block of the
    /// Newton matrix.
    const AT_ONE_BODY: bool;
    /// Whether a term between two bodies may depend on their positions within the step. They are neighbours then.
    const LINKS_NEIGHBOURS: bool = false;
    /// The name of the places for a description, and the bodies if they are fixed.
    const NAME: (&'static str, [usize; 2]);

    /// Visits the places in their order.
    fn visit(each: impl FnMut(At));

    /// A list with an entry for each place, made by a loop: `filled!` has the reason against `from_fn`.
    fn gather<T: Copy>(make: impl FnMut(At) -> T) -> Self::Of<T>;

    /// Advected parameters in space, from those of each place.
    fn spatial(of: impl Fn(usize) -> E::Advected) -> Self::Advected;

    /// The advected parameters of the term at a place in the body frame; `spatial` has them in space.
    fn seen(all: &Self::Advected, spatial: &E::Advected, at: At) -> E::Advected;

    /// The matrices of the bodies at a place.
    fn matrix(all: &<Self::Group as LieGroup>::Matrix, at: At) -> Matrix<E>;

    /// The components of the bodies at a place.
    fn components(all: &<Self::Group as LieGroup>::Vector, at: At) -> Vector<E>;

    /// The sum of component vectors, one for each place, each on the components of its bodies.
    fn sum(of: impl FnMut(At) -> Vector<E>) -> <Self::Group as LieGroup>::Vector;

    /// The components of all bodies, with those of each body at these places replaced. Places between two bodies replace none.
    fn replaced(
        all: &<Self::Group as LieGroup>::Vector,
        _: impl FnMut(At) -> Vector<E>,
    ) -> <Self::Group as LieGroup>::Vector {
        *all
    }

    /// The block-diagonal matrix of the system, from a matrix for each place at one body; zero for bodies without a
    /// place.
    fn squares(of: impl FnMut(At) -> Square<E>) -> SquareOf<Self::Group>;

    /// The vector and the matrix of the system, from those of each place.
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

    /// The vector and the matrix of the system; the blocks that couple neighbours are added to the given links.
    fn linked(
        _: &mut LinksOf<Self::Group>,
        of: impl FnMut(At) -> (Vector<E>, Square<E>),
    ) -> (<Self::Group as LieGroup>::Vector, SquareOf<Self::Group>) {
        Self::system(of)
    }

    /// One Newton iteration, from residual and Jacobian at each place.
    fn newton_update(
        pattern: Pattern,
        system: impl FnMut(At) -> (Vector<E>, Square<E>),
    ) -> NewtonUpdate<<Self::Group as LieGroup>::Vector, SquareOf<Self::Group>, E::Scalar> {
        let (residual, jacobian) = Self::system(system);
        NewtonUpdate::of(&residual, &jacobian, pattern)
    }
}

/// The blocks that couple neighbours in a row of bodies.
type LinksOf<G> = <<G as LieGroup>::Vector as crate::numbers::Coordinates<<G as LieGroup>::Scalar>>::Links;
