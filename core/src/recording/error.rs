//! Errors and reports of a run.

use alloc::boxed::Box;
use thiserror::Error;

use crate::error::StepError;

/// An error that ends a run.
///
/// The state is that of the last step that was made.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum RunError {
    /// A step failed.
    #[error("the run stops at t = {time} s: {cause}")]
    Step {
        /// The time at the beginning of the step, s.
        time: f64,
        /// The error of the step.
        #[source]
        cause: StepError,
    },
    /// An observer has failed.
    #[error("the run stops at t = {time} s, as an observer failed: {cause}")]
    Observer {
        /// The time of the moment, s.
        time: f64,
        /// The error of the observer.
        #[source]
        cause: Box<dyn core::error::Error + Send + Sync>,
    },
    /// A step has changed the energy by more than the [bound](super::Run::energy_within); the state is that after the
    /// step.
    #[error(
        "the run stops at t = {time} s: a step has taken the energy from {before:e} J to {after:e} J, so it is too long for what has happened within it; take smaller steps"
    )]
    Energy {
        /// The time after the step, s.
        time: f64,
        /// The energy before the step, J.
        before: f64,
        /// The energy after the step, J.
        after: f64,
    },
    /// A requested time lies before the state, or before the time requested before it, or isn't finite.
    #[error(
        "the time {asked} s can't be shown, as the motion is at t = {now} s already; give finite times in their order"
    )]
    Time {
        /// The requested time, s.
        asked: f64,
        /// The time of the state, s.
        now: f64,
    },
    /// The function of an event has no value.
    #[error("the function of event {event} has no value at t = {time} s")]
    NotANumber {
        /// Number of the event, from zero in the order of their calls.
        event: usize,
        /// The time of the evaluation, s.
        time: f64,
    },
    /// Ten thousand evaluations don't separate the crossings of an event in a step: the bound of its second derivative
    /// is far too large, or the function is zero for a while.
    #[error(
        "event {event} can't be told apart in the step from t = {time} s: give a smaller bound of its second derivative, or a function that isn't zero for a while"
    )]
    TooManyLooks {
        /// Number of the event, from zero in the order of their calls.
        event: usize,
        /// The beginning of the step, s.
        time: f64,
    },
    /// The end of the run isn't finite, or farther away than steps can be counted.
    #[error("a run can't end at t = {asked} s: give a finite time, and a step that isn't zero")]
    End {
        /// The requested end, s.
        asked: f64,
    },
}

/// The report of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunReport {
    /// Number of steps made.
    pub steps: u64,
    /// Number of iterations in the steps, as counted by [`StepReport`](crate::motion::StepReport).
    pub iterations: u64,
    /// The reason of the end.
    pub reason: Reason,
}

/// The reason of a run's end.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Reason {
    /// The run reached its end.
    Done,
    /// An observer stopped the run.
    Stopped {
        /// The time of the observed moment, s.
        time: f64,
    },
    /// A [terminal](super::Event::terminal) event happened.
    Event {
        /// Number of the event, from zero in the order of their calls.
        event: usize,
        /// The time of the event, s.
        time: f64,
    },
}
