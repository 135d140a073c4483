//! An effect behind a flag that is asked at run time, as simulators have it that hold every effect in every scene.

use liestep::SetupError;
use liestep::mechanics::{Effect, Matrix, Parts, SceneVisitor, Square, Vector};
use liestep::numbers::Coordinates as _;

/// An effect that can be switched off.
pub(crate) struct Switched<E> {
    pub(crate) effect: E,
    pub(crate) on: bool,
}

/// The effect's constants, and the flag.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Constants<C> {
    constants: C,
    on: bool,
}

/// Only of kicks: the benchmark's effect is a potential, which has no share in the unknown part.
impl<E: Effect> Effect for Switched<E> {
    type Scalar = E::Scalar;
    type Group = E::Group;
    type Retraction = E::Retraction;
    type Kinetic = E::Kinetic;
    type Advected = E::Advected;
    type Constants = Constants<E::Constants>;
    type StepTerms = E::StepTerms;

    const PARTS: Parts = E::PARTS;
    const DENOMINATORS: u32 = E::DENOMINATORS;
    const DERIVATION: &'static str = E::DERIVATION;

    fn validate(&self) -> Result<(), SetupError> {
        self.effect.validate()
    }

    fn describe(&self, visitor: &mut dyn SceneVisitor<E::Scalar>) {
        self.effect.describe(visitor);
    }

    fn advected(&self) -> E::Advected {
        self.effect.advected()
    }

    fn momentum_jacobian(&self, f: &Matrix<E>, w: &E::Advected, h: E::Scalar) -> Square<E> {
        self.effect.momentum_jacobian(f, w, h)
    }

    fn inertia(&self) -> Square<E> {
        self.effect.inertia()
    }

    fn momentum_bias(&self, w: &E::Advected) -> Vector<E> {
        self.effect.momentum_bias(w)
    }

    fn potential(&self, w: &E::Advected) -> E::Scalar {
        self.effect.potential(w)
    }

    fn constants(&self, h: E::Scalar) -> Self::Constants {
        Constants { constants: self.effect.constants(h), on: self.on }
    }

    #[inline(always)]
    fn kick_before(c: &Self::Constants, w: &E::Advected) -> Vector<E> {
        if c.on { E::kick_before(&c.constants, w) } else { Vector::<E>::zero() }
    }

    #[inline(always)]
    fn step_terms(c: &Self::Constants, a: &Vector<E>, w: &E::Advected) -> E::StepTerms {
        E::step_terms(&c.constants, a, w)
    }

    #[inline(always)]
    fn newton_system(c: &Self::Constants, terms: &E::StepTerms, half: &Vector<E>) -> (Vector<E>, Square<E>) {
        E::newton_system(&c.constants, terms, half)
    }

    #[inline(always)]
    fn kick_after(c: &Self::Constants, increment: &Matrix<E>, next: &E::Advected) -> Vector<E> {
        if c.on { E::kick_after(&c.constants, increment, next) } else { Vector::<E>::zero() }
    }
}
