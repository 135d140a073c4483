//! Events: zeros of a function of the motion, in the order in which they are crossed.

use alloc::boxed::Box;
use alloc::vec::Vec;

use super::crossing::{Looks, side, zeros};
use super::error::{Reason, RunError, RunReport};
use super::observer::{Observer, show};
use crate::motion::{Integrator, Moment, Motion, ScalarIn};
use crate::numbers::{real, reported};

/// What counts as an event: in which direction a function of the motion crosses zero, whether that ends the run, and how
/// closely it is looked for between the steps. [`Run::event`](super::Run::event) takes it.
///
/// # What isn't missed
///
/// A function that has one sign at the beginning of a step and the other at its end has a zero between, which is found.
/// Of three zeros in one step one is found, and of two none, unless a bound is known: with
/// [`curvature`](Self::curvature) every crossing is found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    rising: bool,
    falling: bool,
    terminal: bool,
    curvature: Option<f64>,
}

impl Event {
    /// The function goes from below zero to above.
    #[must_use]
    pub const fn rising() -> Self {
        Self { rising: true, falling: false, terminal: false, curvature: None }
    }

    /// The function goes from above zero to below.
    #[must_use]
    pub const fn falling() -> Self {
        Self { rising: false, falling: true, terminal: false, curvature: None }
    }

    /// Either.
    #[must_use]
    pub const fn crossing() -> Self {
        Self { rising: true, falling: true, terminal: false, curvature: None }
    }

    /// The run ends with the step in which this happens for the first time, and nothing later in that step is shown.
    #[must_use]
    pub const fn terminal(self) -> Self {
        Self { terminal: true, ..self }
    }

    /// A bound of the function's second derivative in time, `|g̈| ≤ bound`, all along the run: no crossing is missed then,
    /// save pairs that are nearer to each other than `2⁻²⁴` of a step.
    ///
    /// An interval in which the chord is steeper than the bound times its length has one zero or none, by the signs at its
    /// ends; one in which the parabola of that curvature under the chord stays above zero has none; what is neither is
    /// halved. So a step far from zero takes no look between its ends, and the nearer the function comes to touching zero
    /// the more it takes. The bound is that of the motion between two steps, which differs from the exact one's by the
    /// method's error: leave a margin for that. A bound that is too large takes more looks, and no more than
    /// 10,000 a step, after which the run is an error.
    #[must_use]
    pub const fn curvature(self, bound: f64) -> Self {
        Self { curvature: Some(bound), ..self }
    }

    /// Whether the run ends with it.
    #[must_use]
    pub const fn is_terminal(&self) -> bool {
        self.terminal
    }

    /// The bound of the second derivative, if one is known.
    #[must_use]
    pub const fn bound(&self) -> Option<f64> {
        self.curvature
    }
}

pub(super) type Function<'a, I> = Box<dyn FnMut(&Moment<'_, I>) -> f64 + 'a>;

/// An event, and what is done when it happens.
pub(super) struct Watch<'a, I: Integrator> {
    event: Event,
    function: Function<'a, I>,
    then: Observer<'a, I>,
    /// At the end of the last step.
    value: f64,
    /// Whether the function was above zero when last it wasn't zero.
    above: Option<bool>,
}

/// A zero that was found.
pub(super) struct Crossing<I: Integrator> {
    /// Which event.
    event: usize,
    fraction: f64,
    pub(super) time: f64,
    rising: bool,
    motion: Motion<I::Group, I::Advected>,
}

impl<'a, I: Integrator> Watch<'a, I> {
    pub(super) fn new(event: Event, function: Function<'a, I>, then: Observer<'a, I>) -> Self {
        Self { event, function, then, value: 0.0, above: None }
    }

    /// The function, if it has a value.
    fn look(&mut self, now: &Moment<'_, I>, event: usize) -> Result<f64, RunError> {
        let value = (self.function)(now);
        if value.is_nan() { Err(RunError::NotANumber { event, time: reported(now.time()) }) } else { Ok(value) }
    }
}

/// The functions at the start of the run.
pub(super) fn look_first<I: Integrator>(watches: &mut [Watch<'_, I>], now: &Moment<'_, I>) -> Result<(), RunError> {
    for (event, watched) in watches.iter_mut().enumerate() {
        watched.value = watched.look(now, event)?;
        watched.above = side(watched.value);
    }
    Ok(())
}

/// The length of the step from this state.
pub(super) fn next_length<I: Integrator>(integrator: &I, state: &I::State) -> ScalarIn<I> {
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
        let bound = watched.event.curvature.map(|bound| bound.abs() * h * h);
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
        let looks = Looks { ends: [value, next], above, bound, rounding };
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

/// Shows an event; returns whether the run ends.
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
