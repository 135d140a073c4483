//! Steps and runs of a stepper.

use alloc::vec::Vec;

use super::{StateOf, Stepper};
use crate::error::StepError;
use crate::groups::layout::Factor;
use crate::groups::{Advected as _, LieGroup as _};
use crate::mechanics::{Effect, FactoredInertia, Group, Scalar, Vector, factored_inertia, velocity_and_energy};
use crate::motion::integrator::{Integrator, run_or_step, write_row};
use crate::motion::kept::Kept as _;
use crate::motion::plan::{Cost, Next, NextSteps, Plan, Steerable, Variable, explained, run_plan};
use crate::motion::report::StepReport;
use crate::motion::state::State;
use crate::motion::summation::MotionOf;
use crate::numbers::{Coordinates as _, Kernel, Vectors, dispatch, is_finite, real};

/// # Step
///
/// One step or many, with a control force or with prescribed parameters.
impl<S: Effect, P: Plan<S>> Stepper<S, P> {
    /// Makes one step. On an error the state is unchanged.
    ///
    /// # Errors
    ///
    /// [`StepError`] if an equation of the method has no solution, for a scene's own step (2.7) on the branch of the
    /// identity, or if a value isn't finite. [`StepError::BeyondSolvable`] names the largest solvable step.
    #[hot]
    pub fn step(&self, state: &mut StateOf<S, P>) -> Result<StepReport, StepError> {
        let made = if const { P::FACTS.runs.are_steps() } {
            self.attempt(state, 1).map(StepReport::of_run)
        } else {
            dispatch(Step(self, state))
        };
        match made {
            Err(error) if P::FACTS.explains => {
                Err(explained(&self.plan, error, (&self.scene, &state.motion, &state.kept)))
            }
            made => made,
        }
    }

    /// Makes `steps` steps without access to the states between; returns the sum of their iterations. On an error the
    /// state is unchanged.
    ///
    /// A [splitting](Self::split) merges the last flow of a step and the first of the next. If its kinetic flow is
    /// exact, the result is that of as many [steps](Self::step) to rounding; otherwise the two differ by a part of the
    /// flow's error.
    ///
    /// # Errors
    ///
    /// The errors of [`step`](Self::step).
    pub fn run(&self, state: &mut StateOf<S, P>, steps: u64) -> Result<u64, StepError> {
        let mut next = *state;
        let iterations = self.run_without_copy(&mut next, steps, None)?;
        *state = next;
        Ok(iterations)
    }

    /// A [`run`](Self::run) without a copy of the state: after an error the state is unspecified. It continues as
    /// [`Integrator::run_stretches`] does.
    fn run_without_copy(
        &self,
        state: &mut StateOf<S, P>,
        steps: u64,
        next: Next<'_, Group<S>, S::Advected>,
    ) -> Result<u64, StepError> {
        let made = run_plan(&self.plan, &self.scene, &mut state.motion, &mut state.kept, (steps, next));
        made.map_err(|error| explained(&self.plan, error, (&self.scene, &state.motion, &state.kept)))
    }

    /// The states after each step from here on; an error is the last item.
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

