//! A method of integration, with all constants computed that depend on the scene and the step alone.

use crate::error::{SetupError, StepError};
use crate::groups::{Advected as _, LieGroup};
use crate::mechanics::{
    Effect, Group, Operations, Scalar, SceneVisitor, Vector, momentum_of_velocity, velocity_of_momentum,
};
use crate::motion::kept::Kept;
use crate::motion::limits::beyond_solvable;
use crate::motion::report::StepReport;
use crate::motion::summation::{Motion, MotionOf, Summation};
use crate::numbers::{Coordinates as _, Kernel, Vectors, dispatch, is_finite, real};
use crate::solving::largest_fraction;
use nalgebra::{SimdBool as _, SimdComplexField as _, SimdPartialOrd as _, SimdRealField as _, SimdValue};

/// The facts about the steps of a [`Plan`] that are known when they are compiled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(clippy::struct_excessive_bools)] // independent facts
pub struct PlanFacts {
    /// The vector instructions of a step, if the machine has them. A declared step of a single body doesn't become
    /// faster by them; several bodies in [lanes](crate::numbers::Real#lanes) or in an array do.
    pub vectors: Vectors,
    /// The relation of runs to steps.
    pub runs: Runs,
    /// Whether a step depends on the number of steps before it.
    pub counts_time: bool,
    /// Whether the steps have different lengths, in units of [`step_size`](Plan::step_size).
    pub varies: bool,
    /// Whether the plan defines the inertia instead of the scene: that of bodies whose coordinates couple their
    /// velocities. The scene then consists of potentials alone.
    pub has_own_inertia: bool,
    /// Whether the errors of [`step`](Plan::step) are those of a stage: a step beyond the largest is reported with the
    /// largest whole step, [`max_step`](Plan::max_step).
    pub explains: bool,
}

/// The relation of a [`run`](Plan::run) to steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Runs {
    /// A run merges parts of neighbouring steps.
    Merged,
    /// A run is a sequence of single steps: after an error the state is that of the last successful one, and reports
    /// contain only iterations.
    BySteps,
    /// A step is a run of one, to the bit and in its state after an error: only the run is compiled then.
    AsSteps,
}

impl Runs {
    pub(crate) const fn are_steps(self) -> bool {
        matches!(self, Self::AsSteps)
    }

    pub(crate) const fn are_sequences(self) -> bool {
        matches!(self, Self::BySteps)
    }
}

impl PlanFacts {
    /// The facts about steps of one length, unless a plan says otherwise.
    #[must_use]
    pub const fn of<S: Effect>() -> Self {
        let is_wide = <Scalar<S> as SimdValue>::LANES > 1 || <Group<S> as LieGroup>::BODIES > 1;
        Self {
            vectors: if is_wide { Vectors::Four } else { Vectors::AsCompiled },
            runs: Runs::Merged,
            counts_time: false,
            varies: false,
            has_own_inertia: false,
            explains: false,
        }
    }
}

/// A method with its constants folded for a scene and a step: the part of a [`Stepper`](crate::Stepper) that makes its
/// steps.
///
/// All functions around a step (`start`, `run`, `step_forced`, `adopt`, `max_step`, `inverse`, compensation, remedies,
/// checkpoints) work with any plan. `examples/how-to-add-a-method.rs` has a user's own plan.
///
/// # Contract
///
/// - [`step`](Self::step) makes one step of `h` and counts it, or returns an error and leaves motion and memory
///   unchanged.
/// - It changes the motion only by the functions of [`Summation`], and depends on nothing but its arguments: equal
///   arguments give identical bits.
pub trait Plan<S: Effect>: Sized {
    /// The memory of one step for the next: guesses, stages. `()` if there is none.
    type Kept: Kept<Scalar<S>>;

    /// The facts about its steps that are known when they are compiled.
    const FACTS: PlanFacts = PlanFacts::of::<S>();

    /// The step `h`, s.
    fn step_size(&self) -> Scalar<S>;

    /// The method with another step.
    ///
    /// # Errors
    ///
    /// [`SetupError`] if the method can't step the scene.
    fn refolded(&self, scene: &S, h: Scalar<S>) -> Result<Self, SetupError>;

    /// The advected parameters in the body frame at the start, from this attitude and momentum: the scene's own, unless
    /// values are prescribed for each step, or depend on the rest of the motion.
    fn begun(&self, scene: &S, attitude: &Group<S>, _momentum: &Vector<S>) -> S::Advected {
        scene.advected().seen_from(attitude)
    }

    /// The memory at the beginning of a motion.
    fn keep(&self, scene: &S, motion: &MotionOf<S>) -> Self::Kept;

