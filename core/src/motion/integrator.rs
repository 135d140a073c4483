//! The common interface of all integrators, for tools that work with every method.

use alloc::boxed::Box;
use alloc::vec::Vec;
use core::ops::{ControlFlow, Deref};

use crate::error::StepError;
use crate::groups::LieGroup;
use crate::groups::layout::Factor;
use crate::motion::plan::Cost;
use crate::motion::report::StepReport;
use crate::motion::summation::Motion;
use crate::numbers::{Entries as _, Real, real};

roots!();

/// An integrator of a motion: a [`Stepper`](crate::Stepper) with any plan, an
/// [`AnyStepper`](crate::motion::AnyStepper), a [`CotangentGauss`](crate::methods::CotangentGauss).
///
/// Recording, events and frames are written for this trait, and so work with every method. Its methods are those of
/// [`Stepper`](crate::Stepper), and two more for dense output: [`part`](Self::part) and [`state_at`](Self::state_at).
pub trait Integrator {
    /// The scalar.
    type Scalar: Real;
    /// The motion at one time: a [`Motion`] of a group, or the numbers of an [`AnyStepper`](crate::motion::AnyStepper).
    type Motion: Clone;
    /// The body velocity.
    type Velocity;
    /// The inertia by which the [rows](Self::write) of a table are written, factorised once for many motions.
    type Inertia;
    /// The state: a motion, and the method's memory from step to step.
    type State: Clone + Deref<Target = Self::Motion>;

    /// Makes one step; on an error the state is unchanged.
    ///
    /// # Errors
    ///
    /// The errors of [`Stepper::step`](crate::Stepper::step).
    fn step(&self, state: &mut Self::State) -> Result<StepReport, StepError>;

    /// Makes `steps` steps; returns the sum of their iterations. On an error the state is unchanged.
    ///
    /// # Errors
    ///
    /// The errors of [`Stepper::run`](crate::Stepper::run).
    fn run(&self, state: &mut Self::State, steps: u64) -> Result<u64, StepError>;

    /// A [`run`](Self::run) without a copy of the state: on an error the state is unspecified, and the error doesn't
    /// name a step that would have a solution.
    ///
    /// # Errors
    ///
    /// [`StepError`] if one of the steps has no solution.
    fn attempt(&self, state: &mut Self::State, steps: u64) -> Result<u64, StepError> {
        self.run(state, steps)
    }

    /// A run in stretches: `steps` steps first, then each time as many as `next` returns for the motion reached, until
    /// it returns 0. Returns the number of all iterations. If `steps` is 0, no step is made and `next` isn't called.
    ///
    /// If a step fails, the run ends with the error, and the state is that before the failed step. If a run fails but
    /// none of its single steps does, which rounding in a splitting can cause, the run consists of the single steps.
    ///
    /// # Errors
    ///
    /// The errors of [`Stepper::step`](crate::Stepper::step), for the step that has no solution.
    fn run_stretches(
        &self,
        state: &mut Self::State,
        steps: u64,
        next: &mut dyn FnMut(&Self::Motion, Self::Scalar) -> u64,
    ) -> Result<u64, StepError> {
        run_or_step(self, state, steps, next)
    }

    /// Whether the lanes of a state can be stepped together in a [`Batch`](crate::motion::Batch); always true for a
    /// single body.
    #[must_use]
    fn is_in_step(&self, _state: &Self::State) -> bool {
        true
    }

    /// The motion a fraction of a step after this state, which stays unchanged.
    ///
    /// This motion is a step of the same method with that fraction of `h`. So it has the method's order and, to
    /// rounding, its invariants: the group, the momentum maps, and for a constant fraction the Poisson structure. It costs one step,
    /// and the folding of its constants. The fractions from 0 to 1 are a path from this state to the next, to rounding;
    /// if a remedy replaced the step, the path may jump by the difference of the two results. A negative fraction is a
    /// step back. The number of steps is that of the state.
    ///
    /// # Errors
    ///
    /// The errors of [`Stepper::step`](crate::Stepper::step).
    fn part(&self, state: &Self::State, fraction: Self::Scalar) -> Result<Self::Motion, StepError>;

    /// A state with the attitude and momentum of another motion; see [`Stepper::adopt`](crate::Stepper::adopt).
    fn adopt(&self, motion: &Self::Motion) -> Self::State;

    /// The number of steps up to a motion.
    fn steps(motion: &Self::Motion) -> u64;

    /// The approximate number of operations of a step; `None` if it isn't known.
    fn cost(&self) -> Option<Cost> {
        None
    }

    /// The step `h`, s; if steps vary, their unit.
    fn step_size(&self) -> Self::Scalar;

