//! Systems of many bodies: terms that are declared on one body or on two, placed at bodies or between them.
//!
//! A term is derived once, whatever the number of bodies, and what a step runs is a loop over its places. The group of a
//! system of `N` bodies is `[G; N]`, and what is put at its places adds with `+` as other effects do:
//!
//! | places | the term is declared on |
//! |---|---|
//! | [`Each<N>`](Each) | one body, `G` |
//! | [`On<K, N>`](On) | one body |
//! | [`Along<N>`](Along) | two bodies, `(G, G)`; `(A, B, A, B)` where `G` is `(A, B)` |
//! | [`Between<A, B, N>`](Between) | two bodies |
//! | [`Pairs<N>`](Pairs) | two bodies |
//! | [`Coupling<N>`](Coupling) | two bodies: a potential that depends on where both are within the step |
//!
//! Between bodies potentials of the ends of a step leave the Newton matrix block diagonal, and each body's equation is
//! solved by its own block. A potential of the middle of a step, as of a stiff rod, is put at [`Coupling`] places, and the
//! equations of the row are solved together, in time proportional to `N`. A term on two bodies that couples velocities
//! doesn't compile here; a chain of links on ball joints has a [plan of its own](crate::Stepper::linked).

mod equations;
mod places;
mod seen;

use core::fmt::Debug;
use core::ops::Add;

pub use places::{Along, At, Between, Coupling, Each, On, Pairs, Places};
pub use seen::{Neighbours, SeenBetween, WhereAllAre};

use crate::error::SetupError;
use crate::groups::Retraction;
use crate::mechanics::effect::Effect;
use crate::mechanics::kinetic_part::KineticPart as _;
use crate::mechanics::sum::{SharedBy, Sum};
use crate::mechanics::term::Term;

/// A term at the places `P` of a system; made by [`of`](Each::of). With `M = 1` it is the same at all of them, otherwise
/// there is one for each.
///
/// # Examples
///
/// Three bodies in a row, neighbours of which would like to stand in the same way.
///
/// ```
/// use liestep::effects::RigidBody;
/// use liestep::mechanics::{Along, Each};
/// use liestep::{NonstandardInertia, SO3, Stepper, lagrangian};
/// use liestep::numbers::Bodies;
/// use nalgebra::Vector3;
///
/// #[lagrangian(
///     group(F_1 = SO3, F_2 = SO3),
///     advected(Q = F_2.seen_from(F_1)),
///     l_d = 0.5 * h * kappa * (Q.trace() + (F_1.transpose() * Q * F_2).trace()),
/// )]
/// #[derive(Clone, Copy, Debug, PartialEq)]
/// struct Alike {
///     kappa: f64, // J
/// }
///
/// let body = |J: [f64; 3]| NonstandardInertia::from_principal_moments(J.into()).map(|J_d| RigidBody { J_d });
/// let bodies = [body([1.0, 2.0, 2.5])?, body([2.0, 2.0, 1.0])?, body([1.0, 1.5, 2.0])?];
/// let row = Each::<3>::of(bodies) + Along::<3>::of([Alike { kappa: 2.0 }]);
/// let stepper = Stepper::new(row, 0.01)?;
/// let velocities = [Vector3::x(), Vector3::zeros(), Vector3::new(0.0, 1.0, 2.0)];
/// let mut state = stepper.start([SO3::from_euler_angles(0.1, 0.2, 0.3); 3], Bodies(velocities))?;
/// let whole = |momenta: Bodies<Vector3<f64>, 3>| momenta.0.iter().sum::<Vector3<f64>>();
/// let before = whole(state.spatial_momentum());
/// stepper.run(&mut state, 1000)?;
/// assert!((whole(state.spatial_momentum()) - before).norm() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// A term that couples velocities isn't one for two places, and is refused when a program is built.
#[derive(Clone, Copy, Debug, PartialEq, Lanes, InLanes)]
pub struct Placement<P, E, const M: usize> {
    #[shared]
    places: P,
    /// One term for all places, or one for each; [`of`](Each::of) has checked their number.
    terms: [E; M],
}

