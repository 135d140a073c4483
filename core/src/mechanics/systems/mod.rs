//! Systems of many bodies: terms that are declared on one body or on two, put at places.
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
//! | [`Coupled<N>`](Coupled) | two bodies: a potential that depends on where both are within the step |
//!
//! Between bodies potentials of the ends of a step leave the Newton matrix block diagonal, and each body's equation is
//! solved by its own block. A potential of the middle of a step, as of a stiff rod, is put at [`Coupled`] places, and the
//! equations of the row are solved together, in time proportional to `N`. A term on two bodies that couples velocities
//! doesn't compile here; a chain of links on ball joints is a [system of its own](crate::methods::ChainStepper).

mod places;
mod seen;

use alloc::string::String;
use core::fmt::Debug;
use core::ops::Add;

pub use places::{Along, At, Between, Coupled, Each, On, Pairs, Places};
pub use seen::{Neighbours, SeenBetween, WhereAllAre};

use crate::error::SetupError;
use crate::groups::Retraction;
use crate::mechanics::description::SceneVisitor;
use crate::mechanics::effect::{Effect, Limit, Links, Matrix, NewtonUpdate, Parts, Residual, Square, Vector, pattern};
use crate::mechanics::kinetic_part::KineticPart as _;
use crate::mechanics::lagrangian::DiscreteLagrangian;
use crate::mechanics::operations::Operations;
use crate::mechanics::sum::{SharedBy, Sum};
use crate::mechanics::term::Term;
use crate::numbers::{Blocks, Coordinates as _, real};

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
/// A term that couples velocities isn't one for two places:
///
/// ```compile_fail,E0080
/// use liestep::groups::Relative;
/// use liestep::mechanics::Along;
/// use liestep::{Stepper, lagrangian};
/// use nalgebra::Vector3;
///
/// #[lagrangian(
///     group(F_1 = SO3, F_2 = SO3),
///     advected(Q = F_2.seen_from(F_1)),
///     l_d = ((F_1 - I) * rho).dot(&(Q * ((F_2 - I) * s))) / h,
/// )]
/// struct Linked {
///     rho: Vector3<f64>,
///     s: Vector3<f64>,
/// }
/// let joint = Along::<3>::of([Linked { rho: Vector3::z(), s: Vector3::z() }]);
/// let _ = liestep::mechanics::Effect::validate(&joint);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placed<P, E, const M: usize> {
    places: P,
    /// One for all or one for each, as [`of`](Each::of) has checked.
    terms: [E; M],
}

macro_rules! of {
    ([$($parameters:tt)*] $places:ident<$($arguments:ident),+>) => {
        impl<$($parameters)*> $places<$($arguments),+> {
            /// Terms at these places: one that is the same at all, or one for each.
            pub const fn of<E: Effect, const M: usize>(terms: [E; M]) -> Placed<Self, E, M>
            where
                Self: Places<E>,
            {
                const {
                    assert!(
                        M == 1 || M == <Self as Places<E>>::PLACES,
                        "there are as many terms as places, or there is one for all"
                    );
                }
                Placed { places: Self, terms }
            }
        }
    };
}

of!([const N: usize] Each<N>);
of!([const K: usize, const N: usize] On<K, N>);
of!([const N: usize] Along<N>);
of!([const N: usize] Coupled<N>);
of!([const A: usize, const B: usize, const N: usize] Between<A, B, N>);
of!([const N: usize] Pairs<N>);

impl<P, E, C, const M: usize> Add<C> for Placed<P, E, M>
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
#[cfg_attr(not(debug_assertions), inline(always))]
const fn term_at<const M: usize>(place: usize) -> usize {
    if M == 1 { 0 } else { place }
}

/// Constants of a term, and its spatial values.
type Folded<E, const M: usize> = [(<E as Effect>::Constants, <E as Term>::Advected); M];

impl<P, E, const M: usize> Placed<P, E, M>
where
    P: Places<E> + Copy + Debug + PartialEq,
    E: Effect,
    E::Retraction: Retraction<P::Group>,
{
    /// The sum of a number of each place.
    fn total(&self, w: &P::Advected, of: impl Fn(&E, &E::Advected, At) -> E::Scalar) -> E::Scalar {
        let mut total = real(0.0);
        P::visit(|at| total += of(self.term(at), &P::seen(w, &self.term(at).advected(), at), at));
        total
    }

    /// The sum of the components at each place.
    fn gathered(&self, w: &P::Advected, of: impl Fn(&E, &E::Advected, At) -> Vector<E>) -> Vector<Self> {
        P::sum(|at| of(self.term(at), &P::seen(w, &self.term(at).advected(), at), at))
    }

    fn term(&self, at: At) -> &E {
        &self.terms[term_at::<M>(at.place)]
    }
}

