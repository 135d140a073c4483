//! The effect of terms placed in a system of bodies: sums over their places.

use core::fmt::Debug;

use super::places::{At, Places};
use super::{Placement, TermConstants, term_at};
use crate::groups::Retraction;
use crate::mechanics::description::SceneVisitor;
use crate::mechanics::effect::{Effect, Limit, Links, Matrix, NewtonUpdate, Square, Vector, pattern};
use crate::mechanics::facts::Facts;
use crate::mechanics::lagrangian::DiscreteLagrangian;
use crate::mechanics::operations::Operations;
use crate::numbers::{Blocks, Coordinates as _, real};

impl<P, E, const M: usize> Placement<P, E, M>
where
    P: Places<E> + Copy + Debug + PartialEq,
    E: Effect,
    E::Retraction: Retraction<P::Group>,
{
    /// The sum of one number for each place.
    fn total(&self, w: &P::Advected, of: impl Fn(&E, &E::Advected, At) -> E::Scalar) -> E::Scalar {
        let mut total = real(0.0);
        P::visit(|at| total += of(self.term(at), &P::seen(w, &self.term(at).advected(), at), at));
        total
    }

    /// The sum of component vectors, one for each place.
    fn gathered(&self, w: &P::Advected, of: impl Fn(&E, &E::Advected, At) -> Vector<E>) -> Vector<Self> {
        P::sum(|at| of(self.term(at), &P::seen(w, &self.term(at).advected(), at), at))
    }

    fn term(&self, at: At) -> &E {
        &self.terms[term_at::<M>(at.place)]
    }

    /// Residual and Jacobian at each place.
    #[hot]
    fn systems(
        constants: &TermConstants<E, M>,
        terms: &P::Of<E::StepTerms>,
        half: &Vector<Self>,
    ) -> impl Fn(At) -> (Vector<E>, Square<E>) {
        #[cfg_attr(not(debug_assertions), inline(always))]
        move |at| {
            let (constants, _) = &constants[term_at::<M>(at.place)];
            E::newton_system(constants, &terms.as_ref()[at.place], &P::components(half, at))
        }
    }
}

