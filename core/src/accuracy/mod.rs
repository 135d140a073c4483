//! Choice by accuracy: the cheapest method and its step, by
//! [`Stepper::for_accuracy`](crate::motion::Stepper::for_accuracy).
//!
//! The package `liestep-refinement` measures errors, orders and costs of a method of your own choice.
//!
//! # The search
//!
//! Methods are compared by the operations of their runs, not by a clock, so that the same request has the same answer
//! each time on one platform. One method is run with ever shorter steps until its runs agree (Richardson); the finest
//! is the reference for all others. Then the method with the lowest expected cost is run, again and again, until none
//! can be cheaper than the best. The search begins with a short part of the motion, and repeats over parts eight times
//! as long, each with the steps estimated from the part before, up to the horizon. The final step is that of a run to
//! the horizon whose error has been measured against a finer one.
//!
//! For a fraction of a turn at a tolerance of some hundredths, runs of one and two steps may agree by chance. The
//! operations of all trials are bounded: a scene that would take more than some seconds is refused with a report of the
//! trials.

mod choice;
mod error;
mod ladder;
mod measure;
mod methods;
mod question;
mod search;

pub use choice::{Choice, Offer};
pub use error::AccuracyError;
pub use measure::Measure;
pub use methods::{Candidate, of_any_group};
pub use question::{Accuracy, End, Trials};

use alloc::vec::Vec;
use core::ops::Deref;

use question::Start;

use crate::error::{SetupError, StepError};
use crate::groups::{Advected, LieGroup};
use crate::mechanics::{Effect, Group, Scene, Vector};
use crate::motion::{AnyStepper, GroupState, GroupStepper, Stepper};
use crate::with::{Method, Steppable};

impl<S: Effect> Stepper<S> {
    /// The cheapest method for an accuracy, with the longest sufficient step for the motion from this attitude (body to
    /// space) and body velocity.
    ///
    /// Every self-adjoint scene has its own step and its symmetric compositions of order 4 to 10. A body on SO(3) whose
    /// potential can be split off has splittings with the exact motion of the free body, processed ones among them, and
    /// Gauss collocation; a free body has its exact motion.
    ///
    /// The choice makes trial runs, whose total cost is some twenty times that of the run; [`Choice::trials`] has the
    /// ratio. The step is then fixed: energy and momenta are conserved as by any fixed step, and the same request gives
    /// the same bits.
    ///
    /// # Errors
    ///
    /// [`AccuracyError`], among others if rounding alone is larger than the tolerance at the horizon, or if trials
    /// would take more than some seconds.
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
    #[allow(clippy::needless_pass_by_value)] // as in all other constructors of steppers
    pub fn for_accuracy(
        scene: S,
        accuracy: Accuracy,
        attitude: impl Into<Group<S>>,
        velocity: Vector<S>,
    ) -> Result<AccurateStepper<Group<S>, S::Advected>, AccuracyError>
    where
        S: Scene<Scalar = f64>,
        Group<S>: Steppable<S>,
    {
        let (Accuracy { horizon, .. }, attitude) = (accuracy, attitude.into());
        if scene.with_energy(&scene.advected(), 0.0).is_some() {
            let cause = "has a time of its own, whose steps are those of `Stepper::new(…)?.paced()`";
            return Err(SetupError::Parameter { field: "pace", cause }.into());
        }
        let (candidates, start) = (methods::candidates(&scene), Start::new(&attitude, &velocity, horizon));
        let choice = checked(&candidates, accuracy, &start)?;
        let chosen = choice.chosen();
        let stepper = Method::from(chosen.scheme).stepper(scene, chosen.step)?.on_group();
        let stepper = stepper.ok_or(SetupError::Method { cause: "has other states; take another method" })?;
        let start = stepper.start(attitude, velocity)?;
        Ok(AccurateStepper { stepper, start, choice })
    }
}

/// The choice among these, after a check of the request.
fn checked(candidates: &[Candidate], accuracy: Accuracy, start: &Start) -> Result<Choice, AccuracyError> {
    let Accuracy { tolerance, horizon } = accuracy;
    if !(tolerance > 0.0 && tolerance <= ladder::LARGEST_ERROR) {
        return Err(AccuracyError::Tolerance { tolerance });
    }
    if !(horizon > 0.0 && horizon.is_finite()) {
        return Err(AccuracyError::Horizon { horizon });
    }
    // Rounding leaves more than the least tolerance, and quotients by much smaller ones overflow.
    let searched = Accuracy { tolerance: tolerance.max(LEAST), ..accuracy };
    search::search(candidates, searched, start).map_err(|error| match error {
        AccuracyError::Unreachable { floor, trials, .. } => AccuracyError::Unreachable { tolerance, floor, trials },
        other => other,
    })
}

/// The least tolerance that is searched for.
const LEAST: f64 = 1e-17;

/// The cheapest of these steppers for an accuracy, as by [`Stepper::for_accuracy`], for states that are numbers.
///
/// `beside` is the attitude displaced by [`displacement`], by which the growth of rounding errors is measured.
///
/// # Errors
///
/// As there.
pub fn choose(
    candidates: &[Candidate],
    accuracy: Accuracy,
    [attitude, beside]: [&[f64]; 2],
    velocity: &[f64],
    measure: Measure,
) -> Result<(AnyStepper, Choice), AccuracyError> {
    let start = Start::of_numbers([attitude, beside], velocity, measure, accuracy.horizon);
    let choice = checked(candidates, accuracy, &start)?;
    let stepper = (candidates[choice.chosen].make)(choice.chosen().step)?;
    Ok((stepper, choice))
}

/// A displacement by some roundings, in all directions of an algebra with this many components.
#[must_use]
pub fn displacement(components: usize) -> Vec<f64> {
    question::displacement(components)
}

/// A stepper chosen for an accuracy by [`Stepper::for_accuracy`].
///
/// The stepper has the steps, times, velocities and energies of the [`GroupStepper`] inside.
#[derive(Debug)]
pub struct AccurateStepper<G: LieGroup, A> {
    stepper: GroupStepper<G, A>,
    start: GroupState<G, A>,
    choice: Choice,
}

impl<G: LieGroup<Scalar = f64>, A: Advected<G>> AccurateStepper<G, A> {
    /// The start of the motion for which the accuracy was requested.
    #[must_use]
    pub fn start(&self) -> GroupState<G, A> {
        self.start.clone()
    }

    /// Makes all steps from the state to the horizon; none if it is there or beyond. On an error the state is
    /// unchanged.
    ///
    /// # Errors
    ///
    /// [`StepError`] of the method; none for the motion from [`start`](Self::start).
    pub fn run(&self, state: &mut GroupState<G, A>) -> Result<(), StepError> {
        self.stepper.run(state, self.choice.steps.saturating_sub(state.steps())).map(|_| ())
    }

    /// The chosen method, and the alternatives.
    #[must_use]
    pub fn choice(&self) -> &Choice {
        &self.choice
    }
}

impl<G: LieGroup, A> Deref for AccurateStepper<G, A> {
    type Target = GroupStepper<G, A>;

    fn deref(&self) -> &GroupStepper<G, A> {
        &self.stepper
    }
}