    /// The time of a motion since its start, s; `n h` after `n` steps of one length.
    #[allow(clippy::cast_precision_loss)] // 2⁵³ steps take longer than a career
    fn time(&self, motion: &MotionOf<S>, _kept: &Self::Kept) -> Scalar<S> {
        self.step_size() * real(motion.steps as f64)
    }

    /// The length of the next step of a motion, or of the previous one, s; not finite if there is none. A step back is
    /// a step of the negative length.
    fn length(&self, _scene: &S, _motion: &MotionOf<S>, _kept: &Self::Kept, _is_ahead: bool) -> Scalar<S> {
        self.step_size()
    }

    /// The momentum at a body velocity.
    fn momentum(&self, scene: &S, _attitude: &Group<S>, velocity: &Vector<S>, w: &S::Advected) -> Vector<S> {
        momentum_of_velocity(scene, velocity, w)
    }

    /// The body velocity, as documented at [`Stepper::velocity`](crate::Stepper::velocity).
    fn velocity(&self, scene: &S, motion: &MotionOf<S>) -> Vector<S> {
        velocity_of_momentum(scene, &motion.momentum, &motion.advected)
    }

    /// The energy, J, if the plan defines the inertia.
    fn energy(&self, scene: &S, motion: &MotionOf<S>) -> Scalar<S> {
        self.velocity(scene, motion).dot(&motion.momentum) * real(0.5) - scene.limit(None, &motion.advected).l
    }

    /// Makes one step. A plan implements this, or it implements [`run`](Self::run) with
    /// [`Runs::AsSteps`]; then a step is a run of one.
    ///
    /// Mark your own `#[inline(always)]`: a function that isn't inlined doesn't stay in registers and isn't compiled
    /// for the machine's vector instructions. The library's own aren't inlined in builds with debug assertions, to
    /// reduce build time.
    ///
    /// # Errors
    ///
    /// [`StepError`] if there is no such step, or a value isn't finite. `motion` and `kept` must then be unchanged:
    /// callers make no copy of `kept`.
    #[hot]
    fn step<M: Summation<Group<S>, S::Advected>>(
        &self,
        scene: &S,
        motion: &mut M,
        kept: &mut Self::Kept,
    ) -> Result<StepReport, StepError> {
        const { assert!(Self::FACTS.runs.are_steps(), "a plan has neither: write `step`, or `run` with `Runs::AsSteps`") }
        self.run(scene, motion, kept, 1).map(StepReport::of_run)
    }

    /// The motion a fraction of the step after this one; a negative fraction is a step back.
    ///
    /// # Errors
    ///
    /// The errors of [`step`](Self::step).
    fn part(
        &self,
        scene: &S,
        motion: &MotionOf<S>,
        _kept: &Self::Kept,
        fraction: Scalar<S>,
    ) -> Result<MotionOf<S>, StepError> {
        // So small a change would be lost in rounding, and the constants of so short a step may leave the scalar's
        // range.
        let least = Scalar::<S>::simd_default_epsilon() * Scalar::<S>::simd_default_epsilon();
        if fraction.simd_abs().simd_lt(least).all() {
            return Ok(*motion);
        }
        let part = self.refolded(scene, self.step_size() * fraction);
        let part = part.map_err(|_| StepError::NonFinite { what: "part of the step" })?;
        let mut next = *motion;
        let mut kept = part.keep(scene, &next);
        run_plan(&part, scene, &mut next, &mut kept, (1, None))
            .map_err(|error| explained(&part, error, (scene, motion, &kept)))?;
        next.steps = motion.steps;
        Ok(next)
    }

    /// Makes `steps` steps without access to the states between; returns the sum of their iterations. After an error
    /// motion and memory are unspecified.
    ///
    /// # Errors
    ///
    /// The errors of [`step`](Self::step).
    #[hot]
    fn run<M: Summation<Group<S>, S::Advected>>(
        &self,
        scene: &S,
        motion: &mut M,
        kept: &mut Self::Kept,
        steps: u64,
    ) -> Result<u64, StepError> {
        const { assert!(!Self::FACTS.runs.are_steps(), "with `Runs::AsSteps` a step is a run of one: write `run`") }
        let mut iterations = 0;
        for _ in 0..steps {
            iterations += u64::from(self.step(scene, motion, kept)?.iterations);
        }
        Ok(iterations)
    }

    /// Adds an impulse to the momentum between two steps, and to its copies in the memory.
    #[hot]
    fn push<M: Summation<Group<S>, S::Advected>>(
        &self,
        _scene: &S,
        motion: &mut M,
        _kept: &mut Self::Kept,
        impulse: &Vector<S>,
    ) {
        motion.push(impulse);
    }

