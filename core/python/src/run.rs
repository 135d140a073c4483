//! A run that is recorded into columns, with its events, and stopped when Python requests it.

use std::cell::{Cell, RefCell};
use std::f64::consts::PI;
use std::rc::Rc;
use std::time::{Duration, Instant};

use liestep::motion::{AnyMotion, AnyState, AnyStepper, Factor, FactorKind, Integrator, Moment};
use liestep::recording::{Event, Reason, RecordError, Recorder, Run, RunError, Sink};
use pyo3::prelude::*;

use crate::failure::Failure;
use crate::table::Columns;

/// An event: a quantity, or a function of Python, passes a value.
#[derive(FromPyObject)]
pub(crate) struct Watch {
    quantity: String,
    /// The function of the time, of the attitude with the rows of its matrices, of velocity, momentum and energy.
    function: Option<Py<PyAny>>,
    value: f64,
    /// The direction of the event: 1 where the quantity rises, −1 where it falls, 0 for both.
    direction: i8,
    stops: bool,
}

/// The length of a run, and what it records.
#[derive(FromPyObject)]
pub(crate) struct Course {
    pub(crate) until: f64,
    /// Steps from row to row; zero if `times` are given.
    pub(crate) every: u64,
    pub(crate) times: Option<Vec<f64>>,
    pub(crate) events: Vec<Watch>,
}

/// The results of a run.
pub(crate) struct RunRecord {
    pub(crate) columns: Columns,
    /// One table for each event, with a row for each occurrence.
    pub(crate) events: Vec<(Columns, Vec<bool>)>,
    pub(crate) steps: u64,
    pub(crate) iterations: u64,
    pub(crate) ending: Option<usize>,
    /// The failure that ended the run early; the rows up to then are in the table.
    pub(crate) failure: Option<Failure>,
}

/// A look for Ctrl-C in Python, at most some fifty times a second.
pub(crate) struct Signals {
    asked: Cell<Instant>,
    raised: RefCell<Option<PyErr>>,
}

impl Signals {
    pub(crate) fn new() -> Self {
        Self { asked: Cell::new(Instant::now()), raised: RefCell::new(None) }
    }

    /// The error of an interrupted run, if Python has a signal.
    pub(crate) fn look(&self) -> Result<(), &'static str> {
        if self.asked.get().elapsed() < Duration::from_millis(20) {
            return Ok(());
        }
        self.asked.set(Instant::now());
        #[allow(clippy::redundant_closure_for_method_calls)] // the method is of one lifetime
        let Err(error) = Python::attach(|py| py.check_signals()) else { return Ok(()) };
        self.raised.replace(Some(error));
        Err("Python asked for it")
    }

    /// Keeps an exception that ends the run.
    fn raise(&self, error: PyErr) {
        self.raised.replace(Some(error));
    }

    pub(crate) fn into_failure(self) -> Option<Failure> {
        self.raised.into_inner().map(Failure::Raised)
    }
}

/// The most steps between two looks for signals.
const LOOK: u64 = 4096;

/// Relative distance of a time from a whole number of steps up to which both are equal, as in a scene's file.
const ROUNDING: f64 = 1e-9;

/// The number of steps up to a time, approximate if steps have different lengths.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // checked
pub(crate) fn steps_to(time: f64, h: f64, are_equal: bool) -> Result<u64, Failure> {
    let steps = time / h;
    let can_be_counted = steps.abs() < 9e15;
    if !can_be_counted {
        return Err(Failure::setup(&RunError::End { asked: time }));
    }
    let refused = |message: String| Err(Failure::Of("SetupError", message));
    if steps < 0.0 {
        return refused(format!("steps of {h} s lead away from {time} s: take steps of {} s", -h));
    }
    let whole = steps.round();
    if are_equal && (steps - whole).abs() > ROUNDING * steps {
        let [before, behind] = [steps.floor(), steps.ceil()].map(|steps| short(steps * h));
        return refused(format!("{time} s isn't a whole number of steps of {h} s: take {before} or {behind} s"));
    }
    Ok(if are_equal { whole } else { steps.ceil() } as u64)
}

/// The number without the rounding errors of its last digits.
fn short(number: f64) -> f64 {
    format!("{number:.11e}").parse().unwrap_or(number)
}

