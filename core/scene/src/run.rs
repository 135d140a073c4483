//! A run of one scene, and its samples.

use std::cell::RefCell;
use std::error::Error;
use std::fmt;

use liestep::accuracy::{AccuracyError, Choice};
use liestep::groups::Advected;
use liestep::motion::{AnyState, AnyStepper, Integrator as _, Moment};
use liestep::with::{self, Csv, Reason, RecordError, Recorder, RunError, Sink};
use liestep::{SO3, SetupError, StepError};
use nalgebra::{Matrix3, Vector3};

use crate::columns::{Column, Row, drawn};
use crate::events::{Event, Happening, Log};
use crate::file::{Places, SceneFile};

/// A state, in SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Sample {
    /// Since the start, s.
    pub time: f64,
    /// Body to space.
    pub attitude: SO3,
    /// Body frame, kg m²/s.
    pub momentum: Vector3<f64>,
    /// Body frame, rad/s.
    pub velocity: Vector3<f64>,
    /// Of the continuous limit, J.
    pub energy: f64,
}

impl Sample {
    pub(crate) fn of<A: Advected<SO3>>(now: &Moment<'_, AnyStepper<SO3, A>>) -> Self {
        Self {
            time: now.time(),
            attitude: now.attitude(),
            momentum: now.momentum(),
            velocity: now.velocity(),
            energy: now.energy(),
        }
    }

    pub(crate) fn matrix(&self) -> Matrix3<f64> {
        use liestep::groups::LieGroup as _;
        self.attitude.matrix()
    }

    /// The angular momentum in space, kg m²/s.
    #[must_use]
    pub fn spatial_momentum(&self) -> Vector3<f64> {
        self.matrix() * self.momentum
    }
}

/// A run that couldn't be started or finished.
#[derive(Debug)]
pub(crate) enum Stopped {
    Setup(SetupError),
    Start(SetupError),
    Asked(AccuracyError),
    Step {
        time: f64,
        cause: StepError,
    },
    /// Not the run, but its table.
    Table(String),
    Other(String),
}

impl Stopped {
    /// Which part of a file it is about.
    pub(crate) fn place(&self, places: &Places) -> (usize, usize) {
        match self {
            Self::Setup(SetupError::InvalidStep { .. })
            | Self::Asked(_)
            | Self::Step { .. }
            | Self::Table(_)
            | Self::Other(_) => places.pace,
            // What a method asks of a scene.
            Self::Setup(
                SetupError::NotSeparable { .. }
                | SetupError::InertiaMismatch { .. }
                | SetupError::BiasMismatch
                | SetupError::NoForceGradient,
            ) => places.method,
            Self::Setup(_) => places.body,
            Self::Start(_) => places.start,
        }
    }
}

impl fmt::Display for Stopped {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Setup(cause) | Self::Start(cause) => cause.fmt(f),
            Self::Asked(cause) => cause.fmt(f),
            Self::Table(cause) | Self::Other(cause) => f.write_str(cause),
            Self::Step { time, cause } => {
                write!(f, "stopped at t = {time} s: {cause}")?;
                match cause {
                    StepError::BeyondSolvable { .. } => f.write_str(", and is `kinetic = \"cayley\"` of the body here"),
                    _ => Ok(()),
                }
            }
        }
    }
}

/// A run that came to its end.
#[derive(Clone, Debug)]
pub struct Run {
    samples: Vec<Sample>,
    /// s.
    step: f64,
    steps: u64,
    happenings: Vec<Happening>,
    /// By which event, and when.
    stopped: Option<(usize, f64)>,
    /// Where an accuracy was asked for.
    choice: Option<Choice>,
}

/// Who is told of a run while it is made.
pub(crate) struct Told<'a> {
    /// The share that is made, from 0 to 1, at most a hundred times.
    pub(crate) progress: &'a mut dyn FnMut(f64),
    /// Where the rows of its table go.
    pub(crate) table: Option<&'a mut dyn Sink>,
}

/// Makes so many steps, unless an event stops the run, and keeps as many states as a picture has room for.
pub(crate) fn make<A: Advected<SO3>>(
    scene: &SceneFile,
    stepper: &AnyStepper<SO3, A>,
    mut state: AnyState<SO3, A>,
    (steps, choice): (u64, Option<Choice>),
    told: Told<'_>,
) -> Result<Run, Stopped> {
    let (mut samples, log) = (Vec::new(), Log(RefCell::new(Vec::new())));
    let numbers = RefCell::new(Vec::new());
    let mut table = told.table.map(|sink| Recorded::new(scene.columns(), &numbers, stepper, sink));
    // The one who writes is asked where nothing is written, too, so that the steps are the same.
    let mut observed = stepper
        .observed(&mut state)
        .every(drawn(steps), |now| samples.push(Sample::of(now)))
        .every(scene.output.stride(steps), |now| table.as_mut().map_or(Ok(()), |table| table.record(now)))
        .progress(told.progress);
    for (number, event) in scene.event.iter().enumerate() {
        let log = &log;
        observed = observed.event(event.kind(), event.function(scene.picture.axis.0), move |now| {
            log.write(Happening { event: number, rising: now.rising().unwrap_or_default(), sample: Sample::of(now) })
        });
    }
    let ended = observed.steps(steps).map_err(|error| match error {
        RunError::Step { time, cause } => Stopped::Step { time, cause },
        RunError::Observer { cause, .. } if cause.is::<RecordError>() => Stopped::Table(cause.to_string()),
        other => Stopped::Other(other.to_string()),
    });
    let now = Moment::of_step(stepper, &state);
    let last = Sample::of(&now);
    if samples.last().is_none_or(|sample| sample.time < last.time) {
        samples.push(last);
    }
    // A run that stops leaves its rows, and its own error comes first.
    let written = table.map_or(Ok(()), |table| table.finish(&now));
    let ended = ended?;
    written.map_err(|error| Stopped::Table(error.to_string()))?;
    let stopped = match ended.reason {
        Reason::Event { event, time } => Some((event, time)),
        _ => None,
    };
    let step = stepper.step_size();
    Ok(Run { samples, happenings: log.0.into_inner(), step, steps: ended.steps, stopped, choice })
}