#[hot]
impl<P, E, const M: usize> Effect for Placement<P, E, M>
where
    P: Places<E> + Copy + Debug + PartialEq,
    E: Effect,
    E::Retraction: Retraction<P::Group>,
{
    type Retraction = E::Retraction;
    type Kinetic = E::Kinetic;
    type Constants = TermConstants<E, M>;
    type StepTerms = P::Of<E::StepTerms>;

    const FACTS: Facts = Facts {
        // Elimination fills the blocks of bodies by those between neighbours.
        apart: if P::LINKS_NEIGHBOURS { Blocks::WHOLE } else { E::FACTS.apart },
        links_neighbours: P::LINKS_NEIGHBOURS,
        operations: Operations {
            step: E::FACTS.operations.step.saturating_mul(places_of::<P, E>()),
            iteration: E::FACTS.operations.iteration.saturating_mul(places_of::<P, E>()),
        },
        ..E::FACTS
    };
    const DERIVATION: &'static str = "a term at places of a system; see its DERIVATION\n";

    #[allow(clippy::cast_precision_loss)] // far fewer than a float counts
    #[inline]
    fn describe(&self, visitor: &mut dyn SceneVisitor<Self::Scalar>) {
        visitor.term(P::NAME.0);
        P::NAME.1.iter().for_each(|&body| visitor.parameter("body", real(body as f64)));
        self.terms.iter().for_each(|term| term.describe(visitor));
    }

    #[inline]
    fn momentum_jacobian(&self, f: &Matrix<Self>, w: &P::Advected, h: Self::Scalar) -> Square<Self> {
        P::squares(|at| {
            let term = self.term(at);
            term.momentum_jacobian(&P::matrix(f, at), &P::seen(w, &term.advected(), at), h)
        })
    }

    fn limit(&self, velocity: Option<&Vector<Self>>, w: &P::Advected) -> Limit<Self> {
        let at_its_place = |at: At| {
            let (term, velocity) = (self.term(at), velocity.map(|velocity| P::components(velocity, at)));
            term.limit(velocity.as_ref(), &P::seen(w, &term.advected(), at))
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

    fn kick_before(constants: &Self::Constants, w: &P::Advected) -> Vector<Self> {
        P::sum(
            #[cfg_attr(not(debug_assertions), inline(always))]
            |at| {
                let (constants, spatial) = &constants[term_at::<M>(at.place)];
                E::kick_before(constants, &P::seen(w, spatial, at))
            },
        )
    }

    fn kick_derivative(constants: &Self::Constants, w: &P::Advected, velocity: &Vector<Self>) -> Option<Vector<Self>> {
        let mut is_known = true;
        let all = P::sum(
            #[cfg_attr(not(debug_assertions), inline(always))]
            |at| {
                let (constants, spatial) = &constants[term_at::<M>(at.place)];
                let part = E::kick_derivative(constants, &P::seen(w, spatial, at), &P::components(velocity, at));
                is_known &= part.is_some();
                part.unwrap_or_else(Vector::<E>::zero)
            },
        );
        is_known.then_some(all)
    }

    fn step_terms(constants: &Self::Constants, a: &Vector<Self>, w: &P::Advected) -> Self::StepTerms {
        P::gather(
            #[cfg_attr(not(debug_assertions), inline(always))]
            |at| {
                let (constants, spatial) = &constants[term_at::<M>(at.place)];
                // The momenta of two bodies are balanced by the kinetic parts of each.
                let a = if P::AT_ONE_BODY { P::components(a, at) } else { Vector::<E>::zero() };
                E::step_terms(constants, &a, &P::seen(w, spatial, at))
            },
        )
    }

    fn remainder(constants: &Self::Constants, a: &Vector<Self>) -> Vector<Self> {
        P::replaced(
            a,
            #[cfg_attr(not(debug_assertions), inline(always))]
            |at| E::remainder(&constants[term_at::<M>(at.place)].0, &P::components(a, at)),
        )
    }

    fn newton_system(
        constants: &Self::Constants,
        terms: &Self::StepTerms,
        half: &Vector<Self>,
    ) -> (Vector<Self>, Square<Self>) {
        P::system(Self::systems(constants, terms, half))
    }

    fn newton_linked(
        constants: &Self::Constants,
        terms: &Self::StepTerms,
        half: &Vector<Self>,
        links: &mut Links<Self>,
    ) -> (Vector<Self>, Square<Self>) {
        P::linked(links, Self::systems(constants, terms, half))
    }

    fn newton_update(
        constants: &Self::Constants,
        terms: &Self::StepTerms,
        half: &Vector<Self>,
    ) -> NewtonUpdate<Vector<Self>, Square<Self>, Self::Scalar> {
        P::newton_update(pattern::<Self>(), Self::systems(constants, terms, half))
    }

    fn newton_residual(constants: &Self::Constants, terms: &Self::StepTerms, half: &Vector<Self>) -> Vector<Self> {
        P::sum(
            #[cfg_attr(not(debug_assertions), inline(always))]
            |at| {
                let (constants, _) = &constants[term_at::<M>(at.place)];
                E::newton_residual(constants, &terms.as_ref()[at.place], &P::components(half, at))
            },
        )
    }

    fn kick_after(constants: &Self::Constants, increment: &Matrix<Self>, next: &P::Advected) -> Vector<Self> {
        P::sum(
            #[cfg_attr(not(debug_assertions), inline(always))]
            |at| {
                let (constants, spatial) = &constants[term_at::<M>(at.place)];
                E::kick_after(constants, &P::matrix(increment, at), &P::seen(next, spatial, at))
            },
        )
    }
}

/// The number of places, in the type of operation counts.
#[allow(clippy::cast_possible_truncation)] // far fewer
const fn places_of<P: Places<E>, E: Effect>() -> u32 {
    P::PLACES as u32
}

/// Writes functions that add up the terms at all places. Each line has the method of [`Placement`] that adds, the functions,
/// and what they return.
macro_rules! summed {
    ($($sum:ident: $($name:ident)+ -> $result:ty;)+) => {$($(
        fn $name(&self, f: &Matrix<Self>, w: &P::Advected, h: Self::Scalar) -> $result {
            self.$sum(w, |term, w, at| term.$name(&P::matrix(f, at), w, h))
        }
    )+)+};
}

impl<P, E, const M: usize> DiscreteLagrangian for Placement<P, E, M>
where
    P: Places<E> + Copy + Debug + PartialEq,
    E: DiscreteLagrangian,
    E::Retraction: Retraction<P::Group>,
{
    summed! {
        total: l_d discrete_energy -> Self::Scalar;
        gathered: right_momentum left_momentum diamond legendre_minus -> Vector<Self>;
    }
}
