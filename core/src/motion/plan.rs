//! A method whose constants are folded for a scene and a step.

use crate::error::{SetupError, StepError};
use crate::groups::LieGroup;
use crate::mechanics::{
    Effect, Group, Operations, Scalar, SceneVisitor, Vector, momentum_of_velocity, velocity_of_momentum,
};
use crate::motion::kept::Kept;
use crate::motion::report::StepReport;
use crate::motion::summation::{Motion, MotionOf, Summation};
use crate::numbers::{Coordinates as _, Kernel, Vectors, dispatch, is_finite, real};
use crate::solving::largest_fraction;
use nalgebra::{SimdBool as _, SimdComplexField as _, SimdPartialOrd as _, SimdRealField as _, SimdValue};

/// A method with its constants folded for a scene and a step: what a [`Stepper`](crate::Stepper) steps by.
///
/// All that is put around a step (`start`, `run`, `step_forced`, `adopt`, `max_step`, `inverse`, compensation, remedies,
/// checkpoints) works with any plan. `examples/how-to-add-a-method.rs` has one of a user's own.
///
/// # Contract
///
/// - [`step`](Self::step) makes one step of `h` and counts it, or returns an error and leaves motion and memory as they
///   were.
/// - It changes the motion by [`Summation`]'s functions only, and depends on nothing but its arguments: the same
///   arguments give the same bits.
pub trait Plan<S: Effect>: Sized {
    /// What one step leaves for the next: guesses, stages. `()` where there is nothing.
    type Kept: Kept<Scalar<S>>;

    /// Which vector instructions a step takes where the machine is found to have them. A declared step of a body alone
    /// gains nothing by them, several bodies in [lanes](crate::numbers::Real#lanes) or in an array do.
    const VECTORS: Vectors = if <Scalar<S> as SimdValue>::LANES > 1 || <Group<S> as LieGroup>::BODIES > 1 {
        Vectors::Four
    } else {
        Vectors::AsCompiled
    };

    /// The step `h`, s.
    fn step_size(&self) -> Scalar<S>;

    /// The same method for another step.
    ///
    /// # Errors
    ///
    /// [`SetupError`] where the scene can't be stepped by it.
    fn refolded(&self, scene: &S, h: Scalar<S>) -> Result<Self, SetupError>;

    /// A motion as it begins: what is advected or given may have to do with the rest.
    fn begun(&self, _scene: &S, motion: MotionOf<S>) -> MotionOf<S> {
        motion
    }

    /// What is kept at the beginning of a motion.
    fn keep(&self, scene: &S, motion: &MotionOf<S>) -> Self::Kept;

    /// Whether a motion may start here. Of a method that holds bodies in joints: whether these are closed.
    ///
    /// # Errors
    ///
    /// [`SetupError`] where it may not.
    fn admits(&self, _scene: &S, _motion: &MotionOf<S>) -> Result<(), SetupError> {
        Ok(())
    }

    /// Whether the steps depend on how many there were before.
    const COUNTS_TIME: bool = false;

    /// Whether the steps have different lengths, of which [`step_size`](Self::step_size) is the unit.
    const VARIES: bool = false;

    /// The time after this many steps, `n h`, s; where nothing else is to be known for it.
    #[allow(clippy::cast_precision_loss)] // 2⁵³ steps take longer than a career
    fn counted(&self, steps: u64) -> Scalar<S> {
        self.step_size() * real(steps as f64)
    }

    /// The time of a motion since its start, s.
    fn time(&self, motion: &MotionOf<S>, _kept: &Self::Kept) -> Scalar<S> {
        self.counted(motion.steps)
    }

    /// The length of the step ahead of a motion, or of that behind it, s; not finite where there is none. A step back is a
    /// step of its negative.
    fn length(&self, _scene: &S, _motion: &MotionOf<S>, _kept: &Self::Kept, _is_ahead: bool) -> Scalar<S> {
        self.step_size()
    }

    /// What is advected, as it is in space after this many steps; the scene's own, unless each step is given its values.
    fn advected(&self, scene: &S, _steps: u64) -> S::Advected {
        scene.advected()
    }

    /// Whether the plan has the inertia, and not the scene: that of bodies whose coordinates couple their velocities. The
    /// scene is of potentials alone then.
    const HAS_OWN_INERTIA: bool = false;

    /// The momentum of a body velocity.
    fn momentum(&self, scene: &S, _attitude: &Group<S>, velocity: &Vector<S>, w: &S::Advected) -> Vector<S> {
        momentum_of_velocity(scene, velocity, w)
    }

    /// The body velocity, as [`Stepper::velocity`](crate::Stepper::velocity) says it.
    fn velocity(&self, scene: &S, motion: &MotionOf<S>) -> Vector<S> {
        velocity_of_momentum(scene, &motion.momentum, &motion.advected)
    }

