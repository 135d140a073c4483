//! A run with observers: functions that are called every `n` steps or at requested times, and that may stop it.

use alloc::boxed::Box;
use alloc::rc::Rc;
use alloc::vec::Vec;
use core::cell::Cell;
use core::iter::Peekable;

use super::error::{Reason, RunError, RunReport};
use super::event::{Event, Watch, crossings, happen, look_first, next_length};
use super::observer::{Observer, show, stopped, unless_it_goes_on};
use crate::error::StepError;
use crate::groups::{Advected, LieGroup};
use crate::mechanics::Effect;
use crate::methods::CotangentGauss;
use crate::motion::{
    Answer, AnyState, AnyStepper, GroupState, GroupStepper, Integrator, Moment, Plan, StateOf, Stepper,
};
use crate::numbers::{real, reported};

roots!();

type Condition<'a, I> = Box<dyn FnMut(&Moment<'_, I>) -> Result<bool, RunError> + 'a>;

/// A run with observers, by [`Stepper::observed`]; generic code constructs it by [`Run::new`].
///
/// Observers are closures of a [`Moment`]. They return nothing, a [`ControlFlow`](core::ops::ControlFlow) that may stop
/// the run, or a `Result` whose error ends it:
///
/// ```
/// use liestep::effects::{Drag, RigidBody};
/// use liestep::recording::{Csv, Reason, Recorder};
/// use liestep::mechanics::Inertia;
/// use liestep::{SO3, Stepper};
/// use nalgebra::Vector3;
///
/// let J = Inertia::from_principal_moments(Vector3::new(1.0, 2.0, 2.5))?;
/// let damped = Stepper::new(RigidBody { J_d: J.to_nonstandard() } + Drag { c: 0.1, J }, 0.01)?;
/// let mut state = damped.start(SO3::identity(), Vector3::new(1.0, 2.0, 0.5))?;
///
/// let mut recorder = Recorder::new(&damped, Csv::new(Vec::new())); // or Csv::create("body.csv")?
/// let ended = damped
///     .observed(&mut state)
///     .every(100, |now| recorder.record(now))
///     .stop_when(|now| now.velocity().norm() < 0.1)
///     .until(1000.0)?;
/// let table = String::from_utf8(recorder.finish()?.into_inner()?)?;
///
/// assert!(matches!(ended.reason, Reason::Stopped { time } if time < 100.0));
/// assert!(damped.velocity(&state).norm() < 0.1);
/// assert!(table.starts_with("t,q_w,q_x,q_y,q_z,velocity_x,"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Contract
///
/// - The steps between two observed ones are made in place, without a copy; those of a splitting as by
///   [`Stepper::run`]. A run with a condition, with events or with requested times makes each step by itself. That
///   changes digits for splittings only, as documented at `run`.
/// - Observers change nothing: for other methods the steps are those of an unobserved run, bit for bit.
/// - Memory doesn't grow with the run.
/// - After an error, and when an observer stops the run, the state is that after the last step.
#[must_use = "a run is made by `until` or `steps`"]
pub struct Run<'a, I: Integrator> {
    integrator: &'a I,
    state: &'a mut I::State,
    observers: Observers<'a, I>,
    timed: Vec<TimedObserver<'a, I>>,
    watches: Vec<Watch<'a, I>>,
}

/// The observers of whole steps.
struct Observers<'a, I: Integrator> {
    regular: Vec<RegularObserver<'a, I>>,
    conditions: Vec<Condition<'a, I>>,
    progress: Option<Box<dyn FnMut(f64) + 'a>>,
    /// The steps at which the run begins and ends.
    start: u64,
    end: u64,
    /// The next step at which progress is reported.
    told: u64,
    /// The next step at which conditions, progress or the end of the run are checked.
    seldom: u64,
}

/// The relative rounding of a time that is a whole number of steps.
const ROUNDED: f64 = 4.0 * f64::EPSILON;

