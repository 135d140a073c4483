//! Asking by accuracy: the cheapest method and its step; and measuring it: orders, and what an error costs.
//!
//! | | |
//! |---|---|
//! | the cheapest method and step for an error | [`Stepper::for_accuracy`](crate::motion::Stepper::for_accuracy), [`Candidates`] |
//! | errors and orders of a method with ever shorter steps | [`convergence`] |
//! | what an error costs in time | [`work_precision`] |
//! | the same of anything else that runs | [`Refinement`] |
//!
//! # How a choice is made
//!
//! All methods are tried over a short part of the very motion, with one step, two, four and so on. Their errors there
//! rank them by the operations that their steps make, by no clock, so that the same question has the same answer each
//! time on one platform. The one that looks cheapest is run to the horizon with ever shorter steps, until they show the
//! error of those before (Richardson); the finest is the reference for all the others that may be cheaper. Growth of
//! errors along the motion, steps too long to be solved and orders that coarse steps haven't got yet are in these
//! measurements: the step is taken from a run to the horizon whose error has been measured against a finer one, and of
//! that one only the own error is extrapolated.
//!
//! A fraction of a turn at a tolerance of some hundredths can be answered by runs of one and two steps that agree by
//! chance: of 1200 such questions in the tests four are, and their errors are up to thirteen times the tolerance.
//!
//! A long step of the cheapest method tells how far the motion goes, each phase has its share, and no trial from the
//! start is made twice. In the tests, some three hundred questions with answers of one step to thousands, all trials
//! together cost at most thirty times the run, and half of them at most ten times. Once a run is near enough, another is
//! made only if all are thought to stay within thirty runs of the cheapest. Before that what a run will cost isn't known,
//! and the operations alone are bounded: a scene that would take more than some seconds is refused with what was tried.

mod candidates;
mod choice;
mod error;
mod ladder;
mod part;
mod refinement;
mod search;
mod trials;

pub use candidates::Candidates;
pub use choice::{Choice, Offer};
pub use error::AccuracyError;
#[cfg(feature = "std")]
pub use refinement::{Effort, work_precision};
pub use refinement::{End, Measurement, Reference, Refinement, RefinementError, convergence};
pub use trials::Trials;

use core::ops::Deref;

use crate::error::StepError;
use crate::groups::{Advected, LieGroup};
use crate::mechanics::{Effect, Group, Scene, Vector};
use crate::motion::{AnyState, AnyStepper, Integrator as _, Stepper};

/// How near to the true motion, and until when.
///
/// The error at the horizon `T` is that of attitude and body velocity together,
///
/// ```text
/// error² = (|g − g*|/|g*|)² + (|Ω − Ω*|/s)²        s = max(|Ω*(T)|, |Ω(0)|, 1/T)
/// ```
///
/// with the exact `g*`, `Ω*`, and for matrices the Frobenius norm: on SO(3) the first part is `√(8/3) sin(θ/2)` for an
/// attitude wrong by the angle `θ`, about `0.8 θ`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accuracy {
    /// The largest error at the horizon, up to 0.05: what is larger isn't an error but another motion.
    pub tolerance: f64,
    /// The time `T` from the start, s.
    pub horizon: f64,
}

impl Accuracy {
    fn validate(self) -> Result<(), AccuracyError> {
        let Self { tolerance, horizon } = self;
        if !(tolerance > 0.0 && tolerance <= ladder::LARGEST_ERROR) {
            return Err(AccuracyError::Tolerance { tolerance });
        }
        if !(horizon > 0.0 && horizon.is_finite()) {
            return Err(AccuracyError::Horizon { horizon });
        }
        Ok(())
    }

    /// What an error of the velocity is relative to.
    fn scale(at_start: f64, at_horizon: f64, horizon: f64) -> f64 {
        at_start.max(at_horizon).max(horizon.recip())
    }
}

impl<S: Effect> Stepper<S> {
    /// The cheapest way to an accuracy that a scene of order 2 has by itself: its own step, or a symmetric composition
    /// of order 4, 6, 8 or 10, with the step that is just short enough for the motion from this attitude (body to
    /// space) and body velocity.
    ///
    /// The choice takes trial runs, which cost together some ten times what the run does; [`Choice::trials`] says how
    /// much. The step is then fixed: energy and momenta are kept as by any fixed step, and the same question gives the
    /// same bits. [`Candidates`] chooses from more methods, where a scene allows them.
    ///
    /// # Errors
    ///
    /// [`AccuracyError`], among others where rounding alone is larger than the tolerance at the horizon, and where
    /// trials would take more than some seconds.
    ///
    /// # Examples
    ///
    /// ```
    /// use liestep::effects::RigidBody;
    /// use liestep::{NonstandardInertia, SO3, Stepper};
    /// use liestep::accuracy::Accuracy;
    /// use liestep::groups::LieGroup;
    /// use nalgebra::Vector3;
    ///
    /// let body = RigidBody { J_d: NonstandardInertia::from_principal_moments(Vector3::new(1.0, 2.0, 2.5))? };
    /// let accuracy = Accuracy { tolerance: 1e-6, horizon: 20.0 };
    /// let stepper = Stepper::for_accuracy(body, accuracy, SO3::identity(), Vector3::new(0.01, 2.0, 0.02))?;
    /// let mut state = stepper.start();
    /// stepper.run(&mut state)?;
    /// assert!((stepper.time(&state) - 20.0).abs() < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn for_accuracy(
        scene: S,
        accuracy: Accuracy,
        attitude: impl Into<Group<S>>,
        velocity: Vector<S>,
    ) -> Result<AccurateStepper<Group<S>, S::Advected>, AccuracyError>
    where
        S: Scene<Scalar = f64>,
    {
        Candidates::of(scene, 2).for_accuracy(accuracy, attitude, velocity)
    }
}

/// A stepper chosen for an accuracy by [`Stepper::for_accuracy`] or [`Candidates::for_accuracy`].
///
/// It steps, tells time, velocity and energy as the [`AnyStepper`] that it holds.
#[derive(Debug)]
pub struct AccurateStepper<G: LieGroup, A> {
    stepper: AnyStepper<G, A>,
    start: AnyState<G, A>,
    choice: Choice,
}

impl<G: LieGroup, A: Advected<G>> AccurateStepper<G, A> {
    /// The motion that the accuracy was asked for, at its start.
    #[must_use]
    pub fn start(&self) -> AnyState<G, A> {
        self.start.clone()
    }

    /// All steps from the state to the horizon; none where it is there or beyond. On an error the state is unchanged.
    ///
    /// # Errors
    ///
    /// [`StepError`] as of the method; none for the motion from [`start`](Self::start).
    pub fn run(&self, state: &mut AnyState<G, A>) -> Result<(), StepError> {
        self.stepper.run(state, self.choice.steps.saturating_sub(state.steps())).map(|_| ())
    }

    /// What was chosen, and what else there was.
    #[must_use]
    pub fn choice(&self) -> &Choice {
        &self.choice
    }
}

impl<G: LieGroup, A> Deref for AccurateStepper<G, A> {
    type Target = AnyStepper<G, A>;

    fn deref(&self) -> &AnyStepper<G, A> {
        &self.stepper
    }
}
