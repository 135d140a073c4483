//! Events: zeros of a function of the motion, in the order in which they are crossed.

use alloc::boxed::Box;
use alloc::vec::Vec;

use super::crossing::{Looks, side, zeros};
use super::error::{Reason, RunError, RunReport};
use super::observer::{Observer, show};
use crate::motion::{Integrator, Moment};
use crate::numbers::{real, reported};

/// The kind of an event: the direction in which a function of the motion crosses zero, whether that ends the run, and a
/// bound for the search between steps. [`Run::event`](super::Run::event) takes it.
///
/// # Guarantees
///
/// A function with different signs at the beginning and the end of a step has a zero between, which is found. Of three
/// zeros in one step one is found, and of two none, unless a bound is known: with [`curvature`](Self::curvature) every
/// crossing is found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    rising: bool,
    falling: bool,
    terminal: bool,
    curvature: Option<f64>,
    period: Option<f64>,
}

impl Event {
    /// An event at which the function rises through zero.
    #[must_use]
    pub const fn rising() -> Self {
        Self { rising: true, falling: false, terminal: false, curvature: None, period: None }
    }

    /// An event at which the function falls through zero.
    #[must_use]
    pub const fn falling() -> Self {
        Self { rising: false, falling: true, terminal: false, curvature: None, period: None }
    }

    /// An event at which the function crosses zero either way.
    #[must_use]
    pub const fn crossing() -> Self {
        Self { rising: true, falling: true, terminal: false, curvature: None, period: None }
    }

    /// Ends the run in the step with the first such event; nothing later in that step is observed.
    #[must_use]
    pub const fn terminal(self) -> Self {
        Self { terminal: true, ..self }
    }

    /// Sets a bound of the function's second derivative in time, `|g̈| ≤ bound`, for the whole run: no crossing is
    /// missed then, except pairs that are nearer to each other than `2⁻²⁴` of a step.
    ///
    /// An interval in which the chord is steeper than the bound times its length has one zero or none, by the signs at
    /// its ends; one in which the parabola of that curvature under the chord stays above zero has none; any other
    /// interval is halved. So a step far from zero needs no evaluation between its ends, and the nearer the function
    /// comes to touching zero the more it needs. The bound is that of the motion between two steps, which differs from
    /// the exact one's by the method's error: add a margin for that. A bound that is too large takes more evaluations,
    /// and no more than 10,000 a step, after which the run is an error.
    #[must_use]
    pub const fn curvature(self, bound: f64) -> Self {
        Self { curvature: Some(bound), ..self }
    }

    /// Sets the period of a function whose values go around between minus and plus half of it, as those of an angle do,
    /// 2π for rad: where they jump from one end to the other, that isn't a crossing.
    ///
    /// A step in which the function changes by less than half a period has one crossing at most, which is found; in a
    /// longer step [`curvature`](Self::curvature) finds it.
    #[must_use]
    pub const fn period(self, period: f64) -> Self {
        Self { period: Some(period), ..self }
    }

    /// Whether the event ends the run.
    #[must_use]
    pub const fn is_terminal(&self) -> bool {
        self.terminal
    }

    /// The bound of the second derivative, if there is one.
    #[must_use]
    pub const fn bound(&self) -> Option<f64> {
        self.curvature
    }
}

pub(super) type Function<'a, I> = Box<dyn FnMut(&Moment<'_, I>) -> f64 + 'a>;

/// An event with its function and its observer.
pub(super) struct Watch<'a, I: Integrator> {
    event: Event,
    function: Function<'a, I>,
    then: Observer<'a, I>,
    /// The function at the end of the last step.
    value: f64,
    /// Whether the function was above zero when it last wasn't zero.
    above: Option<bool>,
}

/// A located zero.
pub(super) struct Crossing<I: Integrator> {
    /// Number of the event.
    event: usize,
    fraction: f64,
    pub(super) time: f64,
    rising: bool,
    motion: I::Motion,
}

