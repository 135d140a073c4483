//! How a stepper steps and runs.

use super::{StateOf, Stepper};
use crate::error::StepError;
use crate::groups::Advected as _;
use crate::mechanics::{Effect, FactoredInertia, Group, Scalar, Vector, factored_inertia, velocity_and_energy};
use crate::motion::integrator::{Integrator, run_or_step, seeing};
use crate::motion::plan::{Cost, Next, NextSteps, Plan, Steerable, Variable, run_plan};
use crate::motion::report::StepReport;
use crate::motion::state::State;
use crate::motion::summation::{Motion, MotionOf};
use crate::numbers::{Coordinates as _, Kernel, Vectors, dispatch, is_finite, real};

/// # Step
///
/// One step or many, with a control force or with other values.
impl<S: Effect, P: Plan<S>> Stepper<S, P> {
    /// One step. On an error the state is unchanged.
    ///
    /// # Errors
    ///
    /// [`StepError`] where an equation of the method has no solution, for a scene's own step (2.7) on the branch of the
    /// identity, or a value isn't finite. [`StepError::BeyondSolvable`] names the largest step that would do.
    #[hot]
    pub fn step(&self, state: &mut StateOf<S, P>) -> Result<StepReport, StepError> {
        let made = if const { P::STEPS_BY_RUNS } {
            self.attempt(state, 1).map(StepReport::of_run)
        } else {
            dispatch(Step(self, state))
        };
        match made {
            Err(error) if P::EXPLAINS => Err(self.plan.explained(error, &self.scene, &state.motion, &state.kept)),
            made => made,
        }
    }

    /// Makes `steps` steps without showing the states between; returns the sum of their iterations. On an error the state
    /// is unchanged.
    ///
    /// A [splitting](Self::split) makes the last flow of a step and the first of the next as one: where its kinetic flow
    /// is exact the result is that of as many [steps](Self::step) to rounding; elsewhere they differ by some of its
    /// error.
    ///
    /// # Errors
    ///
    /// As [`step`](Self::step).
    pub fn run(&self, state: &mut StateOf<S, P>, steps: u64) -> Result<u64, StepError> {
        let mut next = *state;
        let iterations = self.run_without_copy(&mut next, steps, None)?;
        *state = next;
        Ok(iterations)
    }

    /// [`run`](Self::run) without a copy to go back to: after an error the state may be anywhere. It goes on as
    /// [`Integrator::run_stretches`] does.
    fn run_without_copy(
        &self,
        state: &mut StateOf<S, P>,
        steps: u64,
        next: Next<'_, Group<S>, S::Advected>,
    ) -> Result<u64, StepError> {
        let made = run_plan(&self.plan, &self.scene, &mut state.motion, &mut state.kept, (steps, next));
        made.map_err(|error| self.plan.explained(error, &self.scene, &state.motion, &state.kept))
    }

    /// The states after each step from here on; after an error, nothing more.
    pub fn steps(&self, state: StateOf<S, P>) -> impl Iterator<Item = Result<StateOf<S, P>, StepError>> {
        let mut current = Some(state);
        core::iter::from_fn(move || {
            let mut next = current.take()?;
            Some(Integrator::step(self, &mut next).map(|_| {
                current = Some(next);
                next
            }))
        })
    }

    /// One step under a control force, which is held over the step; on an error the state is unchanged.
    ///
    /// It is a covector in the body's axes: on SO(3) a torque in N m. By the discrete Lagrange–d'Alembert principle
    /// half of its impulse `h f` is added to the momentum at either end of the step, as by
    /// [`Torque`](crate::effects::Torque), so the scheme stays of second order for inputs that are smooth in time and
    /// taken in the middle of each step. Without a force the momentum is that of [`step`](Self::step), bit for bit.
    ///
    /// # Errors
    ///
    /// [`StepError`] where the force isn't finite, and as [`step`](Self::step); the largest step that an error names is
    /// that for the momentum with half of the impulse.
    ///
    /// # Examples
    ///
    /// A rotation is braked by a torque against the body velocity.
    ///
    /// ```
    /// use liestep::effects::RigidBody;
    /// use liestep::{NonstandardInertia, SO3, Stepper};
    /// use liestep::groups::LieGroup as _;
    /// use nalgebra::Vector3;
    ///
    /// let J_d = NonstandardInertia::from_principal_moments(Vector3::new(2.0, 3.0, 4.5))?;
    /// let stepper = Stepper::new(RigidBody { J_d }, 0.01)?;
    /// let mut state = stepper.start(SO3::identity(), Vector3::new(0.5, -1.0, 2.0))?;
    /// for _ in 0..1000 {
    ///     let torque = stepper.velocity(&state) * -2.0;
    ///     stepper.step_forced(&mut state, &torque)?;
    /// }
    /// assert!(stepper.velocity(&state).norm() < 0.1);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Source
    ///
    /// \[MW01\], section 3.2.
    pub fn step_forced(&self, state: &mut StateOf<S, P>, force: &Vector<S>) -> Result<StepReport, StepError> {
        const { assert!(!P::VARIES || P::COUNTS_TIME, "a force changes the length that a density gives its step") }
        if !force.is_finite() {
            return Err(StepError::NonFinite { what: "control force" });
        }
        let mut next = *state;
        let half = *force * (self.plan.length(&self.scene, &next.motion, &next.kept, true) * real(0.5));
        self.plan.push(&self.scene, &mut next.motion, &mut next.kept, &half)?;
        let report = Integrator::step(self, &mut next)?;
        self.plan.push(&self.scene, &mut next.motion, &mut next.kept, &half)?;
        if !next.motion.momentum.is_finite() {
            return Err(StepError::NonFinite { what: "momentum after the step" });
        }
        *state = next;
        Ok(report)
    }

