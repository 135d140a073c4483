//! Motion: the state of a body, the flow (2.8) of a scene, and the stepper that carries a state along it.

mod flows;
mod forced_step;
mod state;
mod stepper;

pub(crate) use flows::Stepped;
pub use flows::{DiscreteEulerPoincare, DiscreteLiePoisson, Increment, reconstruct};
pub(crate) use state::LOOKS;
pub use state::State;
pub use stepper::{StepReport, Stepper};

pub use crate::solving::Solvability;