/// An observer of every `every`-th step.
struct RegularObserver<'a, I: Integrator> {
    every: u64,
    /// The next step to be observed.
    due: u64,
    observer: Observer<'a, I>,
}

/// An observer at requested times.
struct TimedObserver<'a, I: Integrator> {
    times: Peekable<Box<dyn Iterator<Item = f64> + 'a>>,
    /// The last observed time.
    shown: Option<f64>,
    observer: Observer<'a, I>,
}

/// # Wrap: a run with observers
impl<S: Effect, P: Plan<S>> Stepper<S, P> {
    /// A run from this state with observers; see [`Run`].
    pub fn observed<'a>(&'a self, state: &'a mut StateOf<S, P>) -> Run<'a, Self> {
        Run::new(self, state)
    }
}

impl<G: LieGroup<Scalar = f64>, A: Advected<G>> GroupStepper<G, A> {
    /// A run with observers, as by [`Stepper::observed`].
    pub fn observed<'a>(&'a self, state: &'a mut GroupState<G, A>) -> Run<'a, Self> {
        Run::new(self, state)
    }
}

impl AnyStepper {
    /// A run with observers, as by [`Stepper::observed`].
    pub fn observed<'a>(&'a self, state: &'a mut AnyState) -> Run<'a, Self> {
        Run::new(self, state)
    }
}

impl<L: crate::mechanics::ContinuousLagrangian, const PAIRS: usize, const N: usize> CotangentGauss<L, PAIRS, N>
where
    Self: Integrator,
{
    /// A run with observers, as by [`Stepper::observed`].
    pub fn observed<'a>(&'a self, state: &'a mut <Self as Integrator>::State) -> Run<'a, Self> {
        Run::new(self, state)
    }
}

impl<'a, I: Integrator> Run<'a, I> {
    /// A run of any integrator; one whose type is known has `observed`.
    pub fn new(integrator: &'a I, state: &'a mut I::State) -> Self {
        Self {
            integrator,
            state,
            observers: Observers {
                regular: Vec::new(),
                conditions: Vec::new(),
                progress: None,
                start: 0,
                end: 0,
                told: 0,
                seldom: 0,
            },
            timed: Vec::new(),
            watches: Vec::new(),
        }
    }