    /// The largest solvable part of the step from here, in seconds to six digits.
    fn max_step(&self, scene: &S, motion: &MotionOf<S>, _kept: &Self::Kept) -> Scalar<S> {
        let solvable = |fraction: f64| {
            self.refolded(scene, self.step_size() * real(fraction)).is_ok_and(|part| {
                let (mut motion, mut kept) = (*motion, part.keep(scene, motion));
                run_plan(&part, scene, &mut motion, &mut kept, (1, None)).is_ok()
            })
        };
        largest_fraction(solvable).map_or(real(0.0), |fraction| self.step_size() * real(fraction))
    }

    /// Visits the method's name and every constant except the scene's and the step: two plans with the same description
    /// make the same steps.
    fn describe(&self, visitor: &mut dyn SceneVisitor<Scalar<S>>);

    /// The approximate number of operations of a step.
    fn cost(&self) -> Cost;
}

/// The error of the whole step for that of a stage: it names the largest solvable step.
#[cold]
pub(crate) fn explained<S: Effect, P: Plan<S>>(
    plan: &P,
    error: StepError,
    (scene, motion, kept): (&S, &MotionOf<S>, &P::Kept),
) -> StepError {
    let StepError::BeyondSolvable { .. } = error else { return error };
    if const { !P::FACTS.explains } {
        return error;
    }
    let largest = plan.max_step(scene, motion, kept);
    beyond_solvable(scene, plan.step_size(), &motion.momentum, &motion.advected, largest)
}

/// A function of the motion reached so far and its time, s, that returns the number of further steps; 0 ends the run.
pub type NextSteps<'a, G, A> = dyn FnMut(&Motion<G, A>, <G as LieGroup>::Scalar) -> u64 + 'a;

pub(crate) type Next<'a, G, A> = Option<&'a mut NextSteps<'a, G, A>>;

/// A run: the number of steps, and the function that continues it.
struct Run<'a, 'n, S: Effect, P: Plan<S>>(
    &'a P,
    &'a S,
    &'a mut MotionOf<S>,
    &'a mut P::Kept,
    (u64, Next<'n, Group<S>, S::Advected>),
);

impl<S: Effect, P: Plan<S>> Kernel for Run<'_, '_, S, P> {
    type Output = Result<u64, StepError>;
    const VECTORS: Vectors = P::FACTS.vectors;
    const IS_IN_LANES: bool = <Scalar<S> as SimdValue>::LANES > 1;

    /// The function that continues the run is called inside of this one, so that constants stay in registers.
    #[hot]
    fn run(self) -> Self::Output {
        let Self(plan, scene, motion, kept, (mut steps, mut next)) = self;
        let mut iterations = 0;
        while steps > 0 {
            iterations += plan.run(scene, motion, kept, steps)?;
            steps = next.as_mut().map_or(0, |next| next(motion, plan.time(motion, kept)));
        }
        Ok(iterations)
    }
}

/// [`Plan::run`] with the machine's vector instructions, continued as by [`Integrator::run_stretches`]. It isn't
/// inlined, so that a method's steps are compiled once for all callers.
///
/// [`Integrator::run_stretches`]: crate::motion::Integrator::run_stretches
#[inline(never)]
pub(crate) fn run_plan<S: Effect, P: Plan<S>>(
    plan: &P,
    scene: &S,
    motion: &mut MotionOf<S>,
    kept: &mut P::Kept,
    steps: (u64, Next<'_, Group<S>, S::Advected>),
) -> Result<u64, StepError> {
    dispatch(Run(plan, scene, motion, kept, steps))
}

/// A plan whose steps use advected parameters only from the motion, so that other values can be
/// [prescribed](crate::Stepper::step_with) for each step.
#[diagnostic::on_unimplemented(
    message = "a step of `{Self}` can't be given values",
    label = "not with this method",
    note = "the stages of Gauss collocation see what is advected from the scene; give values to another method's steps"
)]
pub trait Steerable<S: Effect>: Plan<S> {
    /// Replaces the body's advected parameters, and clears the part of the memory that depends on the old ones.
    #[hot]
    fn see(&self, motion: &mut MotionOf<S>, _kept: &mut Self::Kept, advected: S::Advected) {
        motion.advected = advected;
    }

    /// Makes one step with prescribed values. `values` returns the advected parameters in space in the middle of a part of the
    /// step, which is given by its begin and its length as shares of the step; by default of the whole step. A plan with
    /// stages of their own times asks for those of each.
    ///
    /// # Errors
    ///
    /// The errors of [`step`](Plan::step) and of `values`.
    #[hot]
    fn step_seeing(
        &self,
        scene: &S,
        motion: &mut MotionOf<S>,
        kept: &mut Self::Kept,
        values: &mut impl FnMut([Scalar<S>; 2]) -> Result<S::Advected, StepError>,
    ) -> Result<StepReport, StepError> {
        let seen = values([real(0.0), real(1.0)])?.seen_from(&motion.attitude);
        self.see(motion, kept, seen);
        self.step(scene, motion, kept)
    }

