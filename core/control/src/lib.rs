//! Optimal control and estimation of motions that [liestep] steps, on the discrete equations themselves.
//!
//! A [`Control`] states start, target, inputs, bounds and cost; its [`ControlPlan`] is a motion of the stepper, with
//! the inputs of its steps and the [`Verdict`] of the search. An [`Estimate`] has readings of a motion in the place of
//! a target; its [`Fit`] is the motion that suits them best.

mod control;
mod estimate;
mod improve;
mod model;
mod riccati;
mod search;
mod verdict;

pub use control::{Control, Cost, Target};
pub use estimate::{Estimate, Fit};
pub use verdict::{ControlError, ControlPlan, Residual, Verdict};