    /// The body velocity, on SO(3) in rad/s; NaN if no velocity has this momentum, see
    /// [`Stepper::velocity`](crate::Stepper::velocity).
    fn velocity(&self, motion: &Self::Motion) -> Self::Velocity;

    /// The energy, J; NaN if no velocity has this momentum.
    fn energy(&self, motion: &Self::Motion) -> Self::Scalar;

    /// The factors of the group, by which the columns of a table are named.
    fn factors(&self) -> Vec<Factor>;

    /// The inertia for [`write`](Self::write), factorised if it is the same for all motions.
    fn inertia(&self) -> Self::Inertia;

    /// Writes a row of a table without its time: the columns of the attitude, the components of velocity and momentum, the
    /// energy and the distance from the group. `attitude` has the attitude's columns of the row before, or zeros, and gets
    /// those of this one: a quaternion has the sign that is nearer to the one before.
    ///
    /// `inertia` is this integrator's [`inertia`](Self::inertia); with that of another the numbers are wrong.
    fn write(&self, motion: &Self::Motion, inertia: &Self::Inertia, attitude: &mut [Self::Scalar], row: &mut [f64])
    where
        Self::Scalar: Into<f64>;

    /// The time since the start, s: `n h` if all steps have the length `h`.
    #[allow(clippy::cast_precision_loss)] // 2⁵³ steps take longer than a career
    fn time(&self, state: &Self::State) -> Self::Scalar {
        self.step_size() * real(Self::steps(state) as f64)
    }

    /// The length of the next step, s, not finite if there is none; `None` if all steps have the length
    /// [`step_size`](Self::step_size).
    fn length(&self, _state: &Self::State) -> Option<Self::Scalar> {
        None
    }

    /// The motion at any time, s, from a state that stays unchanged: whole steps of `h`, or of `−h` backwards, and a
    /// [`part`](Self::part) of a step.
    ///
    /// # Errors
    ///
    /// [`StepError::NonFinite`] for a time that isn't finite, or that takes too many steps to count; if steps vary,
    /// [`StepError::Past`] for a time before the state; otherwise the errors of
    /// [`Stepper::step`](crate::Stepper::step).
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
    fn state_at(&self, state: &Self::State, time: f64) -> Result<Self::Motion, StepError>
    where
        Self::Scalar: Into<f64>,
    {
        /// A larger number of steps isn't exact in a double, and no run is that long.
        const MOST: f64 = 9e15;
        let h: f64 = self.step_size().into();
        if h == 0.0 && time.is_finite() {
            return Ok((**state).clone());
        }
        if self.length(state).is_some() {
            return ahead(self, state.clone(), time);
        }
        let now: f64 = self.time(state).into();
        let counted = Self::steps(state) as f64;
        let elapsed = now - h * counted;
        let steps = (time - elapsed) / h - counted;
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

/// The methods of an [`Integrator`] that most programs call, as methods of a type itself, which need no `use` of the trait.
macro_rules! inherent_steps {
    () => {
        /// Makes one step; on an error the state is unchanged.
        ///
        /// # Errors
        ///
        /// The errors of [`Stepper::step`](crate::Stepper::step).
        pub fn step(&self, state: &mut <Self as Integrator>::State) -> Result<StepReport, StepError> {
            Integrator::step(self, state)
        }

        /// Makes `steps` steps; returns the sum of their iterations. On an error the state is unchanged.
        ///
        /// # Errors
        ///
        /// The errors of [`Stepper::run`](crate::Stepper::run).
        pub fn run(&self, state: &mut <Self as Integrator>::State, steps: u64) -> Result<u64, StepError> {
            Integrator::run(self, state, steps)
        }

        /// The motion at any time, s, as by [`Integrator::state_at`].
        ///
        /// # Errors
        ///
        /// The errors of [`Integrator::state_at`].
        pub fn state_at(
            &self,
            state: &<Self as Integrator>::State,
            time: f64,
        ) -> Result<<Self as Integrator>::Motion, StepError> {
            Integrator::state_at(self, state, time)
        }

        /// The step `h`, s; if steps vary, their unit.
        #[must_use]
        pub fn step_size(&self) -> f64 {
            Integrator::step_size(self)
        }

        /// The time since the start, s.
        #[must_use]
        pub fn time(&self, state: &<Self as Integrator>::State) -> f64 {
            Integrator::time(self, state)
        }

        /// The components of the body velocity, on SO(3) in rad/s; NaN if no velocity has this momentum.
        #[must_use]
        pub fn velocity(&self, motion: &<Self as Integrator>::Motion) -> <Self as Integrator>::Velocity {
            Integrator::velocity(self, motion)
        }

        /// The energy, J; NaN if no velocity has this momentum.
        #[must_use]
        pub fn energy(&self, motion: &<Self as Integrator>::Motion) -> f64 {
            Integrator::energy(self, motion)
        }
    };
}

/// Writes a row of a table, as [`Integrator::write`]; `numbers` has those of the attitude before.
#[hot]
pub(crate) fn write_row<G, A>(
    motion: &Motion<G, A>,
    (velocity, energy): (G::Vector, G::Scalar),
    numbers: &mut [G::Scalar],
    row: &mut [f64],
) where
    G: LieGroup<Scalar: Into<f64>>,
{
    let behind = match (<&mut [_; 4]>::try_from(&mut *numbers), row.split_first_chunk_mut()) {
        // The compiler knows the length of four numbers, those of a quaternion, which makes this faster.
        (Ok(numbers), Some((places, behind))) => {
            motion.attitude.write_numbers(numbers);
            *places = numbers.map(Into::into);
            behind
        }
        _ => write_attitude(&motion.attitude, numbers, row),
    };
    let mut places = behind[..2 * G::DIMENSION + 2].iter_mut();
    let mut write = |number: G::Scalar| places.next().map_or((), |place| *place = number.into());
    velocity.each(&mut write);
    motion.momentum.each(&mut write);
    write(energy);
    write(motion.attitude.defect());
}

/// Writes the numbers of an attitude over those of the row before and into a row; returns the rest of the row.
#[inline(never)]
fn write_attitude<'a, G: LieGroup<Scalar: Into<f64>>>(
    attitude: &G,
    numbers: &mut [G::Scalar],
    row: &'a mut [f64],
) -> &'a mut [f64] {
    attitude.write_numbers(numbers);
    let (places, behind) = row.split_at_mut(numbers.len());
    places.iter_mut().zip(numbers).for_each(|(place, number)| *place = (*number).into());
    behind
}

