//! The steps of a run, and what is kept of them.

use std::cell::RefCell;
use std::fmt;

use liestep::accuracy::{AccuracyError, Choice};
use liestep::groups::LieGroup;
use liestep::motion::{Integrator, Moment};
use liestep::recording::{self, Reason, RecordError, Recorder, RunError, Sink};
use liestep::{SetupError, StepError};

use crate::file::column::{Column, picture_stride};
use crate::file::mistake::Mistake;
use crate::file::quantity::{round, short};
use crate::file::sample::Sample;

/// A run that came to its end.
#[derive(Clone, Debug)]
pub struct Run {
    samples: Vec<Sample>,
    /// s.
    step: f64,
    /// What is said behind it where it is a mean.
    pub(crate) average: &'static str,
    steps: u64,
    happenings: Vec<Happening>,
    /// The event that ended it.
    pub(crate) ending: Option<usize>,
    /// Where an accuracy was asked for.
    pub(crate) choice: Option<Choice>,
    /// Remarks about the file, with their places.
    pub(crate) notes: Vec<Mistake>,
}

/// An event that has happened.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Happening {
    /// Which of the scene's events, from zero.
    pub event: usize,
    /// Whether the quantity rose.
    pub rising: bool,
    /// The motion then.
    pub sample: Sample,
}

/// More are no events but the course of the motion.
const MOST_HAPPENINGS: usize = 1_000_000;

/// Why a run couldn't be started or finished.
#[derive(Debug)]
pub(crate) enum Stop {
    Setup(SetupError),
    Start(SetupError),
    Accuracy(AccuracyError),
    /// A spring that is wrong, by its number in the file.
    Spring(usize, String),
    Step {
        time: f64,
        cause: StepError,
    },
    /// Not the run, but its table.
    Table(String),
    Other(String),
}

impl fmt::Display for Stop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Setup(cause) | Self::Start(cause) => cause.fmt(f),
            Self::Accuracy(cause) => cause.fmt(f),
            Self::Spring(_, cause) | Self::Table(cause) | Self::Other(cause) => f.write_str(cause),
            Self::Step { time, cause } => write!(f, "stopped at t = {} s: {}", short(*time), told(cause)),
        }
    }
}

/// Why a step can't be made, in the words of files.
pub(crate) fn told(cause: &StepError) -> String {
    match *cause {
        StepError::BeyondSolvable { step, largest, turn, .. } if largest > 0.0 => format!(
            "a step of {step:e} s has no solution: a body would turn by about {turn:.2} rad, and {:.2} rad is the most from \
             here; take a `step` of at most {largest:e} s",
            turn * (largest / step)
        ),
        ref cause => cause.to_string(),
    }
}

/// A step of (3.13) that turns a body so far, rad, has its spins wrong by more than a hundredth.
const FAST_TURN: f64 = 0.25;

/// A note about a body that turns about so far in a step of (3.13), rad: a spin turns by `asin(hΩ)`.
pub(crate) fn fast_turn(turn: f64) -> Option<String> {
    (turn > FAST_TURN).then(|| {
        let share = 100.0 * (turn.min(1.0).asin() / turn.min(1.0) - 1.0);
        let more = if turn > 1.0 { "at least " } else { "" };
        format!(
            "hΩ = {} rad: by `kinetic = \"rigid\"` a body that spins so turns {more}{share:.0} % too far; take a smaller \
             `step`, or `kinetic = \"geodesic\"`",
            round(turn)
        )
    })
}

/// A remark about a file, behind its line and column.
pub(crate) type Note = ((usize, usize), String);

/// Who learns of a run while it is made.
pub(crate) struct Listeners<'a> {
    /// The share that is made, from 0 to 1, at most a hundred times.
    pub(crate) progress: &'a mut dyn FnMut(f64),
    /// Where the rows of its table go.
    pub(crate) table: Option<&'a mut dyn Sink>,
}

/// What of a run a file says: its length and its table.
pub(crate) struct Course<'a> {
    pub(crate) steps: u64,
    /// s; where steps vary, it is their end.
    pub(crate) end: f64,
    /// In steps from row to row.
    pub(crate) stride: u64,
    pub(crate) columns: &'a [Column],
    /// Those of the table, one for each number.
    pub(crate) listed: Vec<recording::Column>,
}