    /// The energy, J, where the plan has the inertia.
    fn energy(&self, scene: &S, motion: &MotionOf<S>) -> Scalar<S> {
        self.velocity(scene, motion).dot(&motion.momentum) * real(0.5) + scene.potential(&motion.advected)
    }

    /// Whether the lanes of what is kept go on in one way. A body alone has no other beside it.
    fn is_in_step(&self, _kept: &Self::Kept) -> bool {
        true
    }

    /// One step. A plan writes it, or it writes [`run`](Self::run) and sets [`STEPS_BY_RUNS`](Self::STEPS_BY_RUNS); then a
    /// step is a run of one.
    ///
    /// Mark your own `#[inline(always)]`: a function that is called isn't kept in registers and has no vector instructions
    /// of the machine. The library's own are called in builds with debug assertions, which are to be built soon.
    ///
    /// # Errors
    ///
    /// [`StepError`] where there is no such step, or a value isn't finite. `motion` and `kept` are then as before: callers
    /// make no copy of `kept` to go back to.
    #[hot]
    fn step<M: Summation<Group<S>, S::Advected>>(
        &self,
        scene: &S,
        motion: &mut M,
        kept: &mut Self::Kept,
    ) -> Result<StepReport, StepError> {
        const { assert!(Self::STEPS_BY_RUNS, "a plan has neither: write `step`, or `run` with `STEPS_BY_RUNS = true`") }
        self.run(scene, motion, kept, 1).map(StepReport::of_run)
    }

    /// One step of another length, s, which isn't counted.
    ///
    /// # Errors
    ///
    /// As [`step`](Self::step), and [`StepError::NonFinite`] where the constants of such a step aren't finite.
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
        let report = made.map_err(|error| part.explained(error, scene, motion.now(), &guess))?;
        next.recount(steps);
        *kept = if has_ratio { guess.scaled(back) } else { self.keep(scene, next.now()) };
        *motion = next;
        Ok(report)
    }

    /// The motion a fraction of the step after this one; a negative one is back.
    ///
    /// # Errors
    ///
    /// As [`step`](Self::step).
    fn part(
        &self,
        scene: &S,
        motion: &MotionOf<S>,
        _kept: &Self::Kept,
        fraction: Scalar<S>,
    ) -> Result<MotionOf<S>, StepError> {
        // Nothing of a change so small would be seen, and of a step so small constants may leave the scalar's range.
        let least = Scalar::<S>::simd_default_epsilon() * Scalar::<S>::simd_default_epsilon();
        if fraction.simd_abs().simd_lt(least).all() {
            return Ok(*motion);
        }
        let part = self.refolded(scene, self.step_size() * fraction);
        let part = part.map_err(|_| StepError::NonFinite { what: "part of the step" })?;
        let mut next = *motion;
        let mut kept = part.keep(scene, &next);
        run_plan(&part, scene, &mut next, &mut kept, (1, None))
            .map_err(|error| part.explained(error, scene, motion, &kept))?;
        next.steps = motion.steps;
        Ok(next)
    }

    /// Makes `steps` steps without showing the states between; returns the sum of their iterations. After an error motion and
    /// memory may be anywhere.
    ///
    /// # Errors
    ///
    /// As [`step`](Self::step).
    #[hot]
    fn run<M: Summation<Group<S>, S::Advected>>(
        &self,
        scene: &S,
        motion: &mut M,
        kept: &mut Self::Kept,
        steps: u64,
    ) -> Result<u64, StepError> {
        const { assert!(!Self::STEPS_BY_RUNS, "with `STEPS_BY_RUNS` a step is a run of one: write `run`") }
        let mut iterations = 0;
        for _ in 0..steps {
            iterations += u64::from(self.step(scene, motion, kept)?.iterations);
        }
        Ok(iterations)
    }

    /// Whether a step is a [`run`](Self::run) of one, to the bit and in what an error leaves: then only that is compiled.
    const STEPS_BY_RUNS: bool = false;

    /// Whether a [`run`](Self::run) is its steps one after the other, so that an error leaves what the last of them made,
    /// and these report nothing but their iterations.
    const RUNS_BY_STEPS: bool = false;

    /// Adds an impulse to the momentum between two steps, and to what is kept of it. A method that holds bodies in joints
    /// adds what these let through.
    ///
    /// # Errors
    ///
    /// [`StepError::SingularJoint`] where that isn't determined.
    #[hot]
    fn push<M: Summation<Group<S>, S::Advected>>(
        &self,
        _scene: &S,
        motion: &mut M,
        _kept: &mut Self::Kept,
        impulse: &Vector<S>,
    ) -> Result<(), StepError> {
        motion.push(impulse);
        Ok(())
    }

    /// Replaces the advected values that the body sees, and forgets what the memory has derived from the old ones.
    #[hot]
    fn see(&self, motion: &mut MotionOf<S>, _kept: &mut Self::Kept, advected: S::Advected) {
        motion.advected = advected;
    }

    /// Whether the errors of [`step`](Self::step) are those of a stage, and [`explained`](Self::explained) only when they
    /// are shown.
    const EXPLAINS: bool = false;

    /// The error of a step as it is shown: where a stage has none, the largest step that would do is that of the whole.
    #[cold]
    fn explained(&self, error: StepError, _scene: &S, _motion: &MotionOf<S>, _kept: &Self::Kept) -> StepError {
        error
    }

    /// The largest fraction of the step, in seconds to six digits, that can be made from here.
    fn max_step(&self, scene: &S, motion: &MotionOf<S>, _kept: &Self::Kept) -> Scalar<S> {
        let solvable = |fraction: f64| {
            self.refolded(scene, self.step_size() * real(fraction)).is_ok_and(|part| {
                let (mut motion, mut kept) = (*motion, part.keep(scene, motion));
                run_plan(&part, scene, &mut motion, &mut kept, (1, None)).is_ok()
            })
        };
        largest_fraction(solvable).map_or(real(0.0), |fraction| self.step_size() * real(fraction))
    }

    /// Shows the method's name and every constant but the scene's and the step: two plans that show the same make the
    /// same steps.
    fn describe(&self, visitor: &mut dyn SceneVisitor<Scalar<S>>);

    /// How much arithmetic a step is, about.
    fn cost(&self) -> Cost;
}

