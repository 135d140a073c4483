//! A scene file as a whole.

use std::path::PathBuf;

use liestep::with::Sink;
use serde::Deserialize;

use crate::body::Body;
use crate::choose;
use crate::columns::{Column, Output};
use crate::effects::{
    DipoleTable, DragTable, GravityGradientTable, GravityTable, MagneticDampingTable, RotorTable, SpringTable,
    ThrustTable, TorqueTable,
};
use crate::ensemble::Drawn;
use crate::events::Event;
use crate::method::Method;
use crate::mistake::Mistake;
use crate::picture::Picture;
use crate::quantity::{Duration, Number, Positive};
use crate::run::{Run, Stopped, Told};
use crate::start::Start;
use crate::sweep::Sweep;
use crate::tables::short;

/// What a scene file says. An effect is in the scene if its table is in the file.
///
/// | table | keys |
/// |---|---|
/// | | `title` |
/// | `body` | one of `moments`, `J_d`, `J`; `kinetic`: `rigid`, which is (3.13), `cayley`, `geodesic`, `fourth-order`, `sixth-order` |
/// | `gravity` | `m`, `g`, `rho`, `up` |
/// | `gravity_gradient` | `GM`, `r`, `direction` |
/// | `dipole` | `moment`, `field` |
/// | `spring` | `k`, `length`, `at`, `anchor` |
/// | `rotor` | `spin` |
/// | `drag` | `c` |
/// | `magnetic_damping` | `k`, `field` |
/// | `torque` | `torque` |
/// | `thrust` | `at`, `thrust` |
/// | `start` | `euler` or `quaternion`; `velocity` or `euler_rates` |
/// | `run` | `duration`; `step` or `accuracy`; `method`: `"step"`, `{ composition = "Suzuki 4" }`, `{ splitting = "Nyström 6-4" }`, `{ processed = "processed 3-6 a" }`, `{ collocation = 8 }` |
/// | `picture` | `path`: `axis`, `momentum`, `velocity`; `axis`; `panels`: `rates`, `tilt`, `energy`, `energy-error`, `momentum`, `vertical-momentum-error`, `momentum-error` |
/// | `[[event]]` | `name`; one of `tilt`, `speed`, `energy`, `velocity_1` to `_3`, `axis_1` to `_3`: the value that is passed; `direction`: `rising`, `falling`, `either`; `stop` |
/// | `output` | `columns` of a table behind the time, see [`Column`]; `every`: so many steps from row to row |
/// | `sweep` | any of the keys above: a list of values, or `{ from, to, count }` |
/// | `ensemble` | `members`; `seed`; `every`: so many steps from row to row, and if it isn't given the ends only; `chunk`: so many members to a file, if it isn't given a 64th of them at most; `draw`: any of the keys of body, effects and start, each drawn from `{ from, to }` or `{ mean, deviation }`, and of lists each component by itself |
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneFile {
    #[serde(deserialize_with = "title")]
    pub(crate) title: String,
    pub(crate) body: Body,
    pub(crate) gravity: Option<GravityTable>,
    pub(crate) gravity_gradient: Option<GravityGradientTable>,
    pub(crate) dipole: Option<DipoleTable>,
    pub(crate) spring: Option<SpringTable>,
    pub(crate) rotor: Option<RotorTable>,
    pub(crate) drag: Option<DragTable>,
    pub(crate) magnetic_damping: Option<MagneticDampingTable>,
    pub(crate) torque: Option<TorqueTable>,
    pub(crate) thrust: Option<ThrustTable>,
    pub(crate) start: Start,
    pub(crate) run: Schedule,
    #[serde(default)]
    pub(crate) picture: Picture,
    #[serde(default)]
    pub(crate) event: Vec<Event>,
    #[serde(default)]
    pub(crate) output: Output,
    /// Only in a file as a whole, and not in a point of its sweep.
    #[serde(skip)]
    pub(crate) sweep: Option<Sweep>,
    /// The same.
    #[serde(skip)]
    pub(crate) ensemble: Option<Drawn>,
    #[serde(skip)]
    pub(crate) origin: Origin,
}