/// A table that is written while a run is made.
struct Recorded<'a, A: Advected<SO3>> {
    columns: &'a [Column],
    recorder: Recorder<'a, AnyStepper<SO3, A>, &'a mut dyn Sink>,
    /// The row that is written last.
    row: Option<Row>,
    /// Its numbers, which all quantities of the recorder look up.
    numbers: &'a RefCell<Vec<f64>>,
    /// s.
    written: Option<f64>,
}

impl<'a, A: Advected<SO3>> Recorded<'a, A> {
    fn new(
        columns: &'a [Column],
        numbers: &'a RefCell<Vec<f64>>,
        stepper: &AnyStepper<SO3, A>,
        sink: &'a mut dyn Sink,
    ) -> Self {
        let mut recorder = Recorder::bare(stepper, sink);
        for (place, with::Column { name, unit }) in Column::listed(columns).enumerate() {
            let number = move |_: &Moment<'_, _>| numbers.borrow().get(place).copied().unwrap_or(f64::NAN);
            recorder = recorder.quantity(name, unit, number);
        }
        Self { columns, recorder, row: None, numbers, written: None }
    }

    fn record(&mut self, now: &Moment<'_, AnyStepper<SO3, A>>) -> Result<(), RecordError> {
        let sample = Sample::of(now);
        let row = self.row.get_or_insert_with(|| Row::new(sample));
        row.show(sample);
        self.numbers.replace(row.numbers(self.columns));
        self.written = Some(sample.time);
        self.recorder.record(now)
    }

    /// With the end of the run as its last row.
    fn finish(mut self, end: &Moment<'_, AnyStepper<SO3, A>>) -> Result<(), RecordError> {
        let recorded = if self.written < Some(end.time()) { self.record(end) } else { Ok(()) };
        recorded.and_then(|()| self.recorder.finish().map(|_| ()))
    }
}

impl Run {
    /// The states that were kept for pictures, the first and the last among them: 20 000 or a few less of a longer run.
    #[must_use]
    pub fn samples(&self) -> &[Sample] {
        &self.samples
    }

    /// The events that happened, in their order.
    #[must_use]
    pub fn happenings(&self) -> &[Happening] {
        &self.happenings
    }

    /// The events as comma-separated values: its name, 1 where the quantity rose and 0 where it fell, the time, and the
    /// scene's columns.
    ///
    /// # Errors
    ///
    /// None: it is written to memory.
    pub fn event_table(&self, scene: &SceneFile) -> Result<String, Box<dyn Error + Send + Sync>> {
        let mut rows = Csv::new(Vec::new());
        let time = with::Column { name: "t".to_owned(), unit: "s".to_owned() };
        rows.begin(&std::iter::once(time).chain(Column::listed(scene.columns())).collect::<Vec<_>>())?;
        let mut row = self.samples.first().copied().map(Row::new);
        for Happening { sample, .. } in &self.happenings {
            let row = row.get_or_insert_with(|| Row::new(*sample));
            row.show(*sample);
            let numbers = row.numbers(scene.columns());
            rows.write(&std::iter::once(sample.time).chain(numbers).collect::<Vec<_>>())?;
        }
        let rows = String::from_utf8(rows.into_inner()?)?;
        let mut rows = rows.lines();
        let mut text = format!("event,rising,{}\n", rows.next().unwrap_or_default());
        for (happening, row) in self.happenings.iter().zip(rows) {
            let name = scene.event.get(happening.event).map_or("", |event| event.name.as_str());
            text.extend([name, if happening.rising { ",1," } else { ",0," }, row, "\n"]);
        }
        Ok(text)
    }

    /// The step, s.
    #[must_use]
    pub fn step(&self) -> f64 {
        self.step
    }

    /// How many steps were made.
    #[must_use]
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// What was chosen where an accuracy was asked for.
    #[must_use]
    pub fn choice(&self) -> Option<&Choice> {
        self.choice.as_ref()
    }

    /// A line about the beginning and the end, and the table of the choice if there was one.
    #[must_use]
    pub fn summary(&self, scene: &SceneFile) -> String {
        let (Some(first), Some(last)) = (self.samples.first(), self.samples.last()) else {
            return String::new();
        };
        let [before, after] = [first, last].map(|s| s.spatial_momentum().norm());
        let told = |(number, event): (usize, &Event)| {
            let times: Vec<_> =
                self.happenings.iter().filter(|happening| happening.event == number).map(|h| h.sample.time).collect();
            let first = times.first().map_or_else(String::new, |first| format!(", first at t = {first} s"));
            let stopped =
                if self.stopped.is_some_and(|(event, _)| event == number) { ", which ended the run" } else { "" };
            let often = if times.len() == 1 { "once".to_owned() } else { format!("{} times", times.len()) };
            format!("  {}: {often}{first}{stopped}\n", event.name)
        };
        let events: Vec<_> = scene.event.iter().enumerate().map(told).collect();
        let events = events.concat();
        let choice = self.choice.as_ref().map(ToString::to_string).unwrap_or_default();
        format!(
            "{}\n  {}, {} steps of {} s\n  energy {:.6} J → {:.6} J, momentum {:.6} → {:.6} kg m²/s\n{events}{choice}",
            scene.title(),
            scene.sum(),
            self.steps,
            self.step,
            first.energy,
            last.energy,
            before,
            after,
        )
    }
}
