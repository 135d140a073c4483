//! A run of one scene, and its samples.

use std::cell::RefCell;
use std::fmt;

use liestep::accuracy::{AccuracyError, Choice};
use liestep::groups::Advected;
use liestep::motion::{AnyState, AnyStepper, Moment};
use liestep::with::{Reason, RunError};
use liestep::{SO3, SetupError, StepError};
use nalgebra::{Matrix3, Vector3};

use crate::columns::table;
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
    fn of<A: Advected<SO3>>(now: &Moment<'_, AnyStepper<SO3, A>>) -> Self {
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
    Step { time: f64, cause: StepError },
    Other(String),
}

impl Stopped {
    /// Which part of a file it is about.
    pub(crate) fn place(&self, places: &Places) -> (usize, usize) {
        match self {
            Self::Setup(SetupError::InvalidStep { .. }) | Self::Asked(_) | Self::Step { .. } | Self::Other(_) => {
                places.pace
            }
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
            Self::Other(cause) => f.write_str(cause),
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

/// What is told the share of a run that is made, from 0 to 1, a hundred times.
pub(crate) type Told<'a> = &'a mut dyn FnMut(f64);

/// Makes so many steps, unless an event stops the run, and keeps the state at every `stride`-th and at the end.
pub(crate) fn make<A: Advected<SO3>>(
    scene: &SceneFile,
    stepper: &AnyStepper<SO3, A>,
    mut state: AnyState<SO3, A>,
    (steps, choice): (u64, Option<Choice>),
    told: Told<'_>,
) -> Result<Run, Stopped> {
    let (mut samples, log) = (Vec::new(), Log(RefCell::new(Vec::new())));
    let stride = scene.output.stride(steps);
    let mut observed = stepper.observed(&mut state).every(stride, |now| samples.push(Sample::of(now))).progress(told);
    for (number, event) in scene.event.iter().enumerate() {
        let log = &log;
        observed = observed.event(event.kind(), event.function(scene.picture.axis.0), move |now| {
            log.write(Happening { event: number, rising: now.rising().unwrap_or_default(), sample: Sample::of(now) })
        });
    }
    let ended = observed.steps(steps).map_err(|error| match error {
        RunError::Step { time, cause } => Stopped::Step { time, cause },
        other => Stopped::Other(other.to_string()),
    })?;
    let last = Sample::of(&Moment::of_step(stepper, &state));
    if samples.last().is_none_or(|sample| sample.time < last.time) {
        samples.push(last);
    }
    let stopped = match ended.reason {
        Reason::Event { event, time } => Some((event, time)),
        _ => None,
    };
    let step = stepper.step_size();
    Ok(Run { samples, happenings: log.0.into_inner(), step, steps: ended.steps, stopped, choice })
}

impl Run {
    /// The states that were kept, the first and the last among them.
    #[must_use]
    pub fn samples(&self) -> &[Sample] {
        &self.samples
    }

    /// The events that happened, in their order.
    #[must_use]
    pub fn happenings(&self) -> &[Happening] {
        &self.happenings
    }

    /// The events as comma-separated values: its name, 1 where the quantity rose and 0 where it fell, and the columns of
    /// [`table`](Self::table).
    #[must_use]
    pub fn event_table(&self, scene: &SceneFile) -> String {
        let mut text = "event,rising,".to_owned();
        let samples: Vec<_> = self.happenings.iter().map(|happening| happening.sample).collect();
        let table = table(scene.columns(), self.samples.first(), &samples);
        let mut rows = table.lines();
        text.extend([rows.next().unwrap_or_default(), "\n"]);
        for (happening, row) in self.happenings.iter().zip(rows) {
            let name = scene.event.get(happening.event).map_or("", |event| event.name.as_str());
            text.extend([name, if happening.rising { ",1," } else { ",0," }, row, "\n"]);
        }
        text
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

    /// The samples as comma-separated values, with the columns that the scene asks for.
    #[must_use]
    pub fn table(&self, scene: &SceneFile) -> String {
        table(scene.columns(), self.samples.first(), &self.samples)
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
