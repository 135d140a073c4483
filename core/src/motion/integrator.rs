//! What all that steps has in common: what is written for it goes with every method.

use alloc::boxed::Box;
use core::ops::{ControlFlow, Deref};

use crate::error::StepError;
use crate::groups::{Advected, LieGroup};
use crate::mechanics::FactoredInertia;
use crate::motion::plan::{Cost, NextSteps};
use crate::motion::report::StepReport;
use crate::motion::summation::Motion;
use crate::numbers::{Entries as _, real};

roots!();

/// Something that steps a motion: a [`Stepper`](crate::Stepper) with any plan, an [`AnyStepper`](crate::motion::AnyStepper), a
/// [`CotangentGauss`](crate::methods::CotangentGauss).
///
/// Recording, events and frames are written for this trait, and so go with every method. Its methods are those of
/// [`Stepper`](crate::Stepper), but for two, which are the dense output: [`part`](Self::part) and [`state_at`](Self::state_at).
pub trait Integrator {
    /// The group.
    type Group: LieGroup;
    /// The advected parameters.
    type Advected: Advected<Self::Group>;
    /// Its state: a motion, and what is kept from step to step.
    type State: Clone + Deref<Target = Motion<Self::Group, Self::Advected>>;

    /// One step; on an error the state is unchanged.
    ///
    /// # Errors
    ///
    /// As [`Stepper::step`](crate::Stepper::step).
    fn step(&self, state: &mut Self::State) -> Result<StepReport, StepError>;

    /// Makes `steps` steps; returns the sum of their iterations. On an error the state is unchanged.
    ///
    /// # Errors
    ///
    /// As [`Stepper::run`](crate::Stepper::run).
    fn run(&self, state: &mut Self::State, steps: u64) -> Result<u64, StepError>;

    /// As [`run`](Self::run), without a copy to go back to: on an error the state may be anywhere, and the error doesn't
    /// say which step would have a solution.
    ///
    /// # Errors
    ///
    /// [`StepError`] where one of the steps has no solution.
    fn attempt(&self, state: &mut Self::State, steps: u64) -> Result<u64, StepError> {
        self.run(state, steps)
    }

    /// A run in stretches: `steps` steps first, then each time as many as `next` returns for the motion reached, until it
    /// returns 0. Returns all iterations. Where `steps` is 0, no step is made and `next` isn't called.
    ///
    /// Where there are fewer steps it makes those: on an error the state is that of the last. Where a run has an error
    /// and none of its single steps has, which digits of a splitting may do, it is made of these.
    ///
    /// # Errors
    ///
    /// Of the step that has no solution, as [`Stepper::step`](crate::Stepper::step).
    fn run_stretches(
        &self,
        state: &mut Self::State,
        steps: u64,
        next: &mut NextSteps<'_, Self::Group, Self::Advected>,
    ) -> Result<u64, StepError> {
        run_or_step(self, state, steps, next)
    }

    /// Whether the lanes of a state go on in one way, as they have to in a [`Batch`](crate::motion::Batch); one of a body
    /// alone always does.
    #[must_use]
    fn is_in_step(&self, _state: &Self::State) -> bool {
        true
    }

    /// The motion a fraction of a step after this state, which stays where it is.
    ///
    /// It is a step of the same method with that fraction of `h`. So it has the method's order and keeps what its steps
    /// keep, to rounding: the group, the momentum maps, and for a given fraction the Poisson structure. It costs one step,
    /// and the folding of its constants. All fractions from 0 to 1 are a path that joins this state to the next, to
    /// rounding; where a remedy made the step it may jump, by as much as the two steps differ. A negative fraction is a
    /// step back. The count of steps is that of the state.
    ///
    /// # Errors
    ///
    /// As [`Stepper::step`](crate::Stepper::step).
    fn part(
        &self,
        state: &Self::State,
        fraction: ScalarIn<Self>,
    ) -> Result<Motion<Self::Group, Self::Advected>, StepError>;

    /// The state of another motion, to go on from its attitude and momentum; see [`Stepper::adopt`](crate::Stepper::adopt).
    fn adopt(&self, motion: &Motion<Self::Group, Self::Advected>) -> Self::State;

    /// A motion whose advected values aren't known, with those that are seen from its attitude after its steps.
    fn seen(&self, motion: &Motion<Self::Group, ()>) -> Motion<Self::Group, Self::Advected> {
        let mut seen = *self.adopt(&seeing(motion, Self::Advected::from_entries(&mut || real(0.0))));
        seen.steps = motion.steps;
        seen
    }

    /// How much arithmetic a step is, about; nothing where it isn't known.
    fn cost(&self) -> Option<Cost> {
        None
    }

