//! The results of a search: a plan, its residual, and a verdict.

use liestep::gradients::Plant;
use liestep::{SetupError, StepError};

/// A motion to the target, and its inputs.
#[derive(Clone, Debug)]
pub struct ControlPlan<M: Plant> {
    /// The stepper, with the step of the plan's duration.
    pub stepper: M,
    /// The states, one more than there are steps.
    pub states: Vec<M::State>,
    /// The input of each step.
    pub inputs: Vec<M::Input>,
    /// The time from the first state to the last, s.
    pub duration: f64,
    /// The cost of this plan.
    pub cost: f64,
    /// The multipliers of the target: minus the derivatives of the least cost by its attitude's displacements and its
    /// momentum.
    pub multipliers: Vec<f64>,
    /// The multipliers of the constraints: the derivatives of the least cost by their bounds, value by value of one
    /// state after another from the first step's end.
    pub prices: Vec<f64>,
    /// The residual of the conditions of an optimum.
    pub residual: Residual,
    /// The number of iterations.
    pub iterations: usize,
    /// The reason why the search stopped.
    pub verdict: Verdict,
}

/// The residual of the conditions of Karush, Kuhn and Tucker, each by its largest entry; the equations of the steps
/// hold to rounding in every iteration.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Residual {
    /// The derivatives of the Lagrange function by the inputs and a free duration, in cost per unit.
    pub stationarity: f64,
    /// The miss of the target: rad, or the coordinates of another group, and kg m²/s.
    pub target: f64,
    /// The residual of the constraints, in their units.
    pub kept: f64,
    /// The products of distances from bounds and their multipliers, in cost.
    pub complementarity: f64,
}

impl Residual {
    /// The largest of these residuals.
    #[must_use]
    pub fn largest(&self) -> f64 {
        self.stationarity.max(self.target).max(self.kept).max(self.complementarity)
    }
}

/// The reason why a search stopped.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Verdict {
    /// The residual is within the tolerance.
    Converged,
    /// To first order, all inputs within the bounds miss the target and the constraints by `gap` at least, along
    /// `direction`: a unit vector of the conditions at the end, in rad and kg m²/s, and of the constrained values, in
    /// the order of [`prices`](ControlPlan::prices). The plan is that with the least miss.
    #[allow(missing_docs)]
    Infeasible { direction: Vec<f64>, gap: f64 },
    /// The readings don't determine this direction of the start, of its momentum and of the constants, in the order of
    /// [`covariance`](crate::Fit::covariance): a unit vector along which the fit is that of the first guess.
    #[allow(missing_docs)]
    Unseen { direction: Vec<f64> },
    /// The number of iterations is exhausted.
    Exhausted,
    /// No step of the search is better, however short; the step of the motion that failed, by its number, if one did.
    Stalled(Option<(usize, StepError)>),
    /// The caller cancelled the search when its progress was reported.
    Cancelled,
}

/// An error in a task, found before the search.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ControlError {
    /// The steps have no derivatives.
    #[error("the steps have no derivatives: {0}")]
    Setup(#[from] SetupError),
    /// A part of the task is missing, out of order, out of range or not finite.
    #[error("the {0} can't be used: missing, out of order, out of range or not finite")]
    Unusable(&'static str),
    /// The constrained value of this number, from zero, isn't at least zero at the start.
    #[error("value {0} is to be at least zero, and is {1:e} at the start")]
    Outside(usize, f64),
    /// The step of this number, from zero, fails in the motion of the first guess.
    #[error("step {0} of the first guess can't be made: {1}")]
    Step(usize, StepError),
}
