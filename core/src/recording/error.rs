//! How a run ends.

use alloc::boxed::Box;
use thiserror::Error;

use crate::error::StepError;

/// Why a run couldn't go on to its end.
///
/// The state is that of the last step that was made.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum RunError {
    /// There is no next step.
    #[error("the run stops at t = {time} s: {cause}")]
    Step {
        /// The time from which it would have been made, s.
        time: f64,
        /// Why.
        #[source]
        cause: StepError,
    },
    /// An observer has failed.
    #[error("the run stops at t = {time} s, as an observer failed: {cause}")]
    Observer {
        /// The time that it was shown, s.
        time: f64,
        /// Its error.
        #[source]
        cause: Box<dyn core::error::Error + Send + Sync>,
    },
    /// A step has changed the energy by more than the [bound](super::Run::energy_within); the state is that after it.
    #[error(
        "the run stops at t = {time} s: a step has taken the energy from {before:e} J to {after:e} J, so it is too long for what has happened within it; take smaller steps"
    )]
    Energy {
        /// The time after the step, s.
        time: f64,
        /// The energy before it, J.
        before: f64,
        /// The energy after it, J.
        after: f64,
    },
    /// A time to be shown lies before the state, or before the time that was to be shown before it, or isn't finite.
    #[error(
        "the time {asked} s can't be shown, as the motion is at t = {now} s already; give finite times in their order"
    )]
    Time {
        /// The time, s.
        asked: f64,
        /// The time of the state, s.
        now: f64,
    },
    /// The function of an event has no value.
    #[error("the function of event {event} has no value at t = {time} s")]
    NotANumber {
        /// Which event, counted from zero as they were given.
        event: usize,
        /// Where, s.
        time: f64,
    },
    /// Whether an event happens in a step can't be told with ten thousand looks: the bound of its second derivative is far
    /// too large, or the function is zero for a while.
    #[error(
        "event {event} can't be told apart in the step from t = {time} s: give a smaller bound of its second derivative, or a function that isn't zero for a while"
    )]
    TooManyLooks {
        /// Which event, counted from zero as they were given.
        event: usize,
        /// The beginning of the step, s.
        time: f64,
    },
    /// The end of the run isn't finite, or farther away than steps can be counted.
    #[error("a run can't end at t = {asked} s: give a finite time, and a step that isn't zero")]
    End {
        /// The time, s.
        asked: f64,
    },
}

/// What a run has done.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunReport {
    /// How many steps it made.
    pub steps: u64,
    /// Their iterations, as [`StepReport`](crate::motion::StepReport) counts them.
    pub iterations: u64,
    /// Why it ended.
    pub reason: Reason,
}

/// Why a run ended.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Reason {
    /// It came to its end.
    Done,
    /// An observer stopped it.
    Stopped {
        /// The time that the observer was shown, s.
        time: f64,
    },
    /// A [terminal](super::Event::terminal) event happened.
    Event {
        /// Which, counted from zero as they were given.
        event: usize,
        /// When, s.
        time: f64,
    },
}