/// [`Integrator::run_stretches`] by runs, and by single steps if a run fails.
pub(super) fn run_or_step<I: Integrator + ?Sized>(
    integrator: &I,
    state: &mut I::State,
    mut steps: u64,
    next: &mut dyn FnMut(&I::Motion, I::Scalar) -> u64,
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

/// [`Integrator::state_at`] for steps of varying length.
fn ahead<I>(integrator: &I, mut state: I::State, time: f64) -> Result<I::Motion, StepError>
where
    I: Integrator<Scalar: Into<f64>> + ?Sized,
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

/// A motion at a time, at the end of a step or between two, with its integrator.
///
/// The motion's methods are available by `Deref` to [`Motion`].
#[derive(Debug)]
pub struct Moment<'a, I: Integrator + ?Sized> {
    integrator: &'a I,
    motion: &'a I::Motion,
    time: I::Scalar,
    rising: Option<bool>,
}

impl<'a, I: Integrator + ?Sized> Moment<'a, I> {
    /// The moment at the end of a step.
    #[must_use]
    pub fn of_step(integrator: &'a I, state: &'a I::State) -> Self {
        Self { integrator, motion: state, time: integrator.time(state), rising: None }
    }

    /// The moment of a motion at any time, s.
    pub(crate) fn at(integrator: &'a I, motion: &'a I::Motion, time: I::Scalar, rising: Option<bool>) -> Self {
        Self { integrator, motion, time, rising }
    }

    /// The time since the start, s.
    #[must_use]
    pub fn time(&self) -> I::Scalar {
        self.time
    }

    /// The body velocity, on SO(3) in rad/s.
    #[must_use]
    pub fn velocity(&self) -> I::Velocity {
        self.integrator.velocity(self.motion)
    }

    /// The energy, J.
    #[must_use]
    pub fn energy(&self) -> I::Scalar {
        self.integrator.energy(self.motion)
    }

    /// The number of steps up to the motion.
    #[must_use]
    pub fn steps(&self) -> u64 {
        I::steps(self.motion)
    }

    /// The integrator of the motion.
    #[must_use]
    pub fn integrator(&self) -> &'a I {
        self.integrator
    }

    /// Whether the event's function rises, at a crossing of an event.
    #[must_use]
    pub fn rising(&self) -> Option<bool> {
        self.rising
    }
}

impl<I: Integrator + ?Sized> Deref for Moment<'_, I> {
    type Target = I::Motion;

    fn deref(&self) -> &I::Motion {
        self.motion
    }
}

/// An observer's answer to the run: to continue, to stop, or its own error.
///
/// Closures return `()`, which continues, a [`ControlFlow`], or a `Result` of one of these.
pub trait Answer {
    /// Whether the run continues, or the observer's error.
    ///
    /// # Errors
    ///
    /// The observer's own error.
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