    /// The [`part`](Plan::part) of such a step; by default all parts of a step have the values in its middle. The shares are
    /// those of the step in the direction of the part.
    ///
    /// # Errors
    ///
    /// The errors of [`part`](Plan::part) and of `values`.
    fn part_seeing(
        &self,
        scene: &S,
        motion: &MotionOf<S>,
        kept: &Self::Kept,
        fraction: Scalar<S>,
        values: &mut impl FnMut([Scalar<S>; 2]) -> Result<S::Advected, StepError>,
    ) -> Result<MotionOf<S>, StepError> {
        let (mut now, mut kept) = (*motion, *kept);
        let seen = values([real(0.0), real(1.0)])?.seen_from(&now.attitude);
        self.see(&mut now, &mut kept, seen);
        self.part(scene, &now, &kept, fraction)
    }
}

/// A plan whose successive steps may have different lengths, each with its own constants.
///
/// Excluded are plans whose inputs are indexed by the step, and processed splittings, whose processor belongs to one
/// length of the steps.
#[diagnostic::on_unimplemented(
    message = "the steps of `{Self}` can't have different lengths",
    label = "not with this method",
    note = "a processor belongs to one length: take the splitting without it",
    note = "values are to be given afterwards: `.with_clock(…).driven(…)`"
)]
pub trait Variable<S: Effect>: Plan<S> {
    /// Makes one step of another length, s, without counting it.
    ///
    /// # Errors
    ///
    /// The errors of [`step`](Plan::step), and [`StepError::NonFinite`] if the constants of such a step aren't finite.
    fn step_of<M: Summation<Group<S>, S::Advected>>(
        &self,
        scene: &S,
        motion: &mut M,
        kept: &mut Self::Kept,
        length: Scalar<S>,
    ) -> Result<StepReport, StepError> {
        if length.simd_eq(real(0.0)).all() {
            return Ok(StepReport::of(0));
        }
        let part = self.refolded(scene, length);
        let part = part.map_err(|_| StepError::NonFinite { what: "constants of a step of this length" })?;
        let (ratio, back) = (length / self.step_size(), self.step_size() / length);
        let has_ratio = is_finite(ratio) && is_finite(back);
        let (mut next, steps) = (*motion, motion.now().steps);
        let mut guess = if has_ratio { kept.scaled(ratio) } else { part.keep(scene, next.now()) };
        let made = part.step(scene, &mut next, &mut guess);
        let report = made.map_err(|error| explained(&part, error, (scene, motion.now(), &guess)))?;
        next.recount(steps);
        *kept = if has_ratio { guess.scaled(back) } else { self.keep(scene, next.now()) };
        *motion = next;
        Ok(report)
    }
}

/// The approximate number of operations of a step, by which methods are ranked; it is the same on every machine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cost {
    /// The operations of a step besides its iterations.
    pub step: f64,
    /// The operations of one iteration, in the count of [`StepReport`].
    pub iteration: f64,
    /// The fewest iterations of a step, unless nothing changes from step to step.
    pub fewest: u32,
    /// The operations of a run besides its steps, whatever their number: those of a processor.
    pub once: f64,
}

/// Operations of a solve and its reconstruction on SO(3), besides those that an effect counts.
const OF_A_STAGE: f64 = 150.0;
/// Operations of an iteration besides the Newton system: its solution and the test of convergence. They form a chain of
/// dependent operations, unlike products of matrices.
const OF_AN_ITERATION: f64 = 90.0;

impl Cost {
    /// The cost of a step with `stages` stages, each a solve or a flow with these operations.
    #[must_use]
    pub fn of_stages(operations: Operations, stages: u32) -> Self {
        Self {
            step: f64::from(stages) * (OF_A_STAGE + f64::from(operations.step)),
            iteration: OF_AN_ITERATION + f64::from(operations.iteration),
            // One iteration alone can't show convergence.
            fewest: if operations.iteration > 0 { 2 * stages } else { 0 },
            once: 0.0,
        }
    }

    /// The least number of operations of a step.
    #[must_use]
    pub fn least(&self) -> f64 {
        self.step + f64::from(self.fewest) * self.iteration
    }

    /// The operations of `steps` steps with `iterations` iterations in all.
    #[must_use]
    #[allow(clippy::cast_precision_loss)] // an estimate
    pub fn of_run(&self, steps: u64, iterations: u64) -> f64 {
        self.once + steps as f64 * self.step + iterations as f64 * self.iteration
    }
}