/// A recorder of all columns that [`Recorder`] has, and beside SO(3), where Python computes it, of the momentum in space.
fn recorder_of<S: Sink>(stepper: &AnyStepper, sink: S) -> Recorder<'_, AnyStepper, S> {
    let (recorder, factors) = (Recorder::new(stepper, sink), &stepper.layout().factors);
    if matches!(&factors[..], [Factor { kind: FactorKind::Rotation, .. }]) {
        return recorder;
    }
    // The first of a row's components computes all.
    let row: Rc<RefCell<Vec<f64>>> = Rc::default();
    let components = factors.iter().flat_map(|factor| &factor.components).enumerate();
    components.fold(recorder, |recorder, (place, (name, _))| {
        let row = Rc::clone(&row);
        recorder.quantity(format!("spatial_momentum_{name}"), "", move |now| {
            if place == 0 {
                row.replace(stepper.spatial_momentum(now));
            }
            row.borrow().get(place).copied().unwrap_or(f64::NAN)
        })
    })
}

/// Makes the steps, and rows of all columns that [`Recorder`] has.
pub(crate) fn record(stepper: &AnyStepper, mut state: AnyState, course: &Course) -> Result<RunRecord, Failure> {
    let is_varied = stepper.length(&state).is_some();
    let steps = steps_to(course.until, stepper.step_size(), !is_varied)?.saturating_sub(state.steps());
    let rows = match &course.times {
        Some(times) => times.len(),
        None => usize::try_from(steps / course.every.max(1)).unwrap_or(usize::MAX).saturating_add(2),
    };
    let (signals, mut columns) = (Signals::new(), Columns::new(rows));
    let recorder = RefCell::new(recorder_of(stepper, &mut columns));
    let last = Cell::new(f64::NAN);
    let row = |now: &Moment<'_, AnyStepper>| {
        last.set(now.time());
        recorder.borrow_mut().record(now)
    };
    let tables = course.events.iter().map(|_| RefCell::new((recorder_of(stepper, Columns::new(0)), Vec::new())));
    let tables: Vec<_> = tables.collect();
    let look = course.every.max(1) * LOOK.div_ceil(course.every.max(1));
    // The last step may end before the time that was asked for, by as much as a number of steps may be off.
    #[allow(clippy::cast_precision_loss)] // 9e15 at most
    let end = stepper.time(&state) + steps as f64 * stepper.step_size();
    let mut observed = Run::new(stepper, &mut state).every(course.every, row).every(look, |_| signals.look());
    if let Some(times) = &course.times {
        let forwards = stepper.step_size().signum();
        // Up to here a time is that of the end but for its rounding.
        let last = end + forwards * 2.0 * f64::EPSILON * end.abs();
        let is_last = move |time: f64| (time - last) * forwards > 0.0 && (time - end).abs() <= ROUNDING * end.abs();
        let times = times.iter().map(move |&time| if !is_varied && is_last(time) { last } else { time });
        observed = observed.at(times, row);
    }
    for (watch, table) in course.events.iter().zip(&tables) {
        let function = watch.function(&stepper.layout().factors, &signals)?;
        observed = observed.event(watch.kind(), function, |now| {
            let (recorder, rising) = &mut *table.borrow_mut();
            rising.push(now.rising().unwrap_or_default());
            recorder.record(now)
        });
    }
    let made = if is_varied { observed.until(course.until) } else { observed.steps(steps) };
    let end = Moment::of_step(stepper, &state);
    let (steps, time) = (end.steps(), end.time());
    // The last state is a row, too, unless only some times are requested. Steps may go back.
    let is_a_row = (last.get() - time) * stepper.step_size().signum() >= 0.0;
    let written = if course.every > 0 && !is_a_row { row(&end) } else { Ok(()) };
    let written = written.and_then(|()| recorder.into_inner().finish().map(|_| ()));
    let finish = |table: RefCell<(Recorder<'_, AnyStepper, Columns>, Vec<bool>)>| {
        let (recorder, rising) = table.into_inner();
        recorder.finish().map(|columns| (columns, rising))
    };
    let events = tables.into_iter().map(finish).collect::<Result<Vec<_>, RecordError>>();
    let memory = |error: RecordError| Failure::Of("MemoryError", error.to_string());
    let (mut iterations, mut ending, mut failure) = (0, None, None);
    match made {
        Ok(report) => {
            iterations = report.iterations;
            if let Reason::Event { event, .. } = report.reason {
                ending = Some(event);
            }
        }
        Err(error) => {
            failure = Some(signals.into_failure().unwrap_or_else(|| match error {
                RunError::Observer { cause, .. } => Failure::Of("MemoryError", cause.to_string()),
                other => Failure::step(&other),
            }));
        }
    }
    failure = failure.or_else(|| written.err().map(memory));
    Ok(RunRecord { columns, events: events.map_err(memory)?, steps, iterations, ending, failure })
}