/// The function that passes zero where an event happens.
pub(crate) type EventFunction<I> = Box<dyn Fn(&Moment<'_, I>) -> f64>;

/// Makes the steps, unless an event stops the run, and keeps as many states as a picture has room for.
pub(crate) fn make<I: Integrator<Group: LieGroup<Scalar: Into<f64>>>>(
    stepper: &I,
    mut state: I::State,
    course: Course<'_>,
    sample: impl Fn(&Moment<'_, I>) -> Sample,
    events: Vec<(recording::Event, EventFunction<I>)>,
    listeners: Listeners<'_>,
) -> Result<Run, Stop> {
    let (mut samples, happenings) = (Vec::new(), RefCell::new(Vec::new()));
    let (numbers, steps, stride) = (RefCell::new(Vec::new()), course.steps, course.stride);
    let until = stepper.length(&state).map(|_| course.end);
    let mut table = listeners.table.map(|sink| TableRecorder::new(course, &numbers, stepper, sink));
    // The one who writes is asked where nothing is written, too, so that the steps are the same.
    let mut observed = recording::Run::new(stepper, &mut state)
        .every(picture_stride(steps), |now| keep(&mut samples, sample(now)))
        .every(stride, |now| table.as_mut().map_or(Ok(()), |table| table.record(now, sample(now))))
        .progress(listeners.progress);
    for (event, (kind, function)) in events.into_iter().enumerate() {
        let (happenings, sample) = (&happenings, &sample);
        observed = observed.event(kind, function, move |now| {
            let mut happenings = happenings.borrow_mut();
            if happenings.len() >= MOST_HAPPENINGS {
                return Err("an event happens more than a million times");
            }
            happenings.push(Happening { event, rising: now.rising().unwrap_or_default(), sample: sample(now) });
            Ok(())
        });
    }
    let end = if let Some(end) = until { observed.until(end) } else { observed.steps(steps) };
    let end = end.map_err(|error| match error {
        RunError::Step { time, cause } => Stop::Step { time, cause },
        RunError::Observer { cause, .. } if cause.is::<RecordError>() => Stop::Table(cause.to_string()),
        other => Stop::Other(other.to_string()),
    });
    let now = Moment::of_step(stepper, &state);
    let last = sample(&now);
    if samples.last().is_none_or(|sample| sample.time < last.time) {
        keep(&mut samples, last.clone());
    }
    // A run that stops leaves its rows, and its own error comes first.
    let written = table.map_or(Ok(()), |table| table.finish(&now, last));
    let end = end?;
    written.map_err(|error| Stop::Table(error.to_string()))?;
    let ending = match end.reason {
        Reason::Event { event, .. } => Some(event),
        _ => None,
    };
    #[allow(clippy::cast_precision_loss)] // a count
    let (step, average) = match until {
        Some(_) => (samples.last().map_or(0.0, |last| last.time) / end.steps.max(1) as f64, " on the average"),
        None => (stepper.step_size().into(), ""),
    };
    Ok(Run {
        samples,
        happenings: happenings.into_inner(),
        step,
        average,
        steps: end.steps,
        ending,
        choice: None,
        notes: Vec::new(),
    })
}

fn keep(samples: &mut Vec<Sample>, mut now: Sample) {
    if let Some(before) = samples.last() {
        now.follow(before);
    }
    samples.push(now);
}

/// A table that is written while a run is made.
struct TableRecorder<'a, I: Integrator> {
    columns: &'a [Column],
    recorder: Recorder<'a, I, &'a mut dyn Sink>,
    /// The first state of the table, and the last.
    ends: Option<(Sample, Sample)>,
    /// The row that is written last, in which all quantities of the recorder look their number up.
    numbers: &'a RefCell<Vec<f64>>,
}

impl<'a, I: Integrator<Group: LieGroup<Scalar: Into<f64>>>> TableRecorder<'a, I> {
    fn new(course: Course<'a>, numbers: &'a RefCell<Vec<f64>>, stepper: &I, sink: &'a mut dyn Sink) -> Self {
        let mut recorder = Recorder::bare(stepper, sink);
        for (place, recording::Column { name, unit }) in course.listed.into_iter().enumerate() {
            let number = move |_: &Moment<'_, _>| numbers.borrow().get(place).copied().unwrap_or(f64::NAN);
            recorder = recorder.quantity(name, unit, number);
        }
        Self { columns: course.columns, recorder, ends: None, numbers }
    }

    fn record(&mut self, now: &Moment<'_, I>, mut sample: Sample) -> Result<(), RecordError> {
        let (first, last) = self.ends.get_or_insert_with(|| (sample.clone(), sample.clone()));
        sample.follow(last);
        *last = sample;
        self.numbers.replace(Column::row(self.columns, first, last));
        self.recorder.record(now)
    }

    /// With the end of the run as its last row.
    fn finish(mut self, end: &Moment<'_, I>, sample: Sample) -> Result<(), RecordError> {
        let is_written = self.ends.as_ref().is_some_and(|(_, last)| last.time >= sample.time);
        let recorded = if is_written { Ok(()) } else { self.record(end, sample) };
        recorded.and_then(|()| self.recorder.finish().map(|_| ()))
    }
}

impl Run {
    /// The states that were kept for pictures, the first and the last among them: those of each `k`-th step between, with
    /// the least `k` for which that is 20 000 at most.
    #[must_use]
    pub fn samples(&self) -> &[Sample] {
        &self.samples
    }

    /// The events that happened, in their order.
    #[must_use]
    pub fn happenings(&self) -> &[Happening] {
        &self.happenings
    }

    /// When an event happened, s.
    pub(crate) fn times(&self, event: usize) -> impl Iterator<Item = f64> {
        self.happenings.iter().filter(move |happening| happening.event == event).map(|happening| happening.sample.time)
    }

    /// The step, s; of steps that vary their mean.
    #[must_use]
    pub fn step(&self) -> f64 {
        self.step
    }

    /// How many steps were made.
    #[must_use]
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Remarks about what in the file could be better, though it runs.
    #[must_use]
    pub fn notes(&self) -> &[Mistake] {
        &self.notes
    }

    /// What was chosen where an accuracy was asked for.
    #[must_use]
    pub fn choice(&self) -> Option<&Choice> {
        self.choice.as_ref()
    }

    /// The scene, the steps and the energy at both ends; what else is said of the ends comes behind it.
    pub(crate) fn summary(&self, title: &str, sum: &str, rest: impl FnOnce(&Sample, &Sample) -> String) -> String {
        let (Some(first), Some(last)) = (self.samples.first(), self.samples.last()) else { return String::new() };
        let (Self { steps, average, .. }, step, rest) = (self, short(self.step), rest(first, last));
        let [before, after] = [first.energy, last.energy].map(short);
        format!("{title}\n  {sum}, {steps} steps of {step} s{average}\n  energy {before} J → {after} J{rest}\n")
    }
}