impl<'a, I: Integrator> Watch<'a, I> {
    pub(super) fn new(event: Event, function: Function<'a, I>, then: Observer<'a, I>) -> Self {
        Self { event, function, then, value: 0.0, above: None }
    }

    /// The function's value, or an error for NaN.
    fn look(&mut self, now: &Moment<'_, I>, event: usize) -> Result<f64, RunError> {
        let value = (self.function)(now);
        if value.is_nan() { Err(RunError::NotANumber { event, time: reported(now.time()) }) } else { Ok(value) }
    }
}

/// Evaluates the functions at the start of the run.
pub(super) fn look_first<I: Integrator>(watches: &mut [Watch<'_, I>], now: &Moment<'_, I>) -> Result<(), RunError> {
    for (event, watched) in watches.iter_mut().enumerate() {
        watched.value = watched.look(now, event)?;
        watched.above = side(watched.value);
    }
    Ok(())
}

/// The length of the step from this state.
pub(super) fn next_length<I: Integrator>(integrator: &I, state: &I::State) -> I::Scalar {
    integrator.length(state).unwrap_or_else(|| integrator.step_size())
}

/// All zeros in the step from this state, in their order.
pub(super) fn crossings<I: Integrator>(
    watches: &mut [Watch<'_, I>],
    before: &I::State,
    now: &Moment<'_, I>,
) -> Result<Vec<Crossing<I>>, RunError> {
    let integrator = now.integrator();
    let (begun, h) = (reported(integrator.time(before)), reported(next_length(integrator, before)));
    let mut found = Vec::new();
    for (event, watched) in watches.iter_mut().enumerate() {
        let next = watched.look(now, event)?;
        let (value, above) = (core::mem::replace(&mut watched.value, next), watched.above);
        watched.above = side(next).or(above);
        let (period, bound) = (watched.event.period, watched.event.curvature.map(|bound| bound.abs() * h * h));
        // Most steps have no crossing.
        if bound.is_none() && (above.is_none() || watched.above == above) {
            continue;
        }
        let time = |fraction: f64| begun + fraction * h;
        let mut look = |fraction: f64| {
            let motion = integrator.part(before, real(fraction));
            let motion = motion.map_err(|cause| RunError::Step { time: time(fraction), cause })?;
            watched.look(&Moment::at(integrator, &motion, real(time(fraction)), None), event)
        };
        let rounding = 0.25 * f64::EPSILON * ((begun / h).abs() + 1.0);
        let looks = Looks { ends: [value, next], above, bound, period, rounding };
        let Some(zeros) = zeros(looks, &mut look)? else {
            return Err(RunError::TooManyLooks { event, time: begun });
        };
        let wanted = watched.event;
        for (fraction, rising) in zeros.into_iter().filter(|&(_, up)| if up { wanted.rising } else { wanted.falling }) {
            let motion = integrator.part(before, real(fraction));
            let motion = motion.map_err(|cause| RunError::Step { time: time(fraction), cause })?;
            found.push(Crossing { event, fraction, time: time(fraction), rising, motion });
        }
    }
    found.sort_by(|a, b| a.fraction.total_cmp(&b.fraction));
    Ok(found)
}

/// Calls the observer of an event; returns whether the run ends.
pub(super) fn happen<I: Integrator>(
    watches: &mut [Watch<'_, I>],
    integrator: &I,
    found: &Crossing<I>,
    ended: &mut RunReport,
) -> Result<bool, RunError> {
    let &Crossing { event, time, rising, ref motion, .. } = found;
    let Some(watched) = watches.get_mut(event) else { return Ok(false) };
    let moment = Moment::at(integrator, motion, real(time), Some(rising));
    let mut stops = show(&mut watched.then, &moment, ended)?;
    if watched.event.terminal {
        ended.reason = Reason::Event { event, time };
        stops = true;
    }
    Ok(stops)
}