    /// Observes the motion after every `steps` steps, counted from its start, and at step zero. A run that continues
    /// another doesn't observe its first state again: it was the last of the run before.
    ///
    /// Zero means never.
    pub fn every<R: Answer>(mut self, steps: u64, mut observer: impl FnMut(&Moment<'_, I>) -> R + 'a) -> Self {
        if steps > 0 {
            let observer = Box::new(move |now: &Moment<'_, I>| unless_it_goes_on(observer(now)));
            self.observers.regular.push(RegularObserver { every: steps, due: 0, observer });
        }
        self
    }

    /// Stops the run at its start, or after the first step, if the condition holds. A run that continues from there
    /// makes no step while it holds.
    pub fn stop_when(mut self, mut condition: impl FnMut(&Moment<'_, I>) -> bool + 'a) -> Self {
        self.observers.conditions.push(Box::new(move |now| Ok(condition(now))));
        self
    }

    /// Ends the run by [`RunError::Energy`] after a step that has changed the energy by more than this bound, J, or to
    /// NaN.
    ///
    /// A step doesn't resolve a close encounter of two bodies within it: it has a solution, but continues another
    /// motion. Only the jump of the energy reveals that. Other changes of the energy in a step are of the order of its
    /// error, and of the work of forces.
    pub fn energy_within(mut self, bound: f64) -> Self {
        let mut last = None;
        self.observers.conditions.push(Box::new(move |now| {
            let after = reported(now.energy());
            let before = last.replace(after).unwrap_or(after);
            let is_within = (after - before).abs() <= bound;
            if is_within { Ok(false) } else { Err(RunError::Energy { time: reported(now.time()), before, after }) }
        }));
        self
    }

    /// Reports the share of the run that is made, from 0 to 1, at most a hundred times.
    pub fn progress(mut self, progress: impl FnMut(f64) + 'a) -> Self {
        self.observers.progress = Some(Box::new(progress));
        self
    }

    /// Makes `steps` steps, unless an observer stops the run.
    ///
    /// # Errors
    ///
    /// [`RunError`].
    pub fn steps(mut self, steps: u64) -> Result<RunReport, RunError> {
        let mut ended = RunReport { steps: 0, iterations: 0, reason: Reason::Done };
        let (integrator, start) = (self.integrator, I::steps(self.state));
        self.observers.begin(start, start.saturating_add(steps));
        look_first(&mut self.watches, &Moment::of_step(integrator, self.state))?;
        if self.show_timed(None, reported(integrator.time(self.state)), &mut ended)? {
            return Ok(ended);
        }
        let mut next = self.observers.show(&Moment::of_step(integrator, self.state), &mut ended)?;
        if next == 0 {
            return Ok(ended);
        }
        if self.timed.is_empty() && self.watches.is_empty() {
            let mut shown = Ok(());
            let made = integrator.run_stretches(self.state, next, &mut |motion, time| {
                let next = self.observers.show(&Moment::at(integrator, motion, time, None), &mut ended);
                next.unwrap_or_else(|error| {
                    shown = Err(error);
                    0
                })
            });
            shown?;
            ended.iterations = made.map_err(|cause| self.stuck(cause))?;
        } else {
            while next > 0 {
                let before = self.state.clone();
                ended.iterations +=
                    integrator.run_stretches(self.state, 1, &mut |_, _| 0).map_err(|cause| self.stuck(cause))?;
                next = if self.show_between(&before, &mut ended)? {
                    0
                } else {
                    self.observers.show(&Moment::of_step(integrator, self.state), &mut ended)?
                };
            }
        }
        ended.steps = I::steps(self.state) - start;
        if matches!(ended.reason, Reason::Done) {
            let (end, h) = (reported(integrator.time(self.state)), reported(integrator.step_size()));
            self.show_timed(None, end + end.abs() * ROUNDED * h.signum(), &mut ended)?;
        }
        Ok(ended)
    }

    #[cold]
    fn stuck(&self, cause: StepError) -> RunError {
        RunError::Step { time: reported(self.integrator.time(self.state)), cause }
    }

    /// Calls the observers within a step.
    fn show_between(&mut self, before: &I::State, ended: &mut RunReport) -> Result<bool, RunError> {
        for found in crossings(&mut self.watches, before, &Moment::of_step(self.integrator, self.state))? {
            if self.show_timed(Some(before), found.time, ended)?
                || happen(&mut self.watches, self.integrator, &found, ended)?
            {
                return Ok(true);
            }
        }
        self.show_timed(Some(before), reported(self.integrator.time(self.state)), ended)
    }

    /// Calls the observers at requested times from the state before up to this time.
    fn show_timed(&mut self, before: Option<&I::State>, up_to: f64, ended: &mut RunReport) -> Result<bool, RunError> {
        let time = self.integrator.time(self.state);
        let now = reported(time);
        let begun = before.map_or(now, |before| reported(self.integrator.time(before)));
        let h = reported(before.map_or(self.integrator.step_size(), |before| next_length(self.integrator, before)));
        let mut stops = false;
        for TimedObserver { times, shown, observer } in &mut self.timed {
            // The order of times is reversed if the step is negative.
            let is_after = |asked: f64, time: f64| (asked - time) * h.signum() > 0.0;
            while let Some(asked) = times.next_if(|asked| !is_after(*asked, up_to)) {
                let earliest = shown.replace(asked).unwrap_or(begun);
                if !asked.is_finite() || is_after(earliest, asked) || is_after(begun, asked) {
                    return Err(RunError::Time { asked, now: earliest });
                }
                let motion = match before.filter(|_| is_after(now, asked)) {
                    None => (**self.state).clone(),
                    Some(before) => {
                        let part = self.integrator.part(before, real((asked - begun) / h));
                        part.map_err(|cause| RunError::Step { time: asked, cause })?
                    }
                };
                stops |= show(observer, &Moment::at(self.integrator, &motion, real(asked), None), ended)?;
                if stops {
                    break;
                }
            }
        }
        Ok(stops)
    }
}

impl<I: Integrator> Observers<'_, I> {
    /// Initialises the counters of a run from one step to another.
    fn begin(&mut self, start: u64, end: u64) {
        (self.start, self.end, self.told, self.seldom) = (start, end, start, start);
        for RegularObserver { every, due, .. } in &mut self.regular {
            *due = if start == 0 { 0 } else { (start / *every).saturating_add(1).saturating_mul(*every) };
        }
    }

    /// Calls the observers of a step; returns the number of steps to the next observed one, and zero at the end of the
    /// run, by an observer or a condition too.
    #[hot]
    fn show(&mut self, now: &Moment<'_, I>, ended: &mut RunReport) -> Result<u64, RunError> {
        let (made, mut next, mut stops) = (now.steps(), self.seldom, false);
        for RegularObserver { every, due, observer } in &mut self.regular {
            if *due == made {
                *due = due.saturating_add(*every);
                // Repeats `show` inline: a call would make a row of every tenth step cost 23 instructions more.
                if let Some(verdict) = observer(now) {
                    stops |= stopped(verdict, reported(now.time()), ended)?;
                }
            }
            next = next.min(*due);
        }
        if stops {
            return Ok(0);
        }
        if made == self.seldom {
            return self.look_seldom(now, ended);
        }
        Ok(next - made)
    }

    /// Checks conditions, progress and the end; returns the same as [`show`](Self::show).
    #[cold]
    #[allow(clippy::cast_precision_loss)] // a share
    fn look_seldom(&mut self, now: &Moment<'_, I>, ended: &mut RunReport) -> Result<u64, RunError> {
        let made = now.steps();
        for condition in &mut self.conditions {
            if condition(now)? {
                ended.reason = Reason::Stopped { time: reported(now.time()) };
                return Ok(0);
            }
        }
        if let Some(progress) = &mut self.progress
            && made > self.start
            && (made == self.told || made == self.end)
        {
            progress((made - self.start) as f64 / (self.end - self.start) as f64);
        }
        if made == self.told {
            // At most a hundred reports.
            self.told = made.saturating_add((self.end - self.start).div_ceil(100).max(1));
        }
        self.seldom = if !self.conditions.is_empty() {
            self.end.min(made.saturating_add(1))
        } else if self.progress.is_some() {
            self.end.min(self.told)
        } else {
            self.end
        };
        Ok(self.regular.iter().fold(self.seldom, |next, regular| next.min(regular.due)) - made)
    }
}

impl<'a, I: Integrator> Run<'a, I>
where
    I::Scalar: Into<f64>,
{
    /// Observes the motion at these times, s, also between the steps: as [`Integrator::part`] of one. A time that is
    /// the end of a step, to the bit, has the state after that step; with equal steps so has one after the last step by no
    /// more than the rounding of the run's end.
    ///
    /// The times are in the order of the motion, and none lies before it; later ones than the end of the run are ignored.
    pub fn at<R: Answer>(
        mut self,
        times: impl IntoIterator<Item = f64, IntoIter: 'a>,
        mut observer: impl FnMut(&Moment<'_, I>) -> R + 'a,
    ) -> Self {
        let times: Box<dyn Iterator<Item = f64> + 'a> = Box::new(times.into_iter());
        let observer = Box::new(move |now: &Moment<'_, I>| unless_it_goes_on(observer(now)));
        self.timed.push(TimedObserver { times: times.peekable(), shown: None, observer });
        self
    }

    /// Finds the zeros of a function of the motion, and observes each at its time: events in one step in their order,
    /// whatever their functions.
    ///
    /// Between two steps the motion is [`Integrator::part`] of one, and a zero is located on it until its time has no
    /// further digit. The time is right to two of its roundings, or to the time in which the function changes by four
    /// of its own, whichever is longer. The observed moment has that time and the motion then, and [`Moment::rising`]
    /// the direction. The steps aren't changed. [`sections`](crate::recording::sections) has common functions.
    ///
    /// A function that is zero at the end of a step, to the bit, crosses zero there if its signs before and after
    /// differ; one that is zero at the start of the run doesn't cross then.
    ///
    /// # Examples
    ///
    /// A flipping body's momentum about its middle axis changes sign at these times:
    ///
    /// ```
    /// use liestep::effects::RigidBody;
    /// use liestep::recording::Event;
    /// use liestep::{NonstandardInertia, SO3, Stepper};
    /// use nalgebra::Vector3;
    ///
    /// let body = RigidBody { J_d: NonstandardInertia::from_principal_moments(Vector3::new(1.0, 2.0, 3.0))? };
    /// let stepper = Stepper::new(body, 0.01)?;
    /// let mut state = stepper.start(SO3::identity(), Vector3::new(0.01, 2.0, 0.02))?;
    /// let mut flips = Vec::new();
    /// stepper
    ///     .observed(&mut state)
    ///     .event(Event::crossing(), |now| now.momentum().y, |now| flips.push(now.time()))
    ///     .until(20.0)?;
    /// assert!(flips.len() == 2 && flips.is_sorted());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn event<Y: Into<f64>, R: Answer>(
        mut self,
        event: Event,
        mut function: impl FnMut(&Moment<'_, I>) -> Y + 'a,
        mut then: impl FnMut(&Moment<'_, I>) -> R + 'a,
    ) -> Self {
        let function = Box::new(move |now: &Moment<'_, I>| function(now).into());
        let then = Box::new(move |now: &Moment<'_, I>| unless_it_goes_on(then(now)));
        self.watches.push(Watch::new(event, function, then));
        self
    }

    /// Makes steps up to the first that ends at this time or after it, s, unless an observer stops the run; none if the
    /// motion is there already.
    ///
    /// A time that is a whole number of steps except for rounding is the end of the last of these. With steps of
    /// varying length their number isn't known beforehand, and progress is that of the time.
    ///
    /// # Errors
    ///
    /// [`RunError`].
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_precision_loss)] // checked
    pub fn until(mut self, time: f64) -> Result<RunReport, RunError> {
        /// Limit of the number of steps.
        const MOST: f64 = 9e15;
        let h: f64 = self.integrator.step_size().into();
        let steps = time / h;
        let can_be_counted = steps.abs() < MOST;
        if !can_be_counted {
            return Err(RunError::End { asked: time });
        }
        let rounded = 1.0 - ROUNDED;
        if self.integrator.length(self.state).is_some() {
            let is_there = Rc::new(Cell::new(false));
            let (seen, end) = (Rc::clone(&is_there), steps * rounded);
            let (begun, mut progress) =
                (reported(self.integrator.time(self.state)) / h, self.observers.progress.take());
            let mut told = 0.0;
            // The condition of the end comes after the user's, which are checked first.
            self.observers.conditions.push(Box::new(move |now| {
                let now = reported(now.time()) / h;
                seen.set(now >= end);
                let share = ((now - begun) / (steps - begun)).min(1.0);
                // At most a hundred reports.
                if let Some(progress) = &mut progress
                    && (now > begun && share >= told || seen.get())
                {
                    progress(if seen.get() { 1.0 } else { share });
                    told = (share * 100.0).floor() / 100.0 + 0.01;
                }
                Ok(seen.get())
            }));
            let mut ended = self.steps(u64::MAX)?;
            if is_there.get() {
                ended.reason = Reason::Done;
            }
            return Ok(ended);
        }
        let elapsed = reported(self.integrator.time(self.state)) / h - I::steps(self.state) as f64;
        let end = ((steps - elapsed) * rounded).ceil();
        let made = I::steps(self.state);
        self.steps(if end > 0.0 { (end as u64).saturating_sub(made) } else { 0 })
    }
}
