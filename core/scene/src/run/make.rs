//! The steps of a run, and the recording of its samples, events and table.

use std::cell::RefCell;
use std::fmt;

use liestep::accuracy::{AccuracyError, Choice};
use liestep::motion::{AnyState, AnyStepper, Integrator as _, Moment};
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
    /// Suffix of the step's length in texts where it is a mean.
    pub(crate) average: &'static str,
    steps: u64,
    happenings: Vec<Happening>,
    /// The event that ended the run.
    pub(crate) ending: Option<usize>,
    /// The choice of the step, if the scene requires an accuracy.
    pub(crate) choice: Option<Choice>,
    /// Remarks about the file, with their places.
    pub(crate) notes: Vec<Mistake>,
}

/// An event that has happened.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Happening {
    /// The number of the event in the scene, from zero.
    pub event: usize,
    /// Whether the quantity rose.
    pub rising: bool,
    /// The state at the event.
    pub sample: Sample,
}

/// Most events of a run.
const MOST_HAPPENINGS: usize = 1_000_000;

/// The reason why a run couldn't be started or finished.
#[derive(Debug)]
pub(crate) enum Stop {
    Setup(SetupError),
    Start(SetupError),
    Accuracy(AccuracyError),
    /// An invalid spring, by its number in the file.
    Spring(usize, String),
    Step {
        time: f64,
        cause: StepError,
    },
    /// A failure of the table rather than of the run.
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

/// The failure of a step, in the words of files.
pub(crate) fn told(cause: &StepError) -> String {
    match *cause {
        StepError::BeyondSolvable { step, largest, turn, .. } if largest > 0.0 && turn.is_finite() => format!(
            "a step of {step:e} s has no solution: a body would turn by about {turn:.2} rad, and {:.2} rad is the most from \
             here; take a `step` of at most {largest:e} s",
            turn * (largest / step)
        ),
        StepError::BeyondSolvable { step, .. } => {
            format!(
                "a step of {step:e} s has no solution: a body turns too far in it; take a smaller `step`, or a slower start"
            )
        }
        ref cause => cause.to_string(),
    }
}

/// Angle of turn, rad, from which a step of (3.13) has a spin wrong by more than a hundredth.
const FAST_TURN: f64 = 0.25;

/// A note about a body that turns by this angle in a step of (3.13), rad: a spin turns by `asin(hΩ)`.
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

/// Line and column in a file, from one.
pub(crate) type Place = (usize, usize);

/// A remark about a file, with its place.
pub(crate) type Note = (Place, String);

/// The receivers of a run's progress and of its table.
pub(crate) struct Listeners<'a> {
    /// Takes the completed share of the run, from 0 to 1, at most a hundred times.
    pub(crate) progress: &'a mut dyn FnMut(f64),
    /// Destination of the table's rows.
    pub(crate) table: Option<&'a mut dyn Sink>,
}

/// The length and the table of a run, as prescribed by the file.
pub(crate) struct Course<'a> {
    pub(crate) steps: u64,
    /// End of the run, s, for varying steps.
    pub(crate) end: f64,
    /// Steps from row to row.
    pub(crate) stride: u64,
    pub(crate) columns: &'a [Column],
    /// Columns of the table, one for each number.
    pub(crate) listed: Vec<recording::Column>,
}

