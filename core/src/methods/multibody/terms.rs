//! Terms on one body and between two, as values of any type.

use alloc::string::String;
use alloc::sync::Arc;

use nalgebra::{Matrix6, Vector6};

use super::{Body, Increment};
use crate::error::SetupError;
use crate::groups::{Advected as _, CayleyRetraction, LieGroup as _, Pair, R3, SO3};
use crate::mechanics::{Effect, SceneVisitor};

/// The group of two bodies.
type TwoBodies = (SO3, R3, SO3, R3);

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

    /// Residual and Jacobian of [`Effect::newton_system`].
    fn newton_system(&self, now: &Body, a: &Vector6<f64>, half: &Vector6<f64>) -> (Vector6<f64>, Matrix6<f64>);

    /// The residual alone.
    fn newton_residual(&self, now: &Body, a: &Vector6<f64>, half: &Vector6<f64>) -> Vector6<f64>;

    /// The part of `a` that the next term of the body takes.
    fn remainder(&self, a: &Vector6<f64>) -> Vector6<f64>;

    /// The Lagrangian, the momentum and the inertia of the continuous limit at rest.
    fn at_rest(&self, now: &Body) -> (f64, Vector6<f64>, Matrix6<f64>);

    fn derivation(&self) -> String;

    fn describe(&self, visitor: &mut dyn SceneVisitor<f64>);
}

/// An effect between two bodies with its folded constants. Its ends are at the bodies, or at space.
pub(super) trait PairTerm: Send + Sync {
    fn validate(&self) -> Result<(), SetupError>;

    fn refolded(&self, h: f64) -> Arc<dyn PairTerm>;

    fn is_finite(&self) -> bool;

    fn kick_before(&self, now: [&Body; 2]) -> Option<[Vector6<f64>; 2]>;

    fn kick_after(&self, increments: [&Increment; 2], next: [&Body; 2]) -> Option<[Vector6<f64>; 2]>;

    fn potential(&self, now: [&Body; 2]) -> f64;

    fn derivation(&self) -> String;

    fn describe(&self, visitor: &mut dyn SceneVisitor<f64>);
}

/// An effect, and its constants for a step.
struct Folded<E: Effect> {
    term: Arc<E>,
    spatial: E::Advected,
    constants: E::Constants,
}

impl<E: Effect<Scalar = f64>> Folded<E> {
    fn of(term: Arc<E>, h: f64) -> Self {
        Self { spatial: term.advected(), constants: term.constants(h), term }
    }
}

/// The term on a body, with constants for a step of 1 s.
pub(super) fn of_body<E>(term: E) -> Arc<dyn BodyTerm>
where
    E: Effect<Scalar = f64, Group = Body, Retraction = CayleyRetraction> + Send + Sync + 'static,
    E::Constants: Send + Sync,
    E::Advected: Send + Sync,
{
    const {
        assert!(E::DENOMINATORS == 0, "a term with cleared denominators has another residual than joints are added to");
        assert!(E::IS_QUADRATIC, "joints hold bodies whose continuous limit is quadratic in the velocity");
    }
    Arc::new(Folded::of(Arc::new(term), 1.0))
}

/// The term between two bodies, with constants for a step of 1 s.
pub(super) fn of_pair<E>(term: E) -> Arc<dyn PairTerm>
where
    E: Effect<Scalar = f64, Group = TwoBodies, Retraction = CayleyRetraction> + Send + Sync + 'static,
    E::Constants: Send + Sync,
    E::Advected: Send + Sync,
{
    const {
        assert!(
            !E::PARTS.unknown,
            "between bodies only potentials of the ends of a step are possible: this term couples their equations"
        );
    }
    Arc::new(Folded::of(Arc::new(term), 1.0))
}

