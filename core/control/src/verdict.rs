//! What comes out: a plan, how good it is, and why the search stopped.

use liestep::gradients::InputOf;
use liestep::mechanics::SecondDerivatives;
use liestep::motion::{Plan, StateOf, Stepper};
use liestep::{SetupError, StepError};

/// A motion to the target, and the inputs that make it.
#[derive(Clone, Debug)]
pub struct ControlPlan<S: SecondDerivatives, P: Plan<S>> {
    /// The stepper, with the step of the plan's duration.
    pub stepper: Stepper<S, P>,
    /// The states, one more than there are steps.
    pub states: Vec<StateOf<S, P>>,
    /// What each step is given.
    pub inputs: Vec<InputOf<S>>,
    /// The time from the first state to the last, s.
    pub duration: f64,
    /// What is minimised.
    pub cost: f64,
    /// Minus the derivatives of the least cost by the target: along displacements of its attitude, and by its momentum.
    pub multipliers: Vec<f64>,
    /// The derivatives of the least cost by the bounds of what is kept, value by value of one state after another from the
    /// first step's end.
    pub prices: Vec<f64>,
    /// How far from the conditions of an optimum it is.
    pub residual: Residual,
    /// How many iterations there were.
    pub iterations: usize,
    /// Why the search stopped.
    pub verdict: Verdict,
}

/// How far a plan is from the conditions of Karush, Kuhn and Tucker, each by its largest entry; the equations of the steps
/// hold to rounding in every iteration.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Residual {
    /// The derivatives of the Lagrange function by the inputs and a free duration, in cost per unit.
    pub stationarity: f64,
    /// What is left to the target: rad, or the coordinates of another group, and kg m²/s.
    pub target: f64,
    /// What is left to the bounds of what is kept, in its units.
    pub kept: f64,
    /// The products of distances from bounds and their multipliers, in cost.
    pub complementarity: f64,
}

impl Residual {
    /// The largest of them.
    #[must_use]
    pub fn largest(&self) -> f64 {
        self.stationarity.max(self.target).max(self.kept).max(self.complementarity)
    }
}

/// Why a search stopped.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Verdict {
    /// The residual is within the tolerance.
    Converged,
    /// To first order, all inputs within the bounds miss the target and what is to be kept by `gap` at least, along
    /// `direction`: a unit vector of the conditions at the end, in rad and kg m²/s, and of the values that are kept, in the
    /// order of [`prices`](ControlPlan::prices). The plan is that with the least miss.
    #[allow(missing_docs)]
    Infeasible { direction: Vec<f64>, gap: f64 },
    /// The readings don't show this direction of the start, of its momentum and of what is constant, in the order of
    /// [`covariance`](crate::Fit::covariance): a unit vector along which the fit is where it was begun.
    #[allow(missing_docs)]
    Unseen { direction: Vec<f64> },
    /// The number of iterations is exhausted.
    Exhausted,
    /// No step of the search is better, however short; a step of the motion that was in the way, by its number.
    Stalled(Option<(usize, StepError)>),
    /// The caller stopped it, when it was shown the progress.
    Cancelled,
}

/// A task that can't be begun.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ControlError {
    /// The derivatives of the steps aren't known.
    #[error("the steps have no derivatives: {0}")]
    Setup(#[from] SetupError),
    /// A part of the task is missing, out of order, out of range or not finite.
    #[error("the {0} can't be used: missing, out of order, out of range or not finite")]
    Unusable(&'static str),
    /// The value of this number, from zero, is to be kept, and isn't at the start.
    #[error("value {0} is to be at least zero, and is {1:e} at the start")]
    Outside(usize, f64),
    /// The step of this number, from zero, can't be made in the motion of the first guess.
    #[error("step {0} of the first guess can't be made: {1}")]
    Step(usize, StepError),
}