    /// The step `h`, s; where steps vary, their unit.
    fn step_size(&self) -> ScalarIn<Self>;

    /// The body velocity, on SO(3) in rad/s; NaN where a momentum has none, see [`Stepper::velocity`](crate::Stepper::velocity).
    fn velocity(&self, motion: &Motion<Self::Group, Self::Advected>) -> <Self::Group as LieGroup>::Vector;

    /// The energy, J; NaN where a momentum has none.
    fn energy(&self, motion: &Motion<Self::Group, Self::Advected>) -> ScalarIn<Self>;

    /// The inertia in factors, on SO(3) of kg m², where it is the same for all motions, so that
    /// [`velocity_and_energy`](Self::velocity_and_energy) of many needn't factorise it again; `None` where it isn't, or
    /// isn't known.
    fn factored_inertia(&self) -> Option<FactoredInertia<Self::Group>> {
        None
    }

    /// The [velocity](Self::velocity), on SO(3) in rad/s, and the [energy](Self::energy), J, to the bit, with what they
    /// share computed once.
    ///
    /// `inertia` is this integrator's own [`factored_inertia`](Self::factored_inertia), which may be made once for many
    /// motions; that of another gives the numbers of neither. With `None` it is solved for each motion anew.
    fn velocity_and_energy(
        &self,
        motion: &Motion<Self::Group, Self::Advected>,
        inertia: Option<&FactoredInertia<Self::Group>>,
    ) -> (<Self::Group as LieGroup>::Vector, ScalarIn<Self>) {
        let _ = inertia;
        (self.velocity(motion), self.energy(motion))
    }

    /// The time since the start, s; `n h` where all steps are of `h`.
    #[allow(clippy::cast_precision_loss)] // 2⁵³ steps take longer than a career
    fn time(&self, state: &Self::State) -> ScalarIn<Self> {
        self.step_size() * real(state.steps as f64)
    }

    /// The length of the next step, s, not finite where there is none; nothing where all steps are of
    /// [`step_size`](Self::step_size).
    fn length(&self, _state: &Self::State) -> Option<ScalarIn<Self>> {
        None
    }

    /// The motion at any time, s, from a state that stays where it is: whole steps, of `h` or back of `−h`, and a
    /// [`part`](Self::part) of one.
    ///
    /// # Errors
    ///
    /// [`StepError::NonFinite`] for a time that isn't finite, or so far away that its steps can't be counted; where steps
    /// vary, [`StepError::Past`] for one before the state; otherwise as [`Stepper::step`](crate::Stepper::step).
    ///
    /// # Examples
    ///
    /// ```
    /// use liestep::effects::RigidBody;
    /// use liestep::motion::Integrator as _;
    /// use liestep::{NonstandardInertia, SO3, Stepper};
    /// use nalgebra::Vector3;
    ///
    /// let body = RigidBody { J_d: NonstandardInertia::from_principal_moments(Vector3::new(1.0, 2.0, 2.5))? };
    /// let stepper = Stepper::new(body, 0.01)?;
    /// let state = stepper.start(SO3::identity(), Vector3::new(0.1, 2.0, 0.2))?;
    /// let between = stepper.state_at(&state, 0.123)?;
    /// assert!((between.spatial_momentum() - state.spatial_momentum()).norm() < 1e-14);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_precision_loss)] // checked
    fn state_at(&self, state: &Self::State, time: f64) -> Result<Motion<Self::Group, Self::Advected>, StepError>
    where
        ScalarIn<Self>: Into<f64>,
    {
        /// More are no number of steps that a run can make.
        const MOST: f64 = 9e15;
        let h: f64 = self.step_size().into();
        if h == 0.0 && time.is_finite() {
            return Ok(**state);
        }
        if self.length(state).is_some() {
            return ahead(self, state.clone(), time);
        }
        let now: f64 = self.time(state).into();
        let elapsed = now - h * state.steps as f64;
        let steps = (time - elapsed) / h - state.steps as f64;
        let can_be_counted = steps.abs() < MOST;
        if !can_be_counted {
            return Err(StepError::NonFinite { what: "time" });
        }
        let whole = steps.trunc();
        let mut state = state.clone();
        if whole >= 0.0 {
            self.run(&mut state, whole as u64)?;
        } else {
            for _ in 0..-whole as u64 {
                state = self.adopt(&self.part(&state, real(-1.0))?);
            }
        }
        self.part(&state, real(steps - whole))
    }
}

/// The same motion with these advected values.
pub(super) fn seeing<G: LieGroup, A, B>(motion: &Motion<G, A>, advected: B) -> Motion<G, B> {
    Motion { attitude: motion.attitude, momentum: motion.momentum, advected, steps: motion.steps }
}

