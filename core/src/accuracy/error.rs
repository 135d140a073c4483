//! Errors of a choice by accuracy.

use alloc::string::String;
use thiserror::Error;

use super::question::Trials;
use crate::error::{SetupError, StepError};

/// An error of the search for a method and step.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum AccuracyError {
    /// The tolerance isn't a number above zero, or it is so large that the run would be another motion.
    #[error("the tolerance {tolerance:e} can't be used; choose one above 0 and up to 0.05")]
    Tolerance {
        /// The requested tolerance.
        tolerance: f64,
    },
    /// The horizon isn't a finite time above zero.
    #[error("the horizon {horizon:e} s can't be used; choose a finite time above zero")]
    Horizon {
        /// The requested horizon, s.
        horizon: f64,
    },
    /// No method reaches the tolerance in double precision: rounding, magnified by the motion until the horizon, is
    /// larger.
    #[error(
        "the tolerance {tolerance:e} is below what rounding leaves at the horizon: about {floor:.0e} can be reached; choose a larger one or a nearer horizon"
    )]
    Unreachable {
        /// The requested tolerance.
        tolerance: f64,
        /// Approximate smallest tolerance that can be reached; of the order of one if the motion can't be predicted so
        /// far.
        floor: f64,
        /// The trial runs made.
        trials: Trials,
    },
    /// All methods would need too many steps for a trial.
    #[error(
        "{} {steps:.0e} steps of the method `{method}` would be needed, which {} trials of up to {:.0e} steps show; choose a larger tolerance or a nearer horizon",
        if *.is_bound { "at least" } else { "about" }, .trials.runs, .trials.most_steps
    )]
    TooManySteps {
        /// Approximate number of steps of the method that seems cheapest.
        steps: f64,
        /// Whether `steps` is a lower bound: the error is too large to be measured even with such steps.
        is_bound: bool,
        /// Name of the method.
        method: String,
        /// The trial runs made.
        trials: Trials,
    },
    /// The scene, the start or a short enough step is invalid.
    #[error("{0}")]
    Setup(#[from] SetupError),
    /// A method fails before the horizon with any step, and no other reaches the accuracy.
    #[error("no step leads to the horizon: {0}")]
    Step(#[source] StepError),
}
