//! Neighbours in a row of bodies whose equations are solved together.

use core::marker::PhantomData;

use super::two_bodies::{Body, BodyMatrix, BodyVector, add_parts, at_two_bodies, neighbours};
use super::{At, LinksOf, Places};
use crate::groups::{Pair, SquareOf};
use crate::mechanics::effect::{Effect, Group, Matrix, Square, Vector};
use crate::mechanics::systems::seen::Neighbours;
use crate::numbers::{BlockDiagonal, Bodies, Coordinates as _};

/// At each two neighbours of `N` bodies in a row, as [`Along`](super::Along), for potentials that depend on where both are within the
/// step: the means of what they are at its ends, or functions of these.
///
/// The momentum equations of the row are solved together, by elimination from the first body to the last, in time
/// proportional to `N`. The step isn't bounded by `2/ω` of what is stiff there: with means a linear spring moves as by the
/// implicit midpoint rule. At [`Along`](super::Along) places, with half of a potential at either end, a step has to be below
/// `2/ω` of the fastest oscillation.
///
/// No body may turn by more than a right angle in a step. Beyond, more would have to be known of the Jacobian than there is,
/// and such a step is refused by [`StepError::BeyondSolvable`](crate::StepError::BeyondSolvable). It names the body that would
/// turn farthest by its momentum after the first kick. The potential of the middle isn't in that kick.
///
/// # Examples
///
/// Bodies that are translated, tied by springs so stiff that at both ends of a step they would be torn apart.
///
/// ```
/// use liestep::groups::R3;
/// use liestep::mechanics::{Coupling, Each};
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
/// let row = Each::<3>::of([Mass { m: 1.0 }]) + Coupling::<3>::of([Tied { k: 1e6 }]); // ω h is above 100
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
pub struct Coupling<const N: usize>;

impl<E: Effect<Group: Pair>, const N: usize> Places<E> for Coupling<N> {
    /// Entries of `N − 1` pairs; the last of the `N` entries isn't used.
    type Of<T: Copy> = [T; N];

    const LINKS_NEIGHBOURS: bool = true;

    at_two_bodies!();
    neighbours!("coupled along the row");

    #[hot]
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

    fn system(of: impl FnMut(At) -> (Vector<E>, Square<E>)) -> (Bodies<BodyVector<E>, N>, SquareOf<Self::Group>) {
        <Self as Places<E>>::linked(&mut Bodies::<BodyVector<E>, N>::no_links(), of)
    }

    #[hot]
    fn linked(
        links: &mut LinksOf<Self::Group>,
        mut of: impl FnMut(At) -> (Vector<E>, Square<E>),
    ) -> (Bodies<BodyVector<E>, N>, SquareOf<Self::Group>) {
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