/// [`Integrator::run_stretches`] by runs, or by single steps where a run has an error.
pub(super) fn run_or_step<I: Integrator + ?Sized>(
    integrator: &I,
    state: &mut I::State,
    mut steps: u64,
    next: &mut NextSteps<'_, I::Group, I::Advected>,
) -> Result<u64, StepError> {
    let mut iterations = 0;
    while steps > 0 {
        match integrator.run(state, steps) {
            Ok(made) => iterations += made,
            Err(_) => {
                for _ in 0..steps {
                    iterations += u64::from(integrator.step(state)?.iterations);
                }
            }
        }
        steps = next(state, integrator.time(state));
    }
    Ok(iterations)
}

/// [`Integrator::state_at`] where steps vary.
fn ahead<I>(integrator: &I, mut state: I::State, time: f64) -> Result<Motion<I::Group, I::Advected>, StepError>
where
    I: Integrator<Group: LieGroup<Scalar: Into<f64>>> + ?Sized,
{
    if !time.is_finite() {
        return Err(StepError::NonFinite { what: "time" });
    }
    let h: f64 = integrator.step_size().into();
    loop {
        let now: f64 = integrator.time(&state).into();
        let length: f64 = integrator.length(&state).unwrap_or(integrator.step_size()).into();
        let left = time - now;
        if left * h.signum() < 0.0 {
            return Err(StepError::Past { time, now });
        }
        if left.abs() < length.abs() {
            return integrator.part(&state, real(left / length));
        }
        integrator.step(&mut state)?;
    }
}

/// The scalar of an integrator.
pub type ScalarIn<I> = <<I as Integrator>::Group as LieGroup>::Scalar;

/// A motion at a time, at the end of a step or between two, with what steps it.
///
/// It is read as a [`Motion`], to which it derefs.
#[derive(Debug)]
pub struct Moment<'a, I: Integrator + ?Sized> {
    integrator: &'a I,
    motion: &'a Motion<I::Group, I::Advected>,
    time: ScalarIn<I>,
    rising: Option<bool>,
}

impl<'a, I: Integrator + ?Sized> Moment<'a, I> {
    /// At the end of a step.
    #[must_use]
    pub fn of_step(integrator: &'a I, state: &'a I::State) -> Self {
        Self { integrator, motion: state, time: integrator.time(state), rising: None }
    }

    /// At any time, s.
    pub(crate) fn at(
        integrator: &'a I,
        motion: &'a Motion<I::Group, I::Advected>,
        time: ScalarIn<I>,
        rising: Option<bool>,
    ) -> Self {
        Self { integrator, motion, time, rising }
    }

    /// The time since the start, s.
    #[must_use]
    pub fn time(&self) -> ScalarIn<I> {
        self.time
    }

    /// The body velocity, on SO(3) in rad/s.
    #[must_use]
    pub fn velocity(&self) -> <I::Group as LieGroup>::Vector {
        self.integrator.velocity(self.motion)
    }

    /// The energy, J.
    #[must_use]
    pub fn energy(&self) -> ScalarIn<I> {
        self.integrator.energy(self.motion)
    }

    /// What steps the motion.
    #[must_use]
    pub fn integrator(&self) -> &'a I {
        self.integrator
    }

    /// At a crossing of an event, whether its function rises there.
    #[must_use]
    pub fn rising(&self) -> Option<bool> {
        self.rising
    }
}

impl<I: Integrator + ?Sized> Deref for Moment<'_, I> {
    type Target = Motion<I::Group, I::Advected>;

    fn deref(&self) -> &Self::Target {
        self.motion
    }
}

/// What an observer says to the run that it observes: nothing, whether to go on, or that it failed.
///
/// Closures return `()`, a [`ControlFlow`], or a `Result` of one of these.
pub trait Answer {
    /// To go on or not, or the error.
    ///
    /// # Errors
    ///
    /// The observer's own.
    fn verdict(self) -> Result<ControlFlow<()>, Box<dyn core::error::Error + Send + Sync>>;
}

impl Answer for () {
    fn verdict(self) -> Result<ControlFlow<()>, Box<dyn core::error::Error + Send + Sync>> {
        Ok(ControlFlow::Continue(()))
    }
}

impl Answer for ControlFlow<()> {
    fn verdict(self) -> Result<ControlFlow<()>, Box<dyn core::error::Error + Send + Sync>> {
        Ok(self)
    }
}

impl<R: Answer, E: Into<Box<dyn core::error::Error + Send + Sync>>> Answer for Result<R, E> {
    fn verdict(self) -> Result<ControlFlow<()>, Box<dyn core::error::Error + Send + Sync>> {
        self.map_err(Into::into)?.verdict()
    }
}
