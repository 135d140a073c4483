//! Diagnosis of steps without a solution: bounds that decide before a solve, and the largest solvable step.

use super::OwnStep;
use crate::error::StepError;
use crate::groups::{Advected as _, Retraction as _};
use crate::mechanics::{Effect, Group, Scalar, Vector, inertia};
use crate::motion::limits::{beyond_solvable, kicked};
use crate::numbers::{Coordinates as _, real, reported};
use crate::solving::{
    Problem, Root, Solvability, TurningLimits, largest_fraction, newton_system, step_terms, turning_limits,
};
use nalgebra::SimdComplexField as _;

impl<S: Effect> OwnStep<S> {
    /// The solve with all its fallbacks, from the beginning.
    #[cold]
    #[inline(never)]
    pub(super) fn solve_carefully(
        &self,
        scene: &S,
        momentum: &Vector<S>,
        advected: &S::Advected,
        half_guess: &Vector<S>,
    ) -> Result<Root<Group<S>>, StepError> {
        // The bounds don't apply to an infinite kick, which `explain` reports.
        let is_finite = kicked::<S>(&self.constants, momentum, advected).is_finite() && advected.is_finite();
        if is_finite && self.solvability(scene, momentum, advected) == Solvability::Impossible {
            let largest = self.largest_solvable(scene, momentum, advected);
            return Err(beyond_solvable(scene, self.h, momentum, advected, largest));
        }
        self.problem(scene, momentum, advected)
            .solve(half_guess)
            .map_err(|error| self.explain(error, scene, momentum, advected))
    }

    /// Replaces the error of a failed solve by one that names the largest solvable step, if there is one.
    fn explain(&self, error: StepError, scene: &S, momentum: &Vector<S>, advected: &S::Advected) -> StepError {
        if !momentum.is_finite() {
            return StepError::NonFinite { what: "momentum" };
        }
        if !advected.is_finite() {
            return StepError::NonFinite { what: "advected parameter" };
        }
        // An example is an attraction between bodies at one position.
        let terms = step_terms::<S>(&self.constants, &kicked::<S>(&self.constants, momentum, advected), advected);
        if !newton_system::<S>(&self.constants, &terms, &Vector::<S>::zero()).0.is_finite() {
            return StepError::NonFinite { what: "momentum equation" };
        }
        let largest = self.largest_solvable(scene, momentum, advected);
        if largest == real(0.0) {
            return error;
        }
        beyond_solvable(scene, self.h, momentum, advected, largest)
    }

    /// The bounds on solvability, as in
    /// [`DiscreteLiePoisson::solvability`](crate::motion::DiscreteLiePoisson::solvability).
    pub(in crate::motion) fn solvability(
        &self,
        scene: &S,
        momentum: &Vector<S>,
        advected: &S::Advected,
    ) -> Solvability {
        let decide = |limits: TurningLimits| limits.decide(Self::size(self.h, &self.constants, momentum, advected));
        self.turning_limits(scene, advected).map_or(Solvability::Open, decide)
    }

    /// The size `|h a|` of the right-hand side.
    fn size(h: Scalar<S>, constants: &S::Constants, momentum: &Vector<S>, advected: &S::Advected) -> f64 {
        let turn = kicked::<S>(constants, momentum, advected) * h;
        reported(turn.dot(&turn).simd_sqrt())
    }

    /// The bounds for this `w`, at this step and at half of it: they are proved only for one dependence of the kinetic
    /// part on `h`.
    fn turning_limits(&self, scene: &S, advected: &S::Advected) -> Option<TurningLimits> {
        // A reaction can be as large as it needs be.
        if const { S::FACTS.constraints > 0 } {
            return None;
        }
        let at = |h: Scalar<S>| {
            let constants = scene.constants(h);
            let terms = step_terms::<S>(&constants, &Vector::<S>::zero(), advected);
            let unknown = |f: &Group<S>| {
                let xi = S::Retraction::local_coordinates(f)?;
                let half = xi * real(0.5);
                let factor =
                    (real::<Scalar<S>>(1.0) + half.dot(&half)).simd_powi(scene.facts().denominators.cast_signed());
                Some(newton_system::<S>(&constants, &terms, &half).0 * (real::<Scalar<S>>(2.0) / factor))
            };
            turning_limits::<Group<S>>(&unknown, &inertia(scene, advected))
        };
        at(self.h * real(0.5)).and(at(self.h))
    }

    /// The largest solvable step, as in [`DiscreteLiePoisson::max_step`](crate::motion::DiscreteLiePoisson::max_step).
    pub(in crate::motion) fn largest_solvable(
        &self,
        scene: &S,
        momentum: &Vector<S>,
        advected: &S::Advected,
    ) -> Scalar<S> {
        let limits = self.turning_limits(scene, advected);
        let solvable = |fraction: f64| {
            let h = self.h * real(fraction);
            let constants = scene.constants(h);
            match limits.map(|limits| limits.decide(Self::size(h, &constants, momentum, advected))) {
                Some(Solvability::Certain) => return true,
                Some(Solvability::Impossible) => return false,
                Some(Solvability::Open) | None => {}
            }
            let a = kicked::<S>(&constants, momentum, advected);
            let problem = Problem { scene, constants: &constants, a, w: advected, h, safe: self.safe };
            problem.attempt(&Vector::<S>::zero()).is_ok()
        };
        largest_fraction(solvable).map_or(real(0.0), |fraction| self.h * real(fraction))
    }
}