    /// Makes one step under a control force that is constant over the step; on an error the state is unchanged.
    ///
    /// The force is a covector in the body's axes: on SO(3) a torque in N m. By the discrete Lagrange–d'Alembert
    /// principle half of its impulse `h f` is added to the momentum at either end of the step, as by
    /// [`Torque`](crate::effects::Torque). So the scheme stays of second order for smooth functions of time that are
    /// evaluated in the middle of each step. With a force of zero the momentum is that of [`step`](Self::step), bit for
    /// bit.
    ///
    /// # Errors
    ///
    /// [`StepError`] if the force isn't finite, and the errors of [`step`](Self::step); the largest step in an error is
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
        const {
            assert!(
                !P::FACTS.varies || P::FACTS.counts_time,
                "a force changes the length that a density gives its step"
            );
        }
        self.forced(state, force)
    }

    /// [`step_forced`](Self::step_forced), also where a force changes the length of its step.
    pub(crate) fn forced(&self, state: &mut StateOf<S, P>, force: &Vector<S>) -> Result<StepReport, StepError> {
        if !force.is_finite() {
            return Err(StepError::NonFinite { what: "control force" });
        }
        let mut next = *state;
        let half = *force * (self.plan.length(&self.scene, &next.motion, &next.kept, true) * real(0.5));
        self.plan.push(&self.scene, &mut next.motion, &mut next.kept, &half);
        let report = Integrator::step(self, &mut next)?;
        self.plan.push(&self.scene, &mut next.motion, &mut next.kept, &half);
        if !next.motion.momentum.is_finite() {
            return Err(StepError::NonFinite { what: "momentum after the step" });
        }
        *state = next;
        Ok(report)
    }

    /// Makes one step of the length `h`, s, by the same method; on an error the state is unchanged.
    ///
    /// Such a step serves times that don't coincide with the end of a step: an impulse at an event, or the end of a motion. It
    /// has the invariants of a step, but isn't counted: the [time](Self::time) is that of the counted steps and these
    /// lengths, also in recordings, events and checkpoints. Steps whose lengths depend irregularly on the state lose
    /// the long-time behaviour; [`with_clock`](Self::with_clock) and [`with_density`](Self::with_density) preserve it.
    ///
    /// The constants are folded for the length, which takes longer than a step.
    ///
    /// # Errors
    ///
    /// [`StepError::NonFinite`] for a length that isn't finite, or one whose constants aren't; otherwise the errors of
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
        P: Variable<S>,
    {
        if !is_finite(h) {
            return Err(StepError::NonFinite { what: "length of the step" });
        }
        let report = self.plan.step_of(&self.scene, &mut state.motion, &mut state.kept, h)?;
        state.elapsed.add(h);
        Ok(report)
    }

    /// Makes one step with these values of the advected parameters in space instead of the scene's own; on an error the
    /// state is unchanged.
    ///
    /// So a scene is driven: by a field that is switched, a direction that rotates with the orbit, or a parameter that
    /// the declaration names in `given(…)`, such as a torque. The values are those of `scene.advected()`, a pair in a
    /// sum, and are constant over the step: evaluated in the middle of it, they leave the scheme of second order. Each
    /// step is variational by itself. Between the steps the state has the scene's own values again, which
    /// [`energy`](Self::energy) uses. An inertia that depends on the values isn't checked for these.
    ///
    /// # Errors
    ///
    /// [`StepError`] if a value isn't finite, and the errors of [`step`](Self::step).
    ///
    /// # Examples
    ///
    /// A wheel's torque grows with time.
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
        P: Steerable<S>,
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
    type Scalar = Scalar<S>;
    type Motion = MotionOf<S>;
    type Velocity = Vector<S>;
    type Inertia = Option<FactoredInertia<Group<S>>>;
    type State = StateOf<S, P>;

    /// All wrappers of steps use one compiled copy of a step, that of a run if it is the same.
    #[inline(never)]
    fn step(&self, state: &mut Self::State) -> Result<StepReport, StepError> {
        if const { P::FACTS.runs.are_steps() || P::FACTS.runs.are_sequences() } {
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
        if const { P::FACTS.runs.are_sequences() } {
            // A run stops at the same state as single steps, and no copy is needed.
            let elapsed = state.elapsed.sum;
            self.run_without_copy(state, steps, Some(&mut |motion, time| next(motion, time + elapsed)))
        } else {
            run_or_step(self, state, steps, next)
        }
    }

    fn is_in_step(&self, state: &Self::State) -> bool {
        state.kept.is_in_step(self.plan.step_size())
    }

    fn part(&self, state: &Self::State, fraction: Scalar<S>) -> Result<MotionOf<S>, StepError> {
        self.plan.part(&self.scene, &state.motion, &state.kept, fraction)
    }

    fn time(&self, state: &Self::State) -> Scalar<S> {
        Stepper::time(self, state)
    }

    fn length(&self, state: &Self::State) -> Option<Scalar<S>> {
        P::FACTS.varies.then(|| self.plan.length(&self.scene, &state.motion, &state.kept, true))
    }

    fn cost(&self) -> Option<Cost> {
        Some(self.plan.cost())
    }

    fn adopt(&self, motion: &MotionOf<S>) -> Self::State {
        Stepper::adopt(self, motion)
    }

    fn steps(motion: &MotionOf<S>) -> u64 {
        motion.steps
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

    fn factors(&self) -> Vec<Factor> {
        Group::<S>::factors()
    }

    fn inertia(&self) -> Self::Inertia {
        if const { P::FACTS.has_own_inertia } { None } else { factored_inertia(&self.scene) }
    }

    fn write(&self, motion: &MotionOf<S>, inertia: &Self::Inertia, attitude: &mut [Scalar<S>], row: &mut [f64])
    where
        Scalar<S>: Into<f64>,
    {
        let read = if const { P::FACTS.has_own_inertia } {
            (self.velocity(motion), self.energy(motion))
        } else {
            velocity_and_energy(&self.scene, inertia.as_ref(), &motion.momentum, &motion.advected)
        };
        write_row(motion, read, attitude, row);
    }
}

/// A step of this state, as a kernel.
struct Step<'a, S: Effect, P: Plan<S>>(&'a Stepper<S, P>, &'a mut StateOf<S, P>);

impl<S: Effect, P: Plan<S>> Kernel for Step<'_, S, P> {
    type Output = Result<StepReport, StepError>;
    const VECTORS: Vectors = P::FACTS.vectors;
    const IS_IN_LANES: bool = <Scalar<S> as nalgebra::SimdValue>::LANES > 1;

    #[hot]
    fn run(self) -> Self::Output {
        self.0.plan.step(&self.0.scene, &mut self.1.motion, &mut self.1.kept)
    }
}