/// Where a scene is from, for messages about its run.
#[derive(Clone, Default)]
pub(crate) struct Origin {
    pub(crate) path: PathBuf,
    pub(crate) places: Places,
}

/// Lines and columns, from one.
#[derive(Clone, Copy, Default)]
pub(crate) struct Places {
    pub(crate) body: (usize, usize),
    pub(crate) start: (usize, usize),
    /// Of the step or the accuracy.
    pub(crate) pace: (usize, usize),
    pub(crate) method: (usize, usize),
}

/// A title with its control characters written out: a terminal would obey them, and SVG has no room for them.
pub(crate) fn title<'de, D: serde::Deserializer<'de>>(deserializer: D) -> Result<String, D::Error> {
    let title = String::deserialize(deserializer)?;
    let visible = |character: char| {
        let escaped: Vec<char> =
            if character.is_control() { character.escape_default().collect() } else { vec![character] };
        escaped
    };
    Ok(title.chars().flat_map(visible).collect())
}

/// How long, and by which steps.
#[derive(Clone, Deserialize)]
#[serde(try_from = "ScheduleTable")]
pub(crate) struct Schedule {
    /// s.
    pub(crate) duration: f64,
    pub(crate) pace: Pace,
    pub(crate) method: Method,
}

/// What sets the step.
#[derive(Clone, Copy)]
pub(crate) enum Pace {
    /// A whole number of equal steps, s.
    Step { step: f64, steps: u32 },
    /// The error at the end.
    Accuracy(f64),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ScheduleTable {
    step: Option<Positive<Duration>>,
    accuracy: Option<Positive<Number>>,
    duration: Positive<Duration>,
    #[serde(default)]
    method: Method,
}

/// A few minutes of stepping.
const MOST_STEPS: f64 = 1e8;

impl TryFrom<ScheduleTable> for Schedule {
    type Error = String;

    fn try_from(table: ScheduleTable) -> Result<Self, String> {
        let duration = table.duration.value;
        let pace = match (table.step, table.accuracy) {
            (Some(step), _) => Pace::Step { step: step.value, steps: equal_steps(step.value, duration)? },
            (None, Some(accuracy)) => Pace::Accuracy(accuracy.value),
            (None, None) => return Err("a run has either a `step` or an `accuracy`".to_owned()),
        };
        Ok(Self { duration, pace, method: table.method })
    }
}

/// The number of equal steps in a duration, s.
pub(crate) fn equal_steps(step: f64, duration: f64) -> Result<u32, String> {
    let steps = (duration / step).round();
    if steps < 1.0 {
        let (duration, step) = (short(duration), short(step));
        return Err(format!("`duration` is {duration} s, shorter than one `step` of {step} s"));
    }
    if steps > MOST_STEPS {
        return Err(format!("`duration` makes {steps:.1e} steps, more than {MOST_STEPS:.0e}; take a larger `step`"));
    }
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // between the two
    let steps = steps as u32;
    Ok(steps)
}

impl SceneFile {
    /// What the scene is called.
    #[must_use]
    pub fn title(&self) -> &str {
        &self.title
    }

    /// The scenes that the file makes of one, if it has a table `sweep`.
    #[must_use]
    pub fn sweep(&self) -> Option<&Sweep> {
        self.sweep.as_ref()
    }

    /// The names of the events that are looked for.
    pub fn events(&self) -> impl Iterator<Item = &str> {
        self.event.iter().map(|event| event.name.as_str())
    }

    /// What a table of the run has behind the time.
    #[must_use]
    pub fn columns(&self) -> &[Column] {
        &self.output.columns
    }

    /// The scenes that are drawn, if the file has a table `ensemble`.
    #[must_use]
    pub fn ensemble(&self) -> Option<&Drawn> {
        self.ensemble.as_ref()
    }

    /// Simulates the scene.
    ///
    /// # Errors
    ///
    /// A [`Mistake`] of the kind [`Run`](crate::Kind::Run) where the scene can't be started or a step not be made.
    pub fn run(&self) -> Result<Run, Mistake> {
        self.run_told(&mut |_| ())
    }

