//! The file of a scene with one body.

use std::path::PathBuf;

use liestep::recording;
use nalgebra::Matrix3;
use serde::Deserialize;

use crate::file::body::{Body, Kinetic};
use crate::file::column::{Column, Output};
use crate::file::draws::SceneEnsemble;
use crate::file::effects::{
    DipoleTable, DragTable, GravityGradientTable, GravityTable, MagneticDampingTable, RotorTable, SpringTable,
    ThrustTable, TorqueTable,
};
use crate::file::event::Event;
use crate::file::lagrangian::{Lagrangian, taken};
use crate::file::picture::SpherePicture;
use crate::file::quantity::short;
use crate::file::schedule::{Pace, Schedule};
use crate::file::start::Start;
use crate::file::text::title;

/// What a scene file says. An effect is in the scene if its table is in the file.
///
/// | table | keys |
/// |---|---|
/// | | `title` |
/// | `body` | one of `moments`, `J_d`, `J`; `kinetic`: `rigid`, which is (3.13), `cayley`, `geodesic`, `fourth-order`, `sixth-order` |
/// | `lagrangian` | in place of `body` and all effects: `l_d`, or `l` with `discretise` and the name of its `velocity`; `advected`, as `{ w = "up" }`; and the parameters by their names: numbers, vectors, matrices, inertias as `{ moments = […] }` or `{ tensor = […] }`, nonstandard where the name ends in `_d` |
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
/// | `run` | `duration`; `step`, of which that is a whole number, or `accuracy`; `method`: `"step"`, `{ composition = "Suzuki 4" }`, `{ splitting = "Nyström 6-4" }`, `{ processed = "processed 3-6 a" }`, `{ collocation = 8 }` |
/// | `picture` | `path`: `axis`, `momentum`, `velocity`; `axis`; `panels`: `rates`, `tilt`, `energy`, `energy-error`, `momentum`, `vertical-momentum-error`, `momentum-error` |
/// | `[[event]]` | `name`; one of `tilt`, `speed`, `energy`, `velocity_1` to `_3`, `axis_1` to `_3`: the value that is passed; `direction`: `rising`, `falling`, `either`; `stop` |
/// | `output` | `columns` of a table behind the time, see [`Column`]; `every`: the number of steps from row to row |
/// | `sweep` | any of the keys above: a list of values, or `{ from, to, count }` |
/// | `ensemble` | `members`; `seed`; `every`: the number of steps from row to row, and if it isn't given the ends only; `chunk`: the number of members in a file, if it isn't given a 64th of them at most; `draw`: any of the keys of body, effects and start, each drawn from `{ from, to }` or `{ mean, deviation }`, and of lists each component by itself |
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneFile {
    #[serde(deserialize_with = "title")]
    pub(crate) title: String,
    /// A body of the library, or a Lagrangian in place of it and of the effects.
    pub(crate) body: Option<Body>,
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
    pub(crate) picture: SpherePicture,
    #[serde(default)]
    pub(crate) event: Vec<Event>,
    #[serde(default)]
    pub(crate) output: Output,
    #[serde(default, deserialize_with = "taken")]
    pub(crate) lagrangian: Option<Lagrangian>,
    #[serde(skip)]
    pub(crate) columns: Vec<Column>,
    /// Of the whole file: the scenes that a sweep makes have none.
    #[serde(skip)]
    pub(crate) sweep: Option<Sweep>,
    /// Of the whole file: the scenes that an ensemble draws have none.
    #[serde(skip)]
    pub(crate) ensemble: Option<SceneEnsemble>,
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
        &self.columns
    }

    /// The columns of a table behind the time, one for each number.
    pub(crate) fn listed(&self) -> Vec<recording::Column> {
        Column::listed(&self.columns, &[""]).into_iter().map(|(column, _)| column).collect()
    }

    /// The scenes that are drawn, if the file has a table `ensemble`.
    #[must_use]
    pub fn ensemble(&self) -> Option<&SceneEnsemble> {
        self.ensemble.as_ref()
    }

    /// Whether the step is chosen for an accuracy, by trial runs.
    #[must_use]
    pub fn asks_for_accuracy(&self) -> bool {
        matches!(self.run.pace, Pace::Accuracy(_))
    }

    /// How many steps the scene asks for; none where they are chosen for an accuracy.
    #[must_use]
    pub fn steps(&self) -> Option<u64> {
        match self.run.pace {
            Pace::Step { steps, .. } => Some(steps.into()),
            Pace::Accuracy(_) => None,
        }
    }

    /// The sum, and how it is stepped, in words.
    #[must_use]
    pub fn about(&self) -> String {
        let pace = match self.run.pace {
            Pace::Step { step, steps } => format!("{steps} steps of {} s", short(step)),
            Pace::Accuracy(tolerance) => format!("{} s to {tolerance:e}", short(self.run.duration)),
        };
        let sweep = self.sweep.as_ref().map(|sweep| format!(", a sweep of {}", sweep.points.len()));
        let ensemble = self.ensemble.as_ref().map(|ensemble| format!(", an ensemble of {}", ensemble.members));
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
        if self.lagrangian.is_some() {
            return "a Lagrangian of its own".to_owned();
        }
        self.effects().fold("body".to_owned(), |sum, name| format!("{sum} + {name}"))
    }

    /// The first force, by its name.
    pub(crate) fn force(&self) -> Option<&'static str> {
        let forces = ["drag", "magnetic damping", "torque", "thrust"];
        self.effects().find(|name| forces.contains(name))
    }

    /// The kinetic term of the library's body.
    pub(crate) fn kinetic(&self) -> Kinetic {
        self.body.map(|body| body.kinetic).unwrap_or_default()
    }

    /// Where the body is not turned; none of a Lagrangian that no body has.
    pub(crate) fn inertia(&self) -> Option<Matrix3<f64>> {
        let of_lagrangian = || self.lagrangian.as_ref().map(Lagrangian::inertia);
        self.body.map(|body| *body.inertia().as_matrix()).or_else(of_lagrangian)
    }

    /// Of the scene's own step: other effects are kicks of order two.
    pub(crate) fn order(&self) -> u32 {
        if self.effects().next().is_none() { self.kinetic().order() } else { 2 }
    }
}

/// The scenes of a sweep: one for each combination of its values, the last key fastest.
#[derive(Clone)]
#[non_exhaustive]
pub struct Sweep {
    /// What is varied, as `gravity.m`, in the order of the file.
    pub names: Vec<String>,
    /// The values of each, as the file has them, and the scene with them.
    pub points: Vec<(Vec<String>, SceneFile)>,
}
