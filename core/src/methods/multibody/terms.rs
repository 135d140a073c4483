//! Terms on one body and between two, as values of any type.

use alloc::string::String;
use alloc::sync::Arc;

use nalgebra::{Matrix6, SimdComplexField as _, Vector6};

use super::part::BodyPart;
use super::{Body, Increment};
use crate::error::SetupError;
use crate::groups::{Advected as _, CayleyRetraction, LieGroup, Pair, SquareOf};
use crate::mechanics::{Effect, SceneVisitor, derivation};
use crate::numbers::Coordinates as _;

/// The blocks of a matrix of two bodies, row by row.
pub(super) type Blocks = [[Matrix6<f64>; 2]; 2];

/// The Lagrangian of the continuous limit at rest, and its first and second derivatives by the velocity.
pub(super) type AtRest<V, S> = (f64, V, S);

/// An effect on one body with its folded constants.
pub(super) trait BodyTerm: Send + Sync {
    fn validate(&self) -> Result<(), SetupError>;

    /// The term with its constants folded for another step.
    fn refolded(&self, h: f64) -> Arc<dyn BodyTerm>;

    /// Whether the constants of this step are finite.
    fn is_finite(&self) -> bool;

    /// Whether the term has a part of the equation for the increment.
    fn has_unknown(&self) -> bool;

    fn kick_before(&self, now: &Body) -> Option<Vector6<f64>>;

    /// The kick after a step with this increment to this place.
    fn kick_after(&self, increment: &Increment, next: &Body) -> Option<Vector6<f64>>;

    /// Writes residual and Jacobian of [`Effect::newton_system`], without denominators.
    fn write_newton(
        &self,
        now: &Body,
        a: &Vector6<f64>,
        half: &Vector6<f64>,
        to: (&mut Vector6<f64>, &mut Matrix6<f64>),
    );

    /// The residual alone.
    fn newton_residual(&self, now: &Body, a: &Vector6<f64>, half: &Vector6<f64>) -> Vector6<f64>;

    /// The part of `a` that the next term of the body takes.
    fn remainder(&self, a: &Vector6<f64>) -> Vector6<f64>;

    /// The Lagrangian, the momentum and the inertia of the continuous limit at rest.
    fn at_rest(&self, now: &Body) -> AtRest<Vector6<f64>, Matrix6<f64>>;

    fn derivation(&self) -> String;

    fn describe(&self, visitor: &mut dyn SceneVisitor<f64>);
}

/// An effect between two bodies with its folded constants. Its ends are at the bodies, or at space.
pub(super) trait PairTerm: Send + Sync {
    fn validate(&self) -> Result<(), SetupError>;

    fn refolded(&self, h: f64) -> Arc<dyn PairTerm>;

    fn is_finite(&self) -> bool;

    /// Whether the term couples the equations for the increments of its bodies.
    fn has_unknown(&self) -> bool;

    fn kick_before(&self, now: [&Body; 2]) -> Option<[Vector6<f64>; 2]>;

    fn kick_after(&self, increments: [&Increment; 2], next: [&Body; 2]) -> Option<[Vector6<f64>; 2]>;

    /// Residual and Jacobian of both bodies, for `a = 0`: their momenta are balanced by the terms of each.
    fn newton_system(&self, now: [&Body; 2], halves: [&Vector6<f64>; 2]) -> ([Vector6<f64>; 2], Blocks);

    fn newton_residual(&self, now: [&Body; 2], halves: [&Vector6<f64>; 2]) -> [Vector6<f64>; 2];

    fn at_rest(&self, now: [&Body; 2]) -> AtRest<[Vector6<f64>; 2], Blocks>;

    fn derivation(&self) -> String;

    fn describe(&self, visitor: &mut dyn SceneVisitor<f64>);
}

/// An effect, and its constants for a step.
struct StepEffect<E: Effect> {
    term: Arc<E>,
    spatial: E::Advected,
    constants: E::Constants,
}

/// A term on one body. Two wrappers are two implementations: a type may be a body and a pair of bodies at once.
struct OnBody<E: Effect>(StepEffect<E>);

/// A term between two bodies.
struct OnPair<E: Effect>(StepEffect<E>);

impl<E: Effect<Scalar = f64>> StepEffect<E> {
    fn of(term: Arc<E>, h: f64) -> Self {
        Self { spatial: term.advected(), constants: term.constants(h), term }
    }

    fn refolded(&self, h: f64) -> Self {
        Self::of(Arc::clone(&self.term), h)
    }

    fn seen(&self, from: &E::Group) -> E::Advected {
        self.spatial.seen_from(from)
    }

