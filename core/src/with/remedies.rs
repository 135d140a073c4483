//! Remedies for a step that has no solution.
//!
//! A [`Stepper`] refuses such a step and leaves the state alone. Substeps replace it, and the report says so. They give
//! up a constant step; a motion that needs them often needs a smaller one.

use crate::error::{SetupError, StepError};
use crate::mechanics::{Effect, Group, Scalar, SceneVisitor};
use crate::motion::{Plan, Remedy, Steerable, StepReport, Stepper, Summation, Variable};
use crate::numbers::real;

/// A plan that divides a step without a solution into equal parts, by [`Stepper::or_substeps`].
#[derive(Clone, Copy, Debug)]
#[doc(hidden)]
pub struct Substeps<P> {
    plan: P,
    at_most: u32,
}

/// # Wrap: remedies
impl<S: Effect, P: Plan<S>> Stepper<S, P> {
    /// Divides a step without a solution into 2, 4, 8, … equal parts, as few as can be solved and at most `at_most`.
    ///
    /// The motion through such a step is as good as any other, but the step isn't constant: the energy stays within its
    /// bound between two such steps and may change by the order of `h²` at each, so that over many it can drift. The
    /// group, the momentum maps and the Casimirs are conserved, as by a step of any size.
    ///
    /// The constants of the parts are computed anew each time, which takes far longer than a step.
    ///
    /// # Examples
    ///
    /// ```
    /// use liestep::motion::Remedy;
    /// use liestep::effects::PrincipalBody;
    /// use liestep::{SO3, Stepper};
    /// use liestep::groups::LieGroup as _;
    /// use liestep::mechanics::DiagonalNonstandardInertia;
    /// use nalgebra::Vector3;
    ///
    /// let J_d = DiagonalNonstandardInertia::from_principal_moments(Vector3::new(1.0, 2.0, 2.5))?;
    /// let stepper = Stepper::new(PrincipalBody { J_d }, 0.1)?.or_substeps(8);
    /// let mut state = stepper.start(SO3::identity(), Vector3::new(0.0, 25.0, 0.0))?;
    /// let report = stepper.step(&mut state)?;
    /// assert_eq!(report.remedy, Some(Remedy::Substeps(4)));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn or_substeps(self, at_most: u32) -> Stepper<S, Substeps<P>> {
        // The parts of a step have a count of their own.
        const {
            assert!(!P::FACTS.counts_time, "ask for substeps before the values: `.or_substeps(…).driven(…)`");
            assert!(!P::FACTS.varies, "ask for substeps before the lengths: `.or_substeps(…).with_clock(…)`");
        }
        Stepper { scene: self.scene, plan: Substeps { plan: self.plan, at_most } }
    }
}

impl<S: Effect, P: Plan<S>> Plan<S> for Substeps<P> {
    type Kept = P::Kept;

    // The largest step is that of the plan itself, which excludes steps that are solved only in parts.
    delegate_plan!(plan, |kept| *kept; facts step_size keep momentum velocity max_step cost push);

    fn refolded(&self, scene: &S, h: Scalar<S>) -> Result<Self, SetupError> {
        Ok(Self { plan: self.plan.refolded(scene, h)?, at_most: self.at_most })
    }

    #[hot]
    fn step<M: Summation<Group<S>, S::Advected>>(
        &self,
        scene: &S,
        motion: &mut M,
        kept: &mut Self::Kept,
    ) -> Result<StepReport, StepError> {
        match self.plan.step(scene, motion, kept) {
            Ok(report) => Ok(report),
            Err(error) => in_parts(&self.plan, scene, (motion, kept), (self.at_most, error)),
        }
    }

    fn describe(&self, visitor: &mut dyn SceneVisitor<Scalar<S>>) {
        visitor.term("or substeps");
        visitor.parameter("at most", real(f64::from(self.at_most)));
        self.plan.describe(visitor);
    }
}

impl<S: Effect, P: Steerable<S>> Steerable<S> for Substeps<P> {
    delegate_plan!(plan, |kept| *kept; see);
}
impl<S: Effect, P: Variable<S>> Variable<S> for Substeps<P> {}

/// Makes the step in equal parts, or leaves the motion unchanged and returns the error.
#[cold]
#[inline(never)]
fn in_parts<S: Effect, P: Plan<S>, M: Summation<Group<S>, S::Advected>>(
    plan: &P,
    scene: &S,
    (motion, kept): (&mut M, &mut P::Kept),
    (at_most, error): (u32, StepError),
) -> Result<StepReport, StepError> {
    if matches!(error, StepError::NonFinite { .. }) {
        return Err(error);
    }
    let steps = motion.now().steps;
    let mut parts = 2;
    while parts <= at_most {
        if let Some((mut moved, iterations)) = substepped(plan, scene, *motion, parts) {
            moved.recount(steps + 1);
            // The memory starts anew: the increment of a part doesn't predict that of a whole step.
            *kept = plan.keep(scene, moved.now());
            *motion = moved;
            return Ok(StepReport { iterations, remedy: Some(Remedy::Substeps(parts)) });
        }
        let Some(more) = parts.checked_mul(2) else { break };
        parts = more;
    }
    Err(error)
}

/// The motion after `parts` steps of an equal part of `h`, and the sum of their iterations.
#[cold]
#[inline(never)]
fn substepped<S: Effect, P: Plan<S>, M: Summation<Group<S>, S::Advected>>(
    plan: &P,
    scene: &S,
    mut motion: M,
    parts: u32,
) -> Option<(M, u32)> {
    let small = plan.refolded(scene, plan.step_size() / real(f64::from(parts))).ok()?;
    motion.recount(0);
    let mut kept = small.keep(scene, motion.now());
    let mut iterations = 0;
    for _ in 0..parts {
        iterations += small.step(scene, &mut motion, &mut kept).ok()?.iterations;
    }
    Some((motion, iterations))
}