    /// One step of the length `h`, s, by the same method; on an error the state is unchanged.
    ///
    /// It is for what doesn't fall on the end of a step: an impulse at an event, a time at which a motion is to end. It keeps
    /// what a step keeps, and counts for none: the [time](Self::time) is that of the steps counted and these lengths, as
    /// recordings, events and checkpoints have it. Steps whose lengths follow the state at random lose the long-time
    /// behaviour; [`with_clock`](Self::with_clock) and [`with_density`](Self::with_density) keep it.
    ///
    /// Constants are folded for the length, which takes longer than a step.
    ///
    /// # Errors
    ///
    /// [`StepError::NonFinite`] for a length that isn't finite, or one whose constants aren't; otherwise as
    /// [`step`](Self::step).
    ///
    /// # Examples
    ///
    /// ```
    /// use liestep::effects::RigidBody;
    /// use liestep::{NonstandardInertia, SO3, Stepper};
    /// use liestep::groups::LieGroup as _;
    /// use nalgebra::Vector3;
    ///
    /// let body = RigidBody { J_d: NonstandardInertia::from_principal_moments(Vector3::new(1.0, 2.0, 2.5))? };
    /// let stepper = Stepper::new(body, 0.1)?;
    /// let mut state = stepper.start(SO3::identity(), Vector3::new(0.1, 2.0, 0.2))?;
    /// let before = state.spatial_momentum();
    /// stepper.run(&mut state, 31)?;
    /// stepper.step_of(&mut state, 0.0415)?;
    /// assert!((stepper.time(&state) - 3.1415_f64).abs() < 1e-15);
    /// assert!((state.spatial_momentum() - before).norm() < 1e-14);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn step_of(&self, state: &mut StateOf<S, P>, h: Scalar<S>) -> Result<StepReport, StepError>
    where
        P: Variable,
    {
        if !is_finite(h) {
            return Err(StepError::NonFinite { what: "length of the step" });
        }
        let report = self.plan.step_of(&self.scene, &mut state.motion, &mut state.kept, h)?;
        state.elapsed.add(h);
        Ok(report)
    }

    /// One step in which what is advected has these values in space, in the place of the scene's own; on an error the
    /// state is unchanged.
    ///
    /// It is how a scene is driven: a field that is switched, a direction that goes round with the orbit, and what the
    /// declaration names in `given(…)`, a torque for example. The values are those of `scene.advected()`, in a sum a pair,
    /// and are held over the step: taken in the middle of it, the scheme stays of second order. Each step is variational
    /// by itself. Between the steps the state sees the scene's own values again, which
    /// [`energy`](Self::energy) is computed with. An inertia that depends on the values isn't checked with these.
    ///
    /// # Errors
    ///
    /// [`StepError`] where a value isn't finite, and as [`step`](Self::step).
    ///
    /// # Examples
    ///
    /// A wheel's torque that grows with time.
    ///
    /// ```
    /// use liestep::effects::RigidBody;
    /// use liestep::groups::{Given, LieGroup as _};
    /// use liestep::{NonstandardInertia, SO3, Stepper, force};
    /// use nalgebra::Vector3;
    ///
    /// #[force(group = SO3, given(u = torque), work = 0.5 * h * u * (eta + eta_next)[2])]
    /// struct Wheel {
    ///     torque: f64,
    /// }
    ///
    /// let J_d = NonstandardInertia::from_principal_moments(Vector3::new(2.0, 3.0, 4.0))?;
    /// let stepper = Stepper::new(RigidBody { J_d } + Wheel { torque: 0.0 }, 0.01)?;
    /// let mut state = stepper.start(SO3::identity(), Vector3::zeros())?;
    /// for step in 0..100 {
    ///     let middle = stepper.time(&state) + 0.005;
    ///     stepper.step_with(&mut state, &((), Given::scalar(middle)))?;
    /// }
    /// assert!((state.momentum().z - 0.5_f64).abs() < 1e-14);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn step_with(&self, state: &mut StateOf<S, P>, values: &S::Advected) -> Result<StepReport, StepError>
    where
        P: Steerable,
    {
        if !values.is_finite() {
            return Err(StepError::NonFinite { what: "value given to the step" });
        }
        let mut next = *state;
        let State { motion, kept, .. } = &mut next;
        self.plan.see(motion, kept, values.seen_from(&motion.attitude));
        let report = Integrator::step(self, &mut next)?;
        let State { motion, kept, .. } = &mut next;
        self.plan.see(motion, kept, self.scene.advected().seen_from(&motion.attitude));
        *state = next;
        Ok(report)
    }
}