    fn newton_system(&self, now: &E::Group, a: &VectorOf<E>, half: &VectorOf<E>) -> (VectorOf<E>, SquareOf<E::Group>) {
        let terms = E::step_terms(&self.constants, a, &self.seen(now));
        let (residual, jacobian) = E::newton_system(&self.constants, &terms, half);
        let power = E::FACTS.denominators;
        if power == 0 {
            return (residual, jacobian);
        }
        // For R = Dⁿ r with D = 1 + |y|² the derivative of r is R'/Dⁿ − (2n/D) r yᵀ.
        let d = half.dot(half) + 1.0;
        let below = 1.0 / d.simd_powi(power.cast_signed());
        let residual = residual * below;
        (residual, jacobian * below + residual.outer(half) * (-2.0 * f64::from(power) / d))
    }

    fn newton_residual(&self, now: &E::Group, a: &VectorOf<E>, half: &VectorOf<E>) -> VectorOf<E> {
        let terms = E::step_terms(&self.constants, a, &self.seen(now));
        let residual = E::newton_residual(&self.constants, &terms, half);
        match E::FACTS.denominators {
            0 => residual,
            power => residual * (1.0 / (half.dot(half) + 1.0).simd_powi(power.cast_signed())),
        }
    }
}

/// The components of an effect's group.
type VectorOf<E> = <<E as crate::mechanics::Term>::Group as LieGroup>::Vector;

/// The body of a pair.
type BodyOf<E> = <<E as crate::mechanics::Term>::Group as Pair>::Body;

/// The message of a constraint on velocities, whose reactions a step of jointed bodies doesn't have.
const CONSTRAINED: &str = "jointed bodies have no constraints on velocities; a `Stepper` of one scene has them";

const NOT_QUADRATIC: &str = "systems hold terms whose continuous limit is quadratic in the velocity";

/// The term on a body, with constants for a step of 1 s.
pub(super) fn of_body<E>(term: E) -> Arc<dyn BodyTerm>
where
    E: Effect<Scalar = f64, Group: BodyPart, Retraction = CayleyRetraction> + Send + Sync + 'static,
    E::Constants: Send + Sync,
    E::Advected: Send + Sync,
{
    const { assert!(E::FACTS.is_quadratic, "{}", NOT_QUADRATIC) }
    const { assert!(E::FACTS.constraints == 0, "{}", CONSTRAINED) }
    Arc::new(OnBody(StepEffect::of(Arc::new(term), 1.0)))
}

/// The term between two bodies, with constants for a step of 1 s.
pub(super) fn of_pair<E>(term: E) -> Arc<dyn PairTerm>
where
    E: Effect<Scalar = f64, Group: Pair<Body: BodyPart>, Retraction = CayleyRetraction> + Send + Sync + 'static,
    E::Constants: Send + Sync,
    E::Advected: Send + Sync,
{
    const { assert!(E::FACTS.is_quadratic, "{}", NOT_QUADRATIC) }
    const { assert!(E::FACTS.constraints == 0, "{}", CONSTRAINED) }
    Arc::new(OnPair(StepEffect::of(Arc::new(term), 1.0)))
}

impl<E> BodyTerm for OnBody<E>
where
    E: Effect<Scalar = f64, Group: BodyPart, Retraction = CayleyRetraction> + Send + Sync + 'static,
    E::Constants: Send + Sync,
    E::Advected: Send + Sync,
{
    fn validate(&self) -> Result<(), SetupError> {
        self.0.term.validate()
    }

    fn refolded(&self, h: f64) -> Arc<dyn BodyTerm> {
        Arc::new(Self(self.0.refolded(h)))
    }

    fn is_finite(&self) -> bool {
        E::are_finite(&self.0.constants)
    }

    fn has_unknown(&self) -> bool {
        E::FACTS.parts.unknown
    }

    fn kick_before(&self, now: &Body) -> Option<Vector6<f64>> {
        let StepEffect { constants, .. } = &self.0;
        let kick = || E::Group::in_body(&E::kick_before(constants, &self.0.seen(&E::Group::of(now))));
        E::FACTS.parts.kick_before.then(kick)
    }

    fn kick_after(&self, increment: &Increment, next: &Body) -> Option<Vector6<f64>> {
        let StepEffect { constants, .. } = &self.0;
        let increment = || E::Group::of_increment(increment);
        let kick = || E::Group::in_body(&E::kick_after(constants, &increment(), &self.0.seen(&E::Group::of(next))));
        E::FACTS.parts.kick_after.then(kick)
    }

    fn write_newton(
        &self,
        now: &Body,
        a: &Vector6<f64>,
        half: &Vector6<f64>,
        to: (&mut Vector6<f64>, &mut Matrix6<f64>),
    ) {
        let (now, [a, half]) = (E::Group::of(now), [a, half].map(E::Group::of_components));
        let (residual, jacobian) = self.0.newton_system(&now, &a, &half);
        (*to.0, *to.1) = (E::Group::in_body(&residual), E::Group::square_in_body(&jacobian));
    }

    fn newton_residual(&self, now: &Body, a: &Vector6<f64>, half: &Vector6<f64>) -> Vector6<f64> {
        let (now, [a, half]) = (E::Group::of(now), [a, half].map(E::Group::of_components));
        E::Group::in_body(&self.0.newton_residual(&now, &a, &half))
    }

    fn remainder(&self, a: &Vector6<f64>) -> Vector6<f64> {
        let part = E::Group::of_components(a);
        let taken = part - E::remainder(&self.0.constants, &part);
        a - E::Group::in_body(&taken)
    }

    fn at_rest(&self, now: &Body) -> AtRest<Vector6<f64>, Matrix6<f64>> {
        let limit = self.0.term.limit(None, &self.0.seen(&E::Group::of(now)));
        (limit.l, E::Group::in_body(&limit.momentum), E::Group::square_in_body(&limit.hessian))
    }

    fn derivation(&self) -> String {
        derivation(&*self.0.term)
    }

    fn describe(&self, visitor: &mut dyn SceneVisitor<f64>) {
        self.0.term.describe(visitor);
    }
}