/// The function that passes zero where an event happens.
pub type EventFunction = Box<dyn Fn(&Moment<'_, AnyStepper>) -> f64 + Send + Sync>;

/// An event of a scene.
#[non_exhaustive]
pub struct Watch {
    /// The kind of passages that are events.
    pub event: recording::Event,
    /// The function that passes zero at the event.
    pub function: EventFunction,
    /// Whether the event ends the motion.
    pub stops: bool,
}

/// Runs the steps, unless an event stops the run, and records as many samples as a picture needs.
pub(crate) fn make(
    stepper: &AnyStepper,
    mut state: AnyState,
    course: Course<'_>,
    sample: impl Fn(&Moment<'_, AnyStepper>) -> Sample,
    events: Vec<Watch>,
    listeners: Listeners<'_>,
) -> Result<Run, Stop> {
    let (mut samples, happenings) = (Vec::new(), RefCell::new(Vec::new()));
    let (numbers, steps, stride) = (RefCell::new(Vec::new()), course.steps, course.stride);
    let until = stepper.length(&state).map(|_| course.end);
    let mut table = listeners.table.map(|sink| TableRecorder::new(course, &numbers, stepper, sink));
    // The observer of rows is added without a table, too, so that the steps are the same.
    let mut observed = recording::Run::new(stepper, &mut state)
        .every(picture_stride(steps), |now| keep(&mut samples, sample(now)))
        .every(stride, |now| table.as_mut().map_or(Ok(()), |table| table.record(now, sample(now))))
        .progress(listeners.progress);
    for (event, Watch { event: kind, function, stops }) in events.into_iter().enumerate() {
        let (happenings, sample) = (&happenings, &sample);
        let kind = if stops { kind.terminal() } else { kind };
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
    // A run that fails still writes its rows, and its own error takes precedence.
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
        None => (stepper.step_size(), ""),
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

/// The writer of a table during a run.
struct TableRecorder<'a> {
    columns: &'a [Column],
    recorder: Recorder<'a, AnyStepper, &'a mut dyn Sink>,
    /// The first and the last state of the table.
    ends: Option<(Sample, Sample)>,
    /// The last row, from which each quantity of the recorder reads its number.
    numbers: &'a RefCell<Vec<f64>>,
}

impl<'a> TableRecorder<'a> {
    fn new(course: Course<'a>, numbers: &'a RefCell<Vec<f64>>, stepper: &AnyStepper, sink: &'a mut dyn Sink) -> Self {
        let mut recorder = Recorder::bare(stepper, sink);
        for (place, recording::Column { name, unit }) in course.listed.into_iter().enumerate() {
            let number = move |_: &Moment<'_, _>| numbers.borrow().get(place).copied().unwrap_or(f64::NAN);
            recorder = recorder.quantity(name, unit, number);
        }
        Self { columns: course.columns, recorder, ends: None, numbers }
    }

    fn record(&mut self, now: &Moment<'_, AnyStepper>, mut sample: Sample) -> Result<(), RecordError> {
        let (first, last) = self.ends.get_or_insert_with(|| (sample.clone(), sample.clone()));
        sample.follow(last);
        *last = sample;
        self.numbers.replace(Column::row(self.columns, first, last));
        self.recorder.record(now)
    }

    /// Adds the last row, and finishes the table.
    fn finish(mut self, end: &Moment<'_, AnyStepper>, sample: Sample) -> Result<(), RecordError> {
        let is_written = self.ends.as_ref().is_some_and(|(_, last)| last.time >= sample.time);
        let recorded = if is_written { Ok(()) } else { self.record(end, sample) };
        recorded.and_then(|()| self.recorder.finish().map(|_| ()))
    }
}

impl Run {
    /// The samples for pictures: the first state, the last, and the state after every `k`-th step, with the least `k`
    /// for which these are 20 000 at most.
    #[must_use]
    pub fn samples(&self) -> &[Sample] {
        &self.samples
    }

    /// The events that happened, in their order.
    #[must_use]
    pub fn happenings(&self) -> &[Happening] {
        &self.happenings
    }

    /// The times of an event, s.
    pub(crate) fn times(&self, event: usize) -> impl Iterator<Item = f64> {
        self.happenings.iter().filter(move |happening| happening.event == event).map(|happening| happening.sample.time)
    }

    /// The step, s; the mean one if steps vary.
    #[must_use]
    pub fn step(&self) -> f64 {
        self.step
    }

    /// The number of steps.
    #[must_use]
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Remarks about possible improvements of the file.
    #[must_use]
    pub fn notes(&self) -> &[Mistake] {
        &self.notes
    }

    /// The choice of the step, if the scene requires an accuracy.
    #[must_use]
    pub fn choice(&self) -> Option<&Choice> {
        self.choice.as_ref()
    }

    /// Title, terms, steps and the energy at both ends, followed by the text of `rest`.
    pub(crate) fn summary(
        &self,
        title: &str,
        sum: &str,
        unit: &str,
        rest: impl FnOnce(&Sample, &Sample) -> String,
    ) -> String {
        let (Some(first), Some(last)) = (self.samples.first(), self.samples.last()) else { return String::new() };
        let (Self { steps, average, .. }, step, rest) = (self, short(self.step), rest(first, last));
        let [before, after] = [first.energy, last.energy].map(short);
        let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
        format!("{title}\n  {sum}, {steps} steps of {step} s{average}\n  energy {before}{unit} → {after}{unit}{rest}\n")
    }
}