impl<E> BodyTerm for Folded<E>
where
    E: Effect<Scalar = f64, Group = Body, Retraction = CayleyRetraction> + Send + Sync + 'static,
    E::Constants: Send + Sync,
    E::Advected: Send + Sync,
{
    fn validate(&self) -> Result<(), SetupError> {
        self.term.validate()
    }

    fn refolded(&self, h: f64) -> Arc<dyn BodyTerm> {
        Arc::new(Self::of(Arc::clone(&self.term), h))
    }

    fn is_finite(&self) -> bool {
        E::are_finite(&self.constants)
    }

    fn has_unknown(&self) -> bool {
        E::parts(&self.constants).unknown
    }

    fn kick_before(&self, now: &Body) -> Option<Vector6<f64>> {
        let has_part = E::parts(&self.constants).kick_before;
        has_part.then(|| E::kick_before(&self.constants, &self.spatial.seen_from(now)))
    }

    fn kick_after(&self, increment: &Increment, next: &Body) -> Option<Vector6<f64>> {
        let has_part = E::parts(&self.constants).kick_after;
        has_part.then(|| E::kick_after(&self.constants, increment, &self.spatial.seen_from(next)))
    }

    fn newton_system(&self, now: &Body, a: &Vector6<f64>, half: &Vector6<f64>) -> (Vector6<f64>, Matrix6<f64>) {
        let terms = E::step_terms(&self.constants, a, &self.spatial.seen_from(now));
        E::newton_system(&self.constants, &terms, half)
    }

    fn newton_residual(&self, now: &Body, a: &Vector6<f64>, half: &Vector6<f64>) -> Vector6<f64> {
        let terms = E::step_terms(&self.constants, a, &self.spatial.seen_from(now));
        E::newton_residual(&self.constants, &terms, half)
    }

    fn remainder(&self, a: &Vector6<f64>) -> Vector6<f64> {
        E::remainder(&self.constants, a)
    }

    fn at_rest(&self, now: &Body) -> (f64, Vector6<f64>, Matrix6<f64>) {
        let limit = self.term.limit(None, &self.spatial.seen_from(now));
        (limit.l, limit.momentum, limit.hessian)
    }

    fn derivation(&self) -> String {
        self.term.derivation()
    }

    fn describe(&self, visitor: &mut dyn SceneVisitor<f64>) {
        self.term.describe(visitor);
    }
}

impl<E> PairTerm for Folded<E>
where
    E: Effect<Scalar = f64, Group = TwoBodies, Retraction = CayleyRetraction> + Send + Sync + 'static,
    E::Constants: Send + Sync,
    E::Advected: Send + Sync,
{
    fn validate(&self) -> Result<(), SetupError> {
        self.term.validate()
    }

    fn refolded(&self, h: f64) -> Arc<dyn PairTerm> {
        Arc::new(Self::of(Arc::clone(&self.term), h))
    }

    fn is_finite(&self) -> bool {
        E::are_finite(&self.constants)
    }

    fn kick_before(&self, [first, second]: [&Body; 2]) -> Option<[Vector6<f64>; 2]> {
        E::parts(&self.constants).kick_before.then(|| {
            let seen = self.spatial.seen_from(&TwoBodies::pair(first, second));
            TwoBodies::parts(&E::kick_before(&self.constants, &seen))
        })
    }

    fn kick_after(&self, increments: [&Increment; 2], [first, second]: [&Body; 2]) -> Option<[Vector6<f64>; 2]> {
        E::parts(&self.constants).kick_after.then(|| {
            let seen = self.spatial.seen_from(&TwoBodies::pair(first, second));
            let both = TwoBodies::matrices(increments[0], increments[1]);
            TwoBodies::parts(&E::kick_after(&self.constants, &both, &seen))
        })
    }

    fn potential(&self, [first, second]: [&Body; 2]) -> f64 {
        self.term.potential(&self.spatial.seen_from(&TwoBodies::pair(first, second)))
    }

    fn derivation(&self) -> String {
        self.term.derivation()
    }

    fn describe(&self, visitor: &mut dyn SceneVisitor<f64>) {
        self.term.describe(visitor);
    }
}

/// The configuration of space.
pub(super) fn space() -> Body {
    Body::identity()
}