type Watched<'a> = Box<dyn Fn(&Moment<'_, AnyStepper>) -> f64 + 'a>;

impl Watch {
    fn kind(&self) -> Event {
        let kind = match self.direction {
            1 => Event::rising(),
            -1 => Event::falling(),
            _ => Event::crossing(),
        };
        if self.stops { kind.terminal() } else { kind }
    }

    /// The function that rises through zero as the quantity rises through its value.
    fn function<'a>(&'a self, factors: &[Factor], signals: &'a Signals) -> Result<Watched<'a>, Failure> {
        let Some(function) = &self.function else { return self.of_quantity(factors) };
        let rows: Vec<usize> = factors.iter().map(|factor| factor.kind.rows()).collect();
        Ok(Box::new(move |now| {
            let seen = (now.time(), now.attitude(), &rows, now.velocity(), now.momentum(), now.energy());
            let called = Python::attach(|py| function.call1(py, seen)?.extract(py));
            called.unwrap_or_else(|error| {
                signals.raise(error);
                f64::NAN
            })
        }))
    }

    fn of_quantity<'a>(&self, factors: &[Factor]) -> Result<Watched<'a>, Failure> {
        let (value, quantity) = (self.value, self.quantity.as_str());
        let components = || factors.iter().flat_map(|factor| &factor.components);
        let place = |kind: &str| components().position(|(name, _)| quantity.strip_prefix(kind) == Some(name));
        let is_rotation =
            factors.first().is_some_and(|factor| factor.kind == FactorKind::Rotation) && factors.len() == 1;
        let axis = ["axis_x", "axis_y", "axis_z"].iter().position(|name| *name == quantity).filter(|_| is_rotation);
        let entry = entries(factors).position(|name| name == quantity).filter(|_| !is_rotation);
        let what = match (place("velocity_"), place("momentum_"), axis, entry) {
            (Some(place), ..) => Quantity::Velocity(place),
            (_, Some(place), ..) => Quantity::Momentum(place),
            // The third axis of the body is the last column.
            (.., Some(axis), _) => Quantity::Entry(3 * axis + 2),
            (.., Some(entry)) => Quantity::Entry(entry),
            _ if quantity == "energy" => Quantity::Energy,
            _ if quantity == "speed" => Quantity::Speed,
            _ if quantity == "tilt" && is_rotation && (0.0..=PI).contains(&value) => Quantity::Tilt,
            _ if quantity == "tilt" && is_rotation => {
                return Err(Failure::Of("SetupError", "a tilt is from 0 to 180 deg".to_owned()));
            }
            _ => {
                let own = components().map(|(name, _)| format!("velocity_{name}, momentum_{name}, "));
                let rest = if is_rotation { "axis_x, axis_y, axis_z, tilt, " } else { "the entries g_12 …, " };
                let known = own.collect::<String>();
                let message = format!("no event is about `{quantity}`: there are {known}{rest}energy, speed");
                return Err(Failure::Of("SetupError", message));
            }
        };
        Ok(Box::new(move |now| match what {
            // The tilt is compared by its cosine, which is smooth at the vertical.
            Quantity::Tilt => value.cos() - entry_of(now, 8),
            Quantity::Entry(place) => entry_of(now, place) - value,
            Quantity::Energy => now.energy() - value,
            Quantity::Speed => now.velocity().iter().map(|part| part * part).sum::<f64>() - value * value.abs(),
            Quantity::Velocity(place) => now.velocity()[place] - value,
            Quantity::Momentum(place) => now.momentum()[place] - value,
        }))
    }
}

#[derive(Clone, Copy)]
enum Quantity {
    Tilt,
    Entry(usize),
    Energy,
    Speed,
    Velocity(usize),
    Momentum(usize),
}

fn entry_of(motion: &AnyMotion, place: usize) -> f64 {
    motion.attitude().get(place).copied().unwrap_or(f64::NAN)
}

/// The name of each entry of an attitude in a table, empty for an entry that no table has.
fn entries(factors: &[Factor]) -> impl Iterator<Item = String> {
    factors.iter().flat_map(|factor| {
        let (rows, mut names) = (factor.kind.rows(), factor.columns().into_iter().map(|(name, _)| name));
        let name = move |entry| match factor.kind {
            FactorKind::Rotation => String::new(),
            FactorKind::Translation(_) if entry % rows < rows - 1 || entry / rows == rows - 1 => String::new(),
            _ => names.next().unwrap_or_default(),
        };
        (0..rows * rows).map(name).collect::<Vec<_>>()
    })
}