impl<S: Effect, P: Plan<S>> Integrator for Stepper<S, P> {
    type Group = Group<S>;
    type Advected = S::Advected;
    type State = StateOf<S, P>;

    /// By one copy of a step, that of a run where this is the same, for all that is put around steps.
    #[inline(never)]
    fn step(&self, state: &mut Self::State) -> Result<StepReport, StepError> {
        if const { P::STEPS_BY_RUNS || P::RUNS_BY_STEPS } {
            self.run_without_copy(state, 1, None).map(StepReport::of_run)
        } else {
            Stepper::step(self, state)
        }
    }

    fn run(&self, state: &mut Self::State, steps: u64) -> Result<u64, StepError> {
        Stepper::run(self, state, steps)
    }

    #[inline]
    fn attempt(&self, state: &mut Self::State, steps: u64) -> Result<u64, StepError> {
        run_plan(&self.plan, &self.scene, &mut state.motion, &mut state.kept, (steps, None))
    }

    fn run_stretches(
        &self,
        state: &mut Self::State,
        steps: u64,
        next: &mut NextSteps<'_, Group<S>, S::Advected>,
    ) -> Result<u64, StepError> {
        if const { P::RUNS_BY_STEPS } {
            // It stops where they do, and nothing need be copied.
            let elapsed = state.elapsed.sum;
            self.run_without_copy(state, steps, Some(&mut |motion, time| next(motion, time + elapsed)))
        } else {
            run_or_step(self, state, steps, next)
        }
    }

    fn is_in_step(&self, state: &Self::State) -> bool {
        self.plan.is_in_step(&state.kept)
    }

    fn part(&self, state: &Self::State, fraction: Scalar<S>) -> Result<MotionOf<S>, StepError> {
        self.plan.part(&self.scene, &state.motion, &state.kept, fraction)
    }

    fn time(&self, state: &Self::State) -> Scalar<S> {
        Stepper::time(self, state)
    }

    fn length(&self, state: &Self::State) -> Option<Scalar<S>> {
        P::VARIES.then(|| self.plan.length(&self.scene, &state.motion, &state.kept, true))
    }

    fn cost(&self) -> Option<Cost> {
        Some(self.plan.cost())
    }

    fn adopt(&self, motion: &MotionOf<S>) -> Self::State {
        Stepper::adopt(self, motion)
    }

    fn seen(&self, motion: &Motion<Group<S>, ()>) -> MotionOf<S> {
        seeing(motion, self.plan.advected(&self.scene, motion.steps).seen_from(&motion.attitude))
    }

    fn step_size(&self) -> Scalar<S> {
        Stepper::step_size(self)
    }

    fn velocity(&self, motion: &MotionOf<S>) -> Vector<S> {
        Stepper::velocity(self, motion)
    }

    fn energy(&self, motion: &MotionOf<S>) -> Scalar<S> {
        Stepper::energy(self, motion)
    }

    fn factored_inertia(&self) -> Option<FactoredInertia<Group<S>>> {
        if const { P::HAS_OWN_INERTIA } { None } else { factored_inertia(&self.scene) }
    }

    #[hot]
    fn velocity_and_energy(
        &self,
        motion: &MotionOf<S>,
        inertia: Option<&FactoredInertia<Group<S>>>,
    ) -> (Vector<S>, Scalar<S>) {
        if const { P::HAS_OWN_INERTIA } {
            return (self.velocity(motion), self.energy(motion));
        }
        velocity_and_energy(&self.scene, inertia, &motion.momentum, &motion.advected)
    }
}

/// A step of this state.
struct Step<'a, S: Effect, P: Plan<S>>(&'a Stepper<S, P>, &'a mut StateOf<S, P>);

impl<S: Effect, P: Plan<S>> Kernel for Step<'_, S, P> {
    type Output = Result<StepReport, StepError>;
    const VECTORS: Vectors = P::VECTORS;
    const IS_IN_LANES: bool = <Scalar<S> as nalgebra::SimdValue>::LANES > 1;

    #[hot]
    fn run(self) -> Self::Output {
        self.0.plan.step(&self.0.scene, &mut self.1.motion, &mut self.1.kept)
    }
}