/// Returns how many more steps to make, from the motion reached so far and its time, s; 0 ends the run.
pub type NextSteps<'a, G, A> = dyn FnMut(&Motion<G, A>, <G as LieGroup>::Scalar) -> u64 + 'a;

pub(crate) type Next<'a, G, A> = Option<&'a mut NextSteps<'a, G, A>>;

/// A run: the number of steps, and what comes after them.
struct Run<'a, 'n, S: Effect, P: Plan<S>>(
    &'a P,
    &'a S,
    &'a mut MotionOf<S>,
    &'a mut P::Kept,
    (u64, Next<'n, Group<S>, S::Advected>),
);

impl<S: Effect, P: Plan<S>> Kernel for Run<'_, '_, S, P> {
    type Output = Result<u64, StepError>;
    const VECTORS: Vectors = P::VECTORS;
    const IS_IN_LANES: bool = <Scalar<S> as SimdValue>::LANES > 1;

    /// Those who look at the motion are called from here, so that constants needn't be loaded again after them.
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

/// [`Plan::run`] with the vector instructions of the machine, and as [`Integrator::run_stretches`] goes on; called, so that
/// there is one copy of a method's steps for all that runs them.
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

/// A plan whose steps see what is advected in the motion and nowhere else, so that each can be
/// [given](crate::Stepper::step_with) other values.
#[diagnostic::on_unimplemented(
    message = "a step of `{Self}` can't be given values",
    label = "not with this method",
    note = "the stages of Gauss collocation see what is advected from the scene; give values to another method's steps"
)]
pub trait Steerable {}

/// A plan that makes steps of any length one after the other, each with constants of its own.
///
/// A plan whose inputs are indexed by the step isn't one, nor is a processed splitting: its processor belongs to one length
/// of the steps.
#[diagnostic::on_unimplemented(
    message = "the steps of `{Self}` can't have different lengths",
    label = "not with this method",
    note = "a processor belongs to one length: take the splitting without it",
    note = "values are to be given afterwards: `.with_clock(…).driven(…)`"
)]
pub trait Variable {}

/// How many operations a step makes, about: what methods are ranked by, the same on every machine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cost {
    /// Besides the iterations.
    pub step: f64,
    /// One iteration, as [`StepReport`] counts them.
    pub iteration: f64,
    /// The fewest iterations that a step can take, but where nothing changes from step to step.
    pub fewest: u32,
    /// Of a run besides its steps, whatever their number: the processor's.
    pub once: f64,
}

/// Besides what an effect counts, the operations of a solve and its reconstruction on SO(3).
const OF_A_STAGE: f64 = 150.0;
/// Besides the Newton system, an iteration solves it and looks whether it has settled. These wait for each other, as
/// the products of matrices don't.
const OF_AN_ITERATION: f64 = 90.0;

impl Cost {
    /// The cost of a step with `stages` stages, each a solve or a flow with these operations.
    #[must_use]
    pub fn of_stages(operations: Operations, stages: u32) -> Self {
        Self {
            step: f64::from(stages) * (OF_A_STAGE + f64::from(operations.step)),
            iteration: OF_AN_ITERATION + f64::from(operations.iteration),
            // With one iteration none is known to have settled.
            fewest: if operations.iteration > 0 { 2 * stages } else { 0 },
            once: 0.0,
        }
    }

    /// What a step makes at least.
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