/// The configuration of two bodies, as far as the term depends on it.
fn both<G: Pair<Body: BodyPart>>([first, second]: [&Body; 2]) -> G {
    G::pair(&G::Body::of(first), &G::Body::of(second))
}

/// The components of two bodies, as far as the term depends on them.
fn joined<G: Pair<Body: BodyPart>>([first, second]: [&Vector6<f64>; 2]) -> G::Vector {
    G::joined(&G::Body::of_components(first), &G::Body::of_components(second))
}

/// The components of each body.
fn apart<G: Pair<Body: BodyPart>>(components: &G::Vector) -> [Vector6<f64>; 2] {
    G::parts(components).map(|part| G::Body::in_body(&part))
}

impl<E> PairTerm for OnPair<E>
where
    E: Effect<Scalar = f64, Group: Pair<Body: BodyPart>, Retraction = CayleyRetraction> + Send + Sync + 'static,
    E::Constants: Send + Sync,
    E::Advected: Send + Sync,
{
    fn validate(&self) -> Result<(), SetupError> {
        self.0.term.validate()
    }

    fn refolded(&self, h: f64) -> Arc<dyn PairTerm> {
        Arc::new(Self(self.0.refolded(h)))
    }

    fn is_finite(&self) -> bool {
        E::are_finite(&self.0.constants)
    }

    fn has_unknown(&self) -> bool {
        E::FACTS.parts.unknown
    }

    fn kick_before(&self, now: [&Body; 2]) -> Option<[Vector6<f64>; 2]> {
        let StepEffect { constants, .. } = &self.0;
        let kick = || apart::<E::Group>(&E::kick_before(constants, &self.0.seen(&both(now))));
        E::FACTS.parts.kick_before.then(kick)
    }

    fn kick_after(&self, increments: [&Increment; 2], next: [&Body; 2]) -> Option<[Vector6<f64>; 2]> {
        let StepEffect { constants, .. } = &self.0;
        E::FACTS.parts.kick_after.then(|| {
            let [first, second] = increments.map(<BodyOf<E> as BodyPart>::of_increment);
            let increment = E::Group::matrices(&first, &second);
            apart::<E::Group>(&E::kick_after(constants, &increment, &self.0.seen(&both(next))))
        })
    }

    fn newton_system(&self, now: [&Body; 2], halves: [&Vector6<f64>; 2]) -> ([Vector6<f64>; 2], Blocks) {
        let zero = VectorOf::<E>::zero();
        let (residual, jacobian) = self.0.newton_system(&both(now), &zero, &joined::<E::Group>(halves));
        (apart::<E::Group>(&residual), blocks::<E::Group>(&jacobian))
    }

    fn newton_residual(&self, now: [&Body; 2], halves: [&Vector6<f64>; 2]) -> [Vector6<f64>; 2] {
        let zero = VectorOf::<E>::zero();
        apart::<E::Group>(&self.0.newton_residual(&both(now), &zero, &joined::<E::Group>(halves)))
    }

    fn at_rest(&self, now: [&Body; 2]) -> AtRest<[Vector6<f64>; 2], Blocks> {
        let limit = self.0.term.limit(None, &self.0.seen(&both(now)));
        (limit.l, apart::<E::Group>(&limit.momentum), blocks::<E::Group>(&limit.hessian))
    }

    fn derivation(&self) -> String {
        derivation(&*self.0.term)
    }

    fn describe(&self, visitor: &mut dyn SceneVisitor<f64>) {
        self.0.term.describe(visitor);
    }
}

/// The four blocks of a matrix of two bodies.
fn blocks<G: Pair<Body: BodyPart>>(matrix: &SquareOf<G>) -> Blocks {
    G::blocks(matrix).map(|row| row.map(|block| G::Body::square_in_body(&block)))
}

/// The configuration of space.
pub(super) fn space() -> Body {
    Body::identity()
}
