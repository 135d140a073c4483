//! Terms on one body and between two, as values of any type.

use alloc::string::String;
use alloc::sync::Arc;
use core::array;

use nalgebra::{Matrix6, SimdComplexField as _, Vector6};

use super::part::BodyPart;
use super::{Body, Increment};
use crate::error::SetupError;
use crate::groups::{Advected as _, CayleyRetraction, LieGroup, SquareOf};
use crate::mechanics::{Effect, SceneVisitor, derivation};
use crate::numbers::Coordinates as _;

/// The blocks of a matrix of `N` bodies, row by row.
pub(super) type Blocks<const N: usize> = [[Matrix6<f64>; N]; N];

/// The Lagrangian of the continuous limit at rest, and its first and second derivatives by the velocity.
pub(super) type AtRest<const N: usize> = (f64, [Vector6<f64>; N], Blocks<N>);

/// A term on one body, or between two, with its constants for a step. The ends of one between two are at bodies, or at space.
pub(super) trait PlacedTerm<const N: usize>: Send + Sync {
    fn validate(&self) -> Result<(), SetupError>;

    /// The term with its constants folded for another step.
    fn refolded(&self, h: f64) -> Arc<dyn PlacedTerm<N>>;

    /// Whether the constants of this step are finite.
    fn is_finite(&self) -> bool;

    /// Whether a step of `−h` undoes what the term does in one of `h`.
    fn is_self_adjoint(&self) -> bool;

    /// Whether the term has a part of the equations for the increments.
    fn has_unknown(&self) -> bool;

    fn kick_before(&self, now: [&Body; N]) -> Option<[Vector6<f64>; N]>;

    /// The kicks after a step with these increments to these places.
    fn kick_after(&self, increments: [&Increment; N], next: [&Body; N]) -> Option<[Vector6<f64>; N]>;

    /// Writes residual and Jacobian of [`Effect::newton_system`], without denominators. The side `a` is zero for a term
    /// between two bodies: their momenta are balanced by the terms of each.
    fn write_newton(
        &self,
        now: [&Body; N],
        sides: [[&Vector6<f64>; N]; 2],
        to: (&mut [Vector6<f64>; N], &mut Blocks<N>),
    );

    /// The residual alone.
    fn newton_residual(&self, now: [&Body; N], sides: [[&Vector6<f64>; N]; 2]) -> [Vector6<f64>; N];

    /// The part of `a` that the next term of the body takes.
    fn remainder(&self, a: [&Vector6<f64>; N]) -> [Vector6<f64>; N];

    /// The Lagrangian, the momenta and the inertia of the continuous limit at rest.
    fn at_rest(&self, now: [&Body; N]) -> AtRest<N>;

    fn derivation(&self) -> String;

    fn describe(&self, visitor: &mut dyn SceneVisitor<f64>);
}

/// An effect, and its constants for a step.
struct StepEffect<E: Effect> {
    term: Arc<E>,
    spatial: E::Advected,
    constants: E::Constants,
}

impl<E: Effect<Scalar = f64>> StepEffect<E> {
    fn of(term: Arc<E>, h: f64) -> Self {
        Self { spatial: term.advected(), constants: term.constants(h), term }
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

/// The message of a constraint on velocities, whose reactions a step of jointed bodies doesn't have.
const CONSTRAINED: &str = "jointed bodies have no constraints on velocities; a `Stepper` of one scene has them";

const NOT_QUADRATIC: &str = "systems hold terms whose continuous limit is quadratic in the velocity";

/// The term with constants for a step of 1 s.
pub(super) fn placed<E, const N: usize>(term: E) -> Arc<dyn PlacedTerm<N>>
where
    E: Effect<Scalar = f64, Group: BodyPart<N>, Retraction = CayleyRetraction> + Send + Sync + 'static,
    E::Constants: Send + Sync,
    E::Advected: Send + Sync,
{
    const { assert!(E::FACTS.is_quadratic, "{}", NOT_QUADRATIC) }
    const { assert!(E::FACTS.constraints == 0, "{}", CONSTRAINED) }
    Arc::new(StepEffect::of(Arc::new(term), 1.0))
}

impl<E, const N: usize> PlacedTerm<N> for StepEffect<E>
where
    E: Effect<Scalar = f64, Group: BodyPart<N>, Retraction = CayleyRetraction> + Send + Sync + 'static,
    E::Constants: Send + Sync,
    E::Advected: Send + Sync,
{
    fn validate(&self) -> Result<(), SetupError> {
        self.term.validate()
    }

    fn refolded(&self, h: f64) -> Arc<dyn PlacedTerm<N>> {
        Arc::new(Self::of(Arc::clone(&self.term), h))
    }

    fn is_finite(&self) -> bool {
        E::are_finite(&self.constants)
    }

    fn is_self_adjoint(&self) -> bool {
        E::FACTS.is_self_adjoint
    }

    fn has_unknown(&self) -> bool {
        E::FACTS.parts.unknown
    }

    fn kick_before(&self, now: [&Body; N]) -> Option<[Vector6<f64>; N]> {
        let kick = || E::Group::in_bodies(&E::kick_before(&self.constants, &self.seen(&E::Group::of(now))));
        E::FACTS.parts.kick_before.then(kick)
    }

    fn kick_after(&self, increments: [&Increment; N], next: [&Body; N]) -> Option<[Vector6<f64>; N]> {
        let increment = || E::Group::of_increments(increments);
        let seen = || self.seen(&E::Group::of(next));
        let kick = || E::Group::in_bodies(&E::kick_after(&self.constants, &increment(), &seen()));
        E::FACTS.parts.kick_after.then(kick)
    }

    fn write_newton(
        &self,
        now: [&Body; N],
        sides: [[&Vector6<f64>; N]; 2],
        to: (&mut [Vector6<f64>; N], &mut Blocks<N>),
    ) {
        let (now, [a, half]) = (E::Group::of(now), sides.map(E::Group::of_components));
        let (residual, jacobian) = self.newton_system(&now, &a, &half);
        (*to.0, *to.1) = (E::Group::in_bodies(&residual), E::Group::squares_in_bodies(&jacobian));
    }

    fn newton_residual(&self, now: [&Body; N], sides: [[&Vector6<f64>; N]; 2]) -> [Vector6<f64>; N] {
        let (now, [a, half]) = (E::Group::of(now), sides.map(E::Group::of_components));
        E::Group::in_bodies(&self.newton_residual(&now, &a, &half))
    }

    fn remainder(&self, a: [&Vector6<f64>; N]) -> [Vector6<f64>; N] {
        let part = E::Group::of_components(a);
        let taken = E::Group::in_bodies(&(part - E::remainder(&self.constants, &part)));
        array::from_fn(|body| a[body] - taken[body])
    }

    fn at_rest(&self, now: [&Body; N]) -> AtRest<N> {
        let limit = self.term.limit(None, &self.seen(&E::Group::of(now)));
        (limit.l, E::Group::in_bodies(&limit.momentum), E::Group::squares_in_bodies(&limit.hessian))
    }

    fn derivation(&self) -> String {
        derivation(&*self.term)
    }

    fn describe(&self, visitor: &mut dyn SceneVisitor<f64>) {
        self.term.describe(visitor);
    }
}

/// The configuration of space.
pub(super) fn space() -> Body {
    Body::identity()
}