macro_rules! of {
    ([$($parameters:tt)*] $places:ident<$($arguments:ident),+>) => {
        impl<$($parameters)*> $places<$($arguments),+> {
            /// Terms at these places: one for all of them, or one for each.
            pub const fn of<E: Effect, const M: usize>(terms: [E; M]) -> Placement<Self, E, M>
            where
                Self: Places<E>,
            {
                const { check::<Self, E, M>() };
                Placement { places: Self, terms }
            }
        }
    };
}

/// Refuses, when the program is built, terms that don't fit these places.
const fn check<P: Places<E>, E: Effect, const M: usize>() {
    if let Some(cause) = P::WRONG {
        panic!("{}", cause);
    }
    assert!(
        M == 1 || M == P::PLACES,
        "as many terms are put there as there are places, or one that is the same at all of them"
    );
    if P::AT_ONE_BODY {
        return;
    }
    assert!(
        E::FACTS.constraints == 0,
        "a constraint on velocities is for one body, or for bodies that are declared as one product"
    );
    assert!(
        !E::FACTS.parts.unknown || !E::Kinetic::IS_THERE,
        "between the bodies of a system only potentials are possible: this term couples their velocities; declare all of \
         these bodies as one product, `group(F_1 = SO3, F_2 = SO3, …)`, or take `liestep::methods::Chain`"
    );
    assert!(
        P::LINKS_NEIGHBOURS || !E::FACTS.parts.unknown,
        "this term depends on where two bodies are within the step: put it at neighbours in a row, by \
         `Coupling::<N>::of`, or take the means of what it has at the ends of the step"
    );
    assert!(
        !P::LINKS_NEIGHBOURS || (E::FACTS.is_quadratic && E::FACTS.denominators == 0),
        "a term with cleared denominators, or one that isn't quadratic in the velocity, can't join neighbours"
    );
}

of!([const N: usize] Each<N>);
of!([const K: usize, const N: usize] On<K, N>);
of!([const N: usize] Along<N>);
of!([const N: usize] Coupling<N>);
of!([const A: usize, const B: usize, const N: usize] Between<A, B, N>);
of!([const N: usize] Pairs<N>);

impl<P, E, C, const M: usize> Add<C> for Placement<P, E, M>
where
    P: Places<E>,
    E: Effect,
    C: Effect<Group: SharedBy<P::Group, Self, C>>,
{
    type Output = Sum<Self, C>;

    fn add(self, other: C) -> Sum<Self, C> {
        Sum::new(self, other)
    }
}

/// The number of the term at a place.
#[hot]
const fn term_at<const M: usize>(place: usize) -> usize {
    if M == 1 { 0 } else { place }
}

/// Constants of each term, and its advected parameters in space.
type TermConstants<E, const M: usize> = [(<E as Effect>::Constants, <E as Term>::Advected); M];

impl<P, E, const M: usize> Term for Placement<P, E, M>
where
    P: Places<E> + Copy + Debug + PartialEq,
    E: Effect,
    E::Retraction: Retraction<P::Group>,
{
    type Scalar = E::Scalar;
    type Group = P::Group;
    type Advected = P::Advected;

    /// The error for a parameter of one of several terms names the term's body, or the first of its two.
    fn validate(&self) -> Result<(), SetupError> {
        let mut checked = Ok(());
        P::visit(|at| {
            if checked.is_ok() && (at.place < M) {
                checked = self.terms[at.place].validate().map_err(|error| match error {
                    // An error in a term that all places share names no body.
                    SetupError::Parameter { field, cause } if M > 1 || (P::AT_ONE_BODY && P::PLACES == 1) => {
                        SetupError::BodyParameter { body: at.bodies[0], field, cause }
                    }
                    error => error,
                });
            }
        });
        checked
    }

    fn advected(&self) -> P::Advected {
        P::spatial(|place| self.terms[term_at::<M>(place)].advected())
    }
}
