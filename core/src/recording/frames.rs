//! Motion at the times of a renderer: whole steps, and a part of a step for the remaining time.

use core::fmt;

use super::event::next_length;
use crate::error::StepError;
use crate::motion::Integrator;
use crate::numbers::real;

roots!();

/// A motion at the times of its viewer: frames of a game, samples of a loudspeaker, slow motion.
///
/// The steps have their fixed length whatever the frames', so the motion is the same at all rates, to the bit. The
/// remainder of the time in whole steps counts for the next frame, and this frame has the motion at its own time: a
/// [`part`](Integrator::part) of a step ahead of the last one made, neither behind it nor interpolated, so that nothing
/// lags, attitudes are rotations, and momentum maps are conserved.
///
/// # Examples
///
/// A spinning top at 60 frames a second, one of which comes late.
///
/// ```
/// use liestep::effects::{Gravity, RigidBody};
/// use liestep::nalgebra::{UnitQuaternion, Vector3};
/// use liestep::recording::Frames;
/// use liestep::{NonstandardInertia, Stepper};
///
/// let body = RigidBody { J_d: NonstandardInertia::from_diagonal(Vector3::new(2.0, 2.0, 1.0))? };
/// let top = body + Gravity { m: 1.0, g: 9.81, rho: Vector3::z(), up: Vector3::z() };
/// let stepper = Stepper::new(top, 0.01)?.or_substeps(16);
/// let tilted = UnitQuaternion::from_scaled_axis(Vector3::new(0.3, 0.0, 0.0));
/// let state = stepper.start(tilted, Vector3::new(0.0, 0.0, 20.0))?;
///
/// let mut frames = Frames::new(stepper, state);
/// for frame in 0..120 {
///     let elapsed = if frame == 60 { 0.1 } else { 1.0 / 60.0 };
///     let now = frames.advance(elapsed)?;
///     let shown: UnitQuaternion<f64> = now.attitude().into(); // for the renderer
///     assert!((shown * Vector3::z()).z > 0.9);
/// }
/// assert!((frames.time() - (119.0 / 60.0 + 0.1)).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Frames<I: Integrator> {
    integrator: I,
    state: I::State,
    /// The remainder of the time, in steps.
    left: f64,
    most_steps: u64,
}

/// Default limit of the steps in one frame, for a frame after a pause.
const MOST_STEPS: u64 = 1000;

impl<I: Integrator> Frames<I>
where
    I::Scalar: Into<f64>,
{
    /// The frames of the motion from this state.
    pub fn new(integrator: I, state: I::State) -> Self {
        Self { integrator, state, left: 0.0, most_steps: MOST_STEPS }
    }

    /// Limits the steps in one frame, by default 1000; time beyond that is dropped, for example after a debugger has
    /// halted the program.
    #[must_use]
    pub fn with_at_most(mut self, steps: u64) -> Self {
        self.most_steps = steps;
        self
    }

    /// Advances by the time of a frame, s, and returns the motion then.
    ///
    /// A time that isn't positive, or is NaN, counts as zero.
    ///
    /// # Errors
    ///
    /// [`StepError`] if a step fails. The state is then the last one before it, and the time of the frame is lost.
    #[allow(clippy::cast_precision_loss, clippy::cast_possible_truncation, clippy::cast_sign_loss)] // bounded
    pub fn advance(&mut self, elapsed: f64) -> Result<I::Motion, StepError> {
        if self.integrator.length(&self.state).is_some() {
            return self.advance_by_lengths(elapsed.max(0.0));
        }
        let h: f64 = self.integrator.step_size().into();
        let due = self.left + elapsed.max(0.0) / h.abs();
        // An infinite time makes as many steps as allowed, and so does any time with steps of zero, which change
        // nothing.
        let due = if due.is_finite() { due } else { self.most_steps as f64 };
        let whole = due.floor().min(self.most_steps as f64);
        self.left = 0.0;
        for _ in 0..whole as u64 {
            self.integrator.step(&mut self.state)?;
        }
        self.left = if due - whole < 1.0 { due - whole } else { 0.0 };
        self.integrator.part(&self.state, real(self.left))
    }

    /// [`advance`](Self::advance) for steps of varying length.
    fn advance_by_lengths(&mut self, mut elapsed: f64) -> Result<I::Motion, StepError> {
        let (mut left, mut made) = (core::mem::replace(&mut self.left, 0.0), 0);
        loop {
            let h = next_length(&self.integrator, &self.state).into().abs();
            let due = left + elapsed / h;
            let is_short = due < 1.0;
            if is_short || made == self.most_steps {
                self.left = if is_short { due } else { 0.0 };
                return self.integrator.part(&self.state, real(self.left));
            }
            elapsed -= (1.0 - left) * h;
            (left, made) = (0.0, made + 1);
            self.integrator.step(&mut self.state)?;
        }
    }

    /// The time of the last frame, s.
    pub fn time(&self) -> f64 {
        self.integrator.time(&self.state).into() + self.left * next_length(&self.integrator, &self.state).into()
    }

    /// The state after the last whole step.
    pub fn state(&self) -> &I::State {
        &self.state
    }

    /// The integrator of the motion.
    pub fn integrator(&self) -> &I {
        &self.integrator
    }
}

impl<I: Integrator> fmt::Debug for Frames<I> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Frames")
            .field("steps", &I::steps(&self.state))
            .field("left", &self.left)
            .finish_non_exhaustive()
    }
}
