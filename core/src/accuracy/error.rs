//! Why no step was chosen.

use alloc::string::String;
use thiserror::Error;

use super::question::Trials;
use crate::error::{SetupError, StepError};

/// Why there is no method and step for an accuracy.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum AccuracyError {
    /// The tolerance isn't a number above zero, or so large that it would be another motion.
    #[error("the tolerance {tolerance:e} can't be used; choose one above 0 and up to 0.05")]
    Tolerance {
        /// What was asked for.
        tolerance: f64,
    },
    /// The horizon isn't a finite time above zero.
    #[error("the horizon {horizon:e} s can't be used; choose a finite time above zero")]
    Horizon {
        /// What was asked for, s.
        horizon: f64,
    },
    /// No method comes so near to the motion in double precision: rounding, as much as the motion magnifies it until
    /// the horizon, is larger.
    #[error(
        "the tolerance {tolerance:e} is below what rounding leaves at the horizon: about {floor:.0e} can be reached; choose a larger one or a nearer horizon"
    )]
    Unreachable {
        /// What was asked for.
        tolerance: f64,
        /// About the smallest tolerance that can be reached; of the order of one where the motion can't be predicted so
        /// far.
        floor: f64,
        /// What was tried.
        trials: Trials,
    },
    /// The steps that all methods would need are too many to be tried.
    #[error(
        "{} {steps:.0e} steps of the method `{method}` would be needed, which {} trials of up to {:.0e} steps show; choose a larger tolerance or a nearer horizon",
        if *.is_bound { "at least" } else { "about" }, .trials.runs, .trials.most_steps
    )]
    TooManySteps {
        /// About how many the one that looks cheapest would make.
        steps: f64,
        /// Whether `steps` is a lower bound: even steps as short haven't shown the motion.
        is_bound: bool,
        /// What it is called.
        method: String,
        /// What was tried.
        trials: Trials,
    },
    /// The scene or the start can't be used, or a step short enough can't.
    #[error("{0}")]
    Setup(#[from] SetupError),
    /// A method doesn't get to the horizon, with however short a step, and no other does for the accuracy.
    #[error("no step leads to the horizon: {0}")]
    Step(#[source] StepError),
}
