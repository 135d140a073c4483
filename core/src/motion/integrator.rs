//! What carries a state along, whichever scene and method it has.

use crate::error::StepError;
use crate::groups::LieGroup;
use crate::mechanics::Effect;
use crate::motion::any::{AnyState, AnyStepper};
use crate::motion::plan::Plan;
use crate::motion::report::StepReport;
use crate::motion::stepper::{StateOf, Stepper};

/// A [`Stepper`] of any scene and method, or an [`AnyStepper`]: for programs that are the same for all of them.
pub trait Integrator {
    /// What is moved.
    type State: Clone;

    /// How many steps it has made.
    fn steps(state: &Self::State) -> u64;

    /// As [`Stepper::step`].
    ///
    /// # Errors
    ///
    /// As [`Stepper::step`].
    fn step(&self, state: &mut Self::State) -> Result<StepReport, StepError>;

    /// As [`Stepper::run`].
    ///
    /// # Errors
    ///
    /// As [`Stepper::run`].
    fn run(&self, state: &mut Self::State, steps: u64) -> Result<u64, StepError>;

    /// As [`run`](Self::run), but says only whether it could be done; where not, the state may be anywhere.
    #[must_use]
    fn attempt(&self, state: &mut Self::State, steps: u64) -> bool {
        self.run(state, steps).is_ok()
    }
}

impl<S: Effect, P: Plan<S>> Integrator for Stepper<S, P> {
    type State = StateOf<S, P>;

    fn steps(state: &Self::State) -> u64 {
        state.motion.steps
    }

    fn step(&self, state: &mut Self::State) -> Result<StepReport, StepError> {
        self.step(state)
    }

    fn run(&self, state: &mut Self::State, steps: u64) -> Result<u64, StepError> {
        self.run(state, steps)
    }

    fn attempt(&self, state: &mut Self::State, steps: u64) -> bool {
        self.run_unexplained(state, steps).is_ok()
    }
}

impl<G: LieGroup, A: Copy> Integrator for AnyStepper<G, A> {
    type State = AnyState<G, A>;

    fn steps(state: &Self::State) -> u64 {
        state.motion.steps
    }

    fn step(&self, state: &mut Self::State) -> Result<StepReport, StepError> {
        self.step(state)
    }

    fn run(&self, state: &mut Self::State, steps: u64) -> Result<u64, StepError> {
        self.run(state, steps)
    }
}