impl<P, E, const M: usize> Term for Placed<P, E, M>
where
    P: Places<E> + Copy + Debug + PartialEq,
    E: Effect,
    E::Retraction: Retraction<P::Group>,
{
    type Scalar = E::Scalar;
    type Group = P::Group;
    type Advected = P::Advected;

    /// A wrong parameter of a term of several is that of its body, or of the first of its two.
    fn validate(&self) -> Result<(), SetupError> {
        // A term that isn't possible here is refused when the crate is built.
        let _ = <Self as Effect>::PARTS;
        let mut checked = Ok(());
        P::visit(|at| {
            if checked.is_ok() && (at.place < M) {
                checked = self.terms[at.place].validate().map_err(|error| match error {
                    // What is the same at all places is of no body.
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

impl<P, E, const M: usize> Effect for Placed<P, E, M>
where
    P: Places<E> + Copy + Debug + PartialEq,
    E: Effect,
    E::Retraction: Retraction<P::Group>,
{
    type Retraction = E::Retraction;
    type Kinetic = E::Kinetic;
    type Constants = Folded<E, M>;
    type StepTerms = P::Of<E::StepTerms>;

    const PARTS: Parts = {
        assert!(
            P::AT_ONE_BODY || !E::PARTS.unknown || !E::Kinetic::IS_THERE,
            "between the bodies of a system only potentials are possible: this term couples their velocities; declare all of \
             these bodies as one product, `group(F_1 = SO3, F_2 = SO3, …)`, or take `liestep::methods::ChainStepper`"
        );
        assert!(
            P::AT_ONE_BODY || P::LINKS_NEIGHBOURS || !E::PARTS.unknown,
            "this term depends on where two bodies are within the step: put it at neighbours in a row, by \
             `Coupled::<N>::of`, or take the means of what it has at the ends of the step"
        );
        assert!(
            !P::LINKS_NEIGHBOURS || (E::IS_QUADRATIC && E::DENOMINATORS == 0),
            "a term with cleared denominators, or one that isn't quadratic in the velocity, can't join neighbours"
        );
        E::PARTS
    };
    const DENOMINATORS: u32 = E::DENOMINATORS;
    const INERTIA_IS_CONSTANT: bool = E::INERTIA_IS_CONSTANT;
    const IS_QUADRATIC: bool = E::IS_QUADRATIC;
    // What lies between neighbours isn't in the blocks of bodies, which elimination fills.
    const APART: Blocks = if P::LINKS_NEIGHBOURS { Blocks::WHOLE } else { E::APART };
    const LINKS_NEIGHBOURS: bool = P::LINKS_NEIGHBOURS;
    const OPERATIONS: Operations = Operations {
        step: E::OPERATIONS.step.saturating_mul(places_of::<P, E>()),
        iteration: E::OPERATIONS.iteration.saturating_mul(places_of::<P, E>()),
    };
    const DERIVATION: &'static str = "a term at places of a system; see its DERIVATION\n";

    fn derivation() -> String {
        E::derivation()
    }

    #[allow(clippy::cast_precision_loss)] // far fewer than a float counts
    fn describe(&self, visitor: &mut dyn SceneVisitor<Self::Scalar>) {
        visitor.term(P::NAME.0);
        P::NAME.1.iter().for_each(|&body| visitor.parameter("body", real(body as f64)));
        self.terms.iter().for_each(|term| term.describe(visitor));
    }

    fn momentum_jacobian(&self, f: &Matrix<Self>, w: &P::Advected, h: Self::Scalar) -> Square<Self> {
        P::squares(|at| {
            let term = self.term(at);
            term.momentum_jacobian(&P::matrix(f, at), &P::seen(w, &term.advected(), at), h)
        })
    }

    fn inertia(&self, w: &P::Advected) -> Square<Self> {
        P::squares(|at| self.term(at).inertia(&P::seen(w, &self.term(at).advected(), at)))
    }

    fn momentum_bias(&self, w: &P::Advected) -> Vector<Self> {
        self.gathered(w, |term, w, _| term.momentum_bias(w))
    }

    fn potential(&self, w: &P::Advected) -> Self::Scalar {
        self.total(w, |term, w, _| term.potential(w))
    }

    fn limit(&self, velocity: &Vector<Self>, w: &P::Advected) -> Limit<Self> {
        let at_its_place = |at: At| {
            let term = self.term(at);
            term.limit(&P::components(velocity, at), &P::seen(w, &term.advected(), at))
        };
        let mut l = real(0.0);
        P::visit(|at| l += at_its_place(at).l);
        Limit {
            l,
            momentum: P::sum(|at| at_its_place(at).momentum),
            hessian: P::squares(|at| at_its_place(at).hessian),
        }
    }

    fn constants(&self, h: Self::Scalar) -> Self::Constants {
        self.terms.each_ref().map(|term| (term.constants(h), term.advected()))
    }

    fn are_finite(constants: &Self::Constants) -> bool {
        constants.iter().all(|(constants, _)| E::are_finite(constants))
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn kick_before(constants: &Self::Constants, w: &P::Advected) -> Vector<Self> {
        P::sum(|at| {
            let (constants, spatial) = &constants[term_at::<M>(at.place)];
            E::kick_before(constants, &P::seen(w, spatial, at))
        })
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn kick_derivative(constants: &Self::Constants, w: &P::Advected, velocity: &Vector<Self>) -> Option<Vector<Self>> {
        let mut is_known = true;
        let all = P::sum(|at| {
            let (constants, spatial) = &constants[term_at::<M>(at.place)];
            let part = E::kick_derivative(constants, &P::seen(w, spatial, at), &P::components(velocity, at));
            is_known &= part.is_some();
            part.unwrap_or_else(Vector::<E>::zero)
        });
        is_known.then_some(all)
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn step_terms(constants: &Self::Constants, a: &Vector<Self>, w: &P::Advected) -> Self::StepTerms {
        P::gather(|at| {
            let (constants, spatial) = &constants[term_at::<M>(at.place)];
            E::step_terms(constants, &P::components(a, at), &P::seen(w, spatial, at))
        })
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn newton_system(
        constants: &Self::Constants,
        terms: &Self::StepTerms,
        half: &Vector<Self>,
    ) -> (Vector<Self>, Square<Self>) {
        P::system(|at| {
            let (constants, _) = &constants[term_at::<M>(at.place)];
            E::newton_system(constants, &terms.as_ref()[at.place], &P::components(half, at))
        })
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn newton_linked(
        constants: &Self::Constants,
        terms: &Self::StepTerms,
        half: &Vector<Self>,
        links: &mut Links<Self>,
    ) -> (Vector<Self>, Square<Self>) {
        P::linked(links, |at| {
            let (constants, _) = &constants[term_at::<M>(at.place)];
            E::newton_system(constants, &terms.as_ref()[at.place], &P::components(half, at))
        })
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn newton_update(
        constants: &Self::Constants,
        terms: &Self::StepTerms,
        half: &Vector<Self>,
    ) -> NewtonUpdate<Vector<Self>, Square<Self>, Self::Scalar> {
        P::newton_update(pattern::<Self>(), |at| {
            let (constants, _) = &constants[term_at::<M>(at.place)];
            E::newton_system(constants, &terms.as_ref()[at.place], &P::components(half, at))
        })
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn newton_residual(
        constants: &Self::Constants,
        terms: &Self::StepTerms,
        half: &Vector<Self>,
    ) -> Residual<Vector<Self>> {
        let momentum_defect = P::sum(|at| {
            let (constants, _) = &constants[term_at::<M>(at.place)];
            E::newton_residual(constants, &terms.as_ref()[at.place], &P::components(half, at)).momentum_defect
        });
        Residual { momentum_defect, moving_kick: None }
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn kick_after(constants: &Self::Constants, increment: &Matrix<Self>, next: &P::Advected) -> Vector<Self> {
        P::sum(|at| {
            let (constants, spatial) = &constants[term_at::<M>(at.place)];
            E::kick_after(constants, &P::matrix(increment, at), &P::seen(next, spatial, at))
        })
    }
}

/// How many there are, as operations are counted.
#[allow(clippy::cast_possible_truncation)] // far fewer
const fn places_of<P: Places<E>, E: Effect>() -> u32 {
    P::PLACES as u32
}

impl<P, E, const M: usize> DiscreteLagrangian for Placed<P, E, M>
where
    P: Places<E> + Copy + Debug + PartialEq,
    E: DiscreteLagrangian,
    E::Retraction: Retraction<P::Group>,
{
    const SELF_ADJOINT: bool = E::SELF_ADJOINT;

    fn l_d(&self, f: &Matrix<Self>, w: &P::Advected, h: Self::Scalar) -> Self::Scalar {
        self.total(w, |term, w, at| term.l_d(&P::matrix(f, at), w, h))
    }

    fn right_momentum(&self, f: &Matrix<Self>, w: &P::Advected, h: Self::Scalar) -> Vector<Self> {
        self.gathered(w, |term, w, at| term.right_momentum(&P::matrix(f, at), w, h))
    }

    fn left_momentum(&self, f: &Matrix<Self>, w: &P::Advected, h: Self::Scalar) -> Vector<Self> {
        self.gathered(w, |term, w, at| term.left_momentum(&P::matrix(f, at), w, h))
    }

    fn diamond(&self, f: &Matrix<Self>, w: &P::Advected, h: Self::Scalar) -> Vector<Self> {
        self.gathered(w, |term, w, at| term.diamond(&P::matrix(f, at), w, h))
    }

    fn legendre_minus(&self, f: &Matrix<Self>, w: &P::Advected, h: Self::Scalar) -> Vector<Self> {
        self.gathered(w, |term, w, at| term.legendre_minus(&P::matrix(f, at), w, h))
    }

    fn discrete_energy(&self, f: &Matrix<Self>, w: &P::Advected, h: Self::Scalar) -> Self::Scalar {
        self.total(w, |term, w, at| term.discrete_energy(&P::matrix(f, at), w, h))
    }
}