    /// As [`run`](Self::run), with a function that is told a hundred times what share of the run is made, from 0 to 1.
    ///
    /// # Errors
    ///
    /// As [`run`](Self::run).
    pub fn run_told(&self, told: &mut dyn FnMut(f64)) -> Result<Run, Mistake> {
        self.run_by(Told { progress: told, table: None })
    }

    /// As [`run_told`](Self::run_told), and writes the time and the scene's [columns](Self::columns), a row of each
    /// `every`-th step and of the last, as they come: of a run that stops those up to then.
    ///
    /// ```
    /// # fn recorded(scene: &liestep_scene::SceneFile) -> Result<(), Box<dyn std::error::Error>> {
    /// use liestep::with::Csv;
    ///
    /// scene.run_recorded(&mut |_| (), &mut Csv::create("top.csv")?)?;
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    ///
    /// As [`run`](Self::run), and of the kind [`Table`](crate::Kind::Table) where a row can't be written.
    pub fn run_recorded(&self, told: &mut dyn FnMut(f64), table: &mut dyn Sink) -> Result<Run, Mistake> {
        self.run_by(Told { progress: told, table: Some(table) })
    }

    fn run_by(&self, told: Told<'_>) -> Result<Run, Mistake> {
        choose::run(self, told).map_err(|stopped| self.stopped(stopped))
    }

    /// What stopped a run, with the place that it is about.
    pub(crate) fn stopped(&self, stopped: Stopped) -> Mistake {
        let Origin { path, places } = &self.origin;
        match stopped {
            Stopped::Table(message) => Mistake::of_table(path, message),
            stopped => Mistake::of_run(path, stopped.place(places), stopped.to_string()),
        }
    }

    /// Whether the step is chosen for an accuracy, by trial runs.
    #[must_use]
    pub fn asks_for_accuracy(&self) -> bool {
        matches!(self.run.pace, Pace::Accuracy(_))
    }

    /// Simulates so many steps of the scene at most; all of one that asks for an accuracy, as its step isn't known before.
    ///
    /// # Errors
    ///
    /// As [`run`](Self::run).
    pub fn first(&self, most: u32) -> Result<Run, Mistake> {
        let mut first = self.clone();
        if let Pace::Step { steps, .. } = &mut first.run.pace {
            *steps = most.min(*steps);
        }
        first.run()
    }

    /// The sum, and how it is stepped, in words.
    #[must_use]
    pub fn about(&self) -> String {
        let pace = match self.run.pace {
            Pace::Step { step, steps } => format!("{steps} steps of {} s", short(step)),
            Pace::Accuracy(tolerance) => format!("{} s to {tolerance:e}", short(self.run.duration)),
        };
        let sweep = self.sweep.as_ref().map(|sweep| format!(", a sweep of {}", sweep.points().len()));
        let ensemble = self.ensemble.as_ref().map(|ensemble| format!(", an ensemble of {}", ensemble.members()));
        format!("{}, {pace}{}{}", self.sum(), sweep.unwrap_or_default(), ensemble.unwrap_or_default())
    }

    /// The effects by their names in the file.
    pub(crate) fn effects(&self) -> impl Iterator<Item = &'static str> {
        [
            ("gravity", self.gravity.is_some()),
            ("gravity gradient", self.gravity_gradient.is_some()),
            ("dipole", self.dipole.is_some()),
            ("spring", self.spring.is_some()),
            ("rotor", self.rotor.is_some()),
            ("drag", self.drag.is_some()),
            ("magnetic damping", self.magnetic_damping.is_some()),
            ("torque", self.torque.is_some()),
            ("thrust", self.thrust.is_some()),
        ]
        .into_iter()
        .filter_map(|(name, is_there)| is_there.then_some(name))
    }

    /// The sum, in words.
    pub(crate) fn sum(&self) -> String {
        self.effects().fold("body".to_owned(), |sum, name| format!("{sum} + {name}"))
    }

    /// The first force, by its name.
    pub(crate) fn force(&self) -> Option<&'static str> {
        let forces = ["drag", "magnetic damping", "torque", "thrust"];
        self.effects().find(|name| forces.contains(name))
    }

    /// Of the scene's own step: other effects are kicks of order two.
    pub(crate) fn order(&self) -> u32 {
        if self.effects().next().is_none() { self.body.kinetic.order() } else { 2 }
    }
}
