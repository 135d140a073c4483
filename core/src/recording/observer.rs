//! What an observer is, and what it answers.

use alloc::boxed::Box;
use core::ops::ControlFlow;

use super::error::{Reason, RunError, RunReport};
use crate::motion::{Answer, Integrator, Moment};
use crate::numbers::reported;

/// What an observer answers.
pub(super) type Verdict = Result<ControlFlow<()>, Box<dyn core::error::Error + Send + Sync>>;
/// `None` means go on: it comes back in a register, and a whole answer in memory.
pub(super) type Observer<'a, I> = Box<dyn FnMut(&Moment<'_, I>) -> Option<Box<Verdict>> + 'a>;

/// An answer, but for that to go on.
#[hot]
pub(super) fn unless_it_goes_on(answer: impl Answer) -> Option<Box<Verdict>> {
    match answer.verdict() {
        Ok(ControlFlow::Continue(())) => None,
        verdict => Some(Box::new(verdict)),
    }
}

/// Shows a moment; returns whether the observer stops the run.
pub(super) fn show<I: Integrator>(
    observer: &mut Observer<'_, I>,
    now: &Moment<'_, I>,
    ended: &mut RunReport,
) -> Result<bool, RunError> {
    observer(now).map_or(Ok(false), |verdict| stopped(verdict, reported(now.time()), ended))
}

#[cold]
#[inline(never)]
#[allow(clippy::boxed_local)] // so that its memory is freed here, too
pub(super) fn stopped(verdict: Box<Verdict>, time: f64, ended: &mut RunReport) -> Result<bool, RunError> {
    let _ = verdict.map_err(|cause| RunError::Observer { time, cause })?;
    ended.reason = Reason::Stopped { time };
    Ok(true)
}
