//! Read access to a motion and its stepper.

use alloc::string::String;

use super::{StateOf, Stepper};
use crate::groups::SO3;
use crate::mechanics::{DiscreteLagrangian, Effect, LeftInvariant, OneVector, Scalar, Vector, derivation, energy};
use crate::motion::plan::Plan;
use crate::motion::summation::MotionOf;
use crate::solving::Solvability;

/// # Read
///
/// Properties of a motion, and the parts of the stepper.
impl<S: Effect, P: Plan<S>> Stepper<S, P> {
    /// The scene.
    #[must_use]
    pub fn scene(&self) -> &S {
        &self.scene
    }

    /// The declaration of each term of the scene and all derived equations, as text.
    #[must_use]
    pub fn derivation(&self) -> String {
        derivation(&self.scene)
    }

    /// The method, folded.
    #[must_use]
    pub fn plan(&self) -> &P {
        &self.plan
    }

    /// The step `h`, s; if steps vary, their unit.
    #[must_use]
    pub fn step_size(&self) -> Scalar<S> {
        self.plan.step_size()
    }

    /// The time since the start, s: `n h`, never accumulated, if all steps have the length `h`. The lengths of
    /// [`step_of`](Self::step_of) are added to it.
    #[must_use]
    pub fn time(&self, state: &StateOf<S, P>) -> Scalar<S> {
        self.plan.time(&state.motion, &state.kept) + state.elapsed.sum
    }

    /// The body velocity, on SO(3) in rad/s.
    ///
    /// If the continuous limit isn't quadratic in the velocity, a discrete momentum may be that of no velocity,
    /// although the next step has a solution: the velocity is NaN then, in the lanes concerned only. If the
    /// [scene](Self::scene) is a [`ContinuousLagrangian`](crate::mechanics::ContinuousLagrangian), its `velocity`
    /// returns the reason as an error. A [control force](Self::step_forced) and an event that are NaN are refused.
    #[must_use]
    pub fn velocity(&self, motion: &MotionOf<S>) -> Vector<S> {
        self.plan.velocity(&self.scene, motion)
    }

    /// The energy of the continuous system, `½ Ω·JΩ + V(w)` if it is quadratic in the velocity, J; NaN if the
    /// [`velocity`](Self::velocity) is.
    ///
    /// For a [`DiscreteLagrangian`](crate::mechanics::DiscreteLagrangian) it oscillates about its initial value, at the
    /// order of the scheme, and doesn't drift.
    #[must_use]
    pub fn energy(&self, motion: &MotionOf<S>) -> Scalar<S> {
        if const { P::FACTS.has_own_inertia } {
            return self.plan.energy(&self.scene, motion);
        }
        energy(&self.scene, &motion.momentum, &motion.advected)
    }

    /// The largest step from this state up to the stepper's own, s, to six digits, for which all equations have
    /// solutions. Bisection finds it in some dozens of steps.
    #[must_use]
    pub fn max_step(&self, state: &StateOf<S, P>) -> Scalar<S> {
        self.plan.max_step(&self.scene, &state.motion, &state.kept)
    }

    /// The spatial momentum, `R Π` on SO(3), in a scene that conserves it: one without advected parameters; prescribed
    /// ones are allowed.
    #[must_use]
    pub fn spatial_momentum(&self, motion: &MotionOf<S>) -> Vector<S>
    where
        S: LeftInvariant,
    {
        motion.spatial_momentum()
    }

    /// The momentum along the advected vector, `Π·w` (`e₃·R Π` for the vertical), in a scene that conserves it: one
    /// with a single advected vector, (3.20).
    #[must_use]
    pub fn momentum_along_advected(&self, motion: &MotionOf<S>) -> Scalar<S>
    where
        S: DiscreteLagrangian<Group = SO3<Scalar<S>>, Advected: OneVector<Scalar = Scalar<S>>>,
    {
        motion.momentum.dot(&motion.advected.vector())
    }
}

impl<S: Effect> Stepper<S> {
    /// Whether the next step surely has a solution or surely has none, if bounds are known; see
    /// [`DiscreteLiePoisson::solvability`](crate::motion::DiscreteLiePoisson::solvability).
    #[must_use]
    pub fn solvability(&self, motion: &MotionOf<S>) -> Solvability {
        self.plan.solvability(&self.scene, &motion.momentum, &motion.advected)
    }
}
