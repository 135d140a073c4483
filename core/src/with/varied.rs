//! Steps of varying length by one method.

use crate::error::{SetupError, StepError};
use crate::mechanics::{Effect, Group, SceneVisitor, Vector};
use crate::motion::{Kept, MotionOf, Plan, PlanFacts, Runs, StepReport, Stepper, Summation, Variable};

/// A rule for the length of each step.
pub trait Lengths<S: Effect>: Clone {
    /// The rule's memory from step to step.
    type Memory: Kept<f64>;
    /// Whether the lengths depend on the number of steps before, and on nothing else.
    const COUNTED: bool;

    /// The memory at the beginning of a motion.
    fn begin(&self) -> Self::Memory;

    /// The length ahead of this motion, or behind it, s, in steps of this unit.
    fn length(
        &self,
        unit: f64,
        motion: &MotionOf<S>,
        velocity: impl FnOnce() -> Vector<S>,
        way: (&Self::Memory, bool),
    ) -> f64;

    /// The memory after a step of this unit and length, s, that has led to this motion.
    fn after(
        &self,
        lengths: [f64; 2],
        motion: &MotionOf<S>,
        velocity: impl FnOnce() -> Vector<S>,
        before: &Self::Memory,
    ) -> Self::Memory;

    /// The time, s, after this number of steps of this unit.
    fn time(&self, steps: u64, unit: f64, memory: &Self::Memory) -> f64;

    /// Describes the rule, as [`Plan::describe`](crate::motion::Plan::describe).
    fn describe(&self, visitor: &mut dyn SceneVisitor<f64>);
}

/// A plan whose steps have varying lengths, by [`Stepper::with_clock`] and [`Stepper::with_density`].
#[derive(Clone, Debug)]
pub struct VariedSteps<P, L> {
    pub(super) plan: P,
    lengths: L,
}

impl<S: Effect<Scalar = f64>, P: Variable<S>> Stepper<S, P> {
    pub(super) fn varied<L: Lengths<S>>(self, lengths: L) -> Stepper<S, VariedSteps<P, L>> {
        const { assert!(!P::FACTS.varies, "a step has one length: choose a clock or a density") }
        Stepper { scene: self.scene, plan: VariedSteps { plan: self.plan, lengths } }
    }
}

impl<P, L> VariedSteps<P, L> {
    /// The length of a step, if it is valid: of the sign of the unit, and long enough to change the rounded time.
    fn checked<S>(
        &self,
        scene: &S,
        motion: &MotionOf<S>,
        kept: &(P::Kept, L::Memory),
        is_ahead: bool,
    ) -> Result<f64, StepError>
    where
        S: Effect<Scalar = f64>,
        P: Variable<S>,
        L: Lengths<S>,
    {
        let (length, unit) = (self.length(scene, motion, kept, is_ahead), self.plan.step_size());
        let now = self.time(motion, kept);
        let goes_on = length.is_finite() && length * unit.signum() > 0.0 && (now + length).to_bits() != now.to_bits();
        if goes_on || (unit == 0.0 && length == 0.0) { Ok(length) } else { Err(StepError::NoLength { length }) }
    }
}

impl<S: Effect<Scalar = f64>, P: Variable<S>, L: Lengths<S>> Plan<S> for VariedSteps<P, L> {
    type Kept = (P::Kept, L::Memory);

    const FACTS: PlanFacts =
        PlanFacts { runs: Runs::BySteps, counts_time: L::COUNTED, varies: true, explains: false, ..P::FACTS };

    delegate_plan!(plan, |kept| kept.0; step_size momentum velocity cost push);

    fn refolded(&self, scene: &S, h: f64) -> Result<Self, SetupError> {
        Ok(Self { plan: self.plan.refolded(scene, h)?, lengths: self.lengths.clone() })
    }

    fn keep(&self, scene: &S, motion: &MotionOf<S>) -> Self::Kept {
        (self.plan.keep(scene, motion), self.lengths.begin())
    }

    fn time(&self, motion: &MotionOf<S>, kept: &Self::Kept) -> f64 {
        self.lengths.time(motion.steps, self.plan.step_size(), &kept.1)
    }

    fn length(&self, scene: &S, motion: &MotionOf<S>, kept: &Self::Kept, is_ahead: bool) -> f64 {
        let velocity = || self.plan.velocity(scene, motion);
        self.lengths.length(self.plan.step_size(), motion, velocity, (&kept.1, is_ahead))
    }

    #[hot]
    fn step<M: Summation<Group<S>, S::Advected>>(
        &self,
        scene: &S,
        motion: &mut M,
        kept: &mut Self::Kept,
    ) -> Result<StepReport, StepError> {
        let length = self.checked(scene, motion.now(), kept, true)?;
        let report = self.plan.step_of(scene, motion, &mut kept.0, length)?;
        motion.count();
        let velocity = || self.plan.velocity(scene, motion.now());
        kept.1 = self.lengths.after([self.plan.step_size(), length], motion.now(), velocity, &kept.1);
        Ok(report)
    }

    fn part(
        &self,
        scene: &S,
        motion: &MotionOf<S>,
        kept: &Self::Kept,
        fraction: f64,
    ) -> Result<MotionOf<S>, StepError> {
        if fraction == 0.0 || self.plan.step_size() == 0.0 {
            return Ok(*motion);
        }
        let length = self.checked(scene, motion, kept, fraction > 0.0)?;
        self.plan.part(scene, motion, &kept.0, fraction * (length / self.plan.step_size()))
    }

    /// The largest step at the next length.
    fn max_step(&self, scene: &S, motion: &MotionOf<S>, kept: &Self::Kept) -> f64 {
        let whole = self.checked(scene, motion, kept, true);
        let whole = whole.ok().and_then(|length| self.plan.refolded(scene, length).ok());
        whole.map_or(0.0, |whole| whole.max_step(scene, motion, &whole.keep(scene, motion)))
    }

    fn describe(&self, visitor: &mut dyn SceneVisitor<f64>) {
        self.lengths.describe(visitor);
        self.plan.describe(visitor);
    }
}

/// A step of another length isn't one of the counted steps.
impl<S: Effect<Scalar = f64>, P: Variable<S>, L: Lengths<S>> Variable<S> for VariedSteps<P, L> {
    delegate_plan!(plan, |kept| kept.0; step_of);
}
