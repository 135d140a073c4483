//! The file of a scene with one body.

use std::path::PathBuf;

use liestep::recording;
use nalgebra::Matrix3;
use serde::Deserialize;
use toml::de::{Error, ValueDeserializer};

use crate::file::body::{Body, Kinetic};
use crate::file::column::{Column, Output};
use crate::file::draws::SceneEnsemble;
use crate::file::effects::{self, EFFECTS, Listed, Table, effects};
use crate::file::event::Event;
use crate::file::lagrangian::{Declared, taken};
use crate::file::orbit::{Orbit, put};
use crate::file::picture::SpherePicture;
use crate::file::quantity::{Rate, in_si, round, short};
use crate::file::schedule::{Pace, Schedule};
use crate::file::start::Start;
use crate::file::text::title;

/// Defines the type, with a field and a row of its documentation for each effect.
macro_rules! scene_file {
    (
        { $($fields:tt)+ }
        $($name:ident: $table:ident { $($key:ident: $type:ty),+ } => |$($of:tt),+| -> $effect:ty $value:block)+
    ) => {
        #[doc = include_str!("scene.md")]
        ///
        /// | effect | parameters |
        /// |---|---|
        $(#[doc = concat!("| `", stringify!($name), "` |", $(" `", stringify!($key), ": ", stringify!($type), "`"),+, " |")])+
        #[derive(Clone, Deserialize)]
        #[serde(deny_unknown_fields)]
        pub struct SceneFile {
            $($fields)+
            $(pub(crate) $name: Option<effects::$table>,)+
        }

        impl SceneFile {
            /// The effects of the scene.
            pub(crate) fn effects(&self) -> impl Iterator<Item = (&'static Listed, &dyn Table)> {
                let tables = [$(self.$name.as_ref().map(|table| table as &dyn Table)),+];
                EFFECTS.iter().zip(tables).filter_map(|(effect, table)| Some((effect, table?)))
            }

            /// Sets a component of the value of these keys to a number with a unit, see
            /// [`Parameter::put`](crate::file::orbit::Parameter::put). The keys belong to an effect, or to the velocity
            /// of the start.
            pub(crate) fn put(&mut self, [name, key]: [&str; 2], component: usize, number: f64, unit: &str) -> bool {
                match name {
                    "start" if key == "velocity" => {
                        put(self.start.velocity.get_mut(component), in_si::<Rate>(number, unit))
                    }
                    $(stringify!($name) => {
                        self.$name.as_mut().is_some_and(|table| table.put((key, component), number, unit))
                    })+
                    _ => false,
                }
            }

            /// Replaces the body, the start or an effect by one read from a table; other names are ignored.
            pub(crate) fn set(&mut self, name: &str, table: ValueDeserializer<'_>) -> Result<(), Error> {
                match name {
                    "body" => self.body = Some(Body::deserialize(table)?),
                    "start" => self.start = Start::deserialize(table)?,
                    $(stringify!($name) => self.$name = Some(effects::$table::deserialize(table)?),)+
                    _ => {}
                }
                Ok(())
            }
        }
    };
}

effects! { scene_file
    #[serde(deserialize_with = "title")]
    pub(crate) title: String,
    /// A body of the library; none with a Lagrangian, which replaces it and the effects.
    pub(crate) body: Option<Body>,
    pub(crate) start: Start,
    pub(crate) run: Schedule,
    #[serde(default)]
    pub(crate) picture: SpherePicture,
    #[serde(default)]
    pub(crate) event: Vec<Event>,
    #[serde(default)]
    pub(crate) output: Output,
    #[serde(default, deserialize_with = "taken")]
    pub(crate) lagrangian: Option<Declared>,
    #[serde(default, deserialize_with = "taken")]
    pub(crate) force: Option<Declared>,
    #[serde(skip)]
    pub(crate) columns: Vec<Column>,
    /// The sweep of the file; none in the scenes that a sweep generates.
    #[serde(skip)]
    pub(crate) sweep: Option<Sweep>,
    /// The ensemble of the file; none in the scenes that an ensemble draws.
    #[serde(skip)]
    pub(crate) ensemble: Option<SceneEnsemble>,
    #[serde(skip)]
    pub(crate) origin: Origin,
}

/// The origin of a scene, for messages about its run.
#[derive(Clone, Default)]
pub(crate) struct Origin {
    pub(crate) path: PathBuf,
    pub(crate) places: Places,
}

/// Lines and columns of keys, from one.
#[derive(Clone, Copy, Default)]
pub(crate) struct Places {
    pub(crate) body: (usize, usize),
    pub(crate) start: (usize, usize),
    /// Place of the step or the accuracy.
    pub(crate) pace: (usize, usize),
    pub(crate) method: (usize, usize),
    pub(crate) spring: (usize, usize),
}

impl SceneFile {
    /// The title of the scene.
    #[must_use]
    pub fn title(&self) -> &str {
        &self.title
    }

    /// The sweep over scenes, if the file has a table `sweep`.
    #[must_use]
    pub fn sweep(&self) -> Option<&Sweep> {
        self.sweep.as_ref()
    }

    /// The names of the events to be detected.
    pub fn events(&self) -> impl Iterator<Item = &str> {
        self.event.iter().map(|event| event.name.as_str())
    }

    /// The columns that follow the time in a table of the run.
    #[must_use]
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// The columns that follow the time in a table, one for each number.
    pub(crate) fn listed(&self) -> Vec<recording::Column> {
        Column::listed(&self.columns, &[""]).into_iter().map(|(column, _)| column).collect()
    }

    /// The ensemble of scenes, if the file has a table `ensemble`.
    #[must_use]
    pub fn ensemble(&self) -> Option<&SceneEnsemble> {
        self.ensemble.as_ref()
    }

    /// Whether the step is chosen by trial runs, for an accuracy.
    #[must_use]
    pub fn asks_for_accuracy(&self) -> bool {
        matches!(self.run.pace, Pace::Accuracy(_))
    }

    /// Whether the steps have different lengths.
    pub(crate) fn has_steps_of_its_own(&self) -> bool {
        let is_varied = self.run.steps_per_orbit.is_some() || self.run.density.is_some();
        is_varied || self.lagrangian.as_ref().is_some_and(|own| own.has_a_pace)
    }

    /// The number of steps; none where they are chosen for an accuracy.
    #[must_use]
    pub fn steps(&self) -> Option<u64> {
        match self.run.pace {
            Pace::Step { steps, .. } => Some(steps.into()),
            Pace::Accuracy(_) => None,
        }
    }

    /// The angle by which the body turns in an equal step at the start, approximately, rad.
    pub(crate) fn turn_of_a_step(&self) -> Option<f64> {
        match self.run.pace {
            Pace::Step { step, .. } if !self.has_steps_of_its_own() => Some(step * self.start.velocity.norm()),
            _ => None,
        }
    }

    /// A description of the terms and the steps, in words.
    #[must_use]
    pub fn about(&self) -> String {
        let pace = match self.run.pace {
            Pace::Step { step, .. } if self.has_steps_of_its_own() => {
                format!("{} s by steps of {} s on the average", short(self.run.duration), short(step))
            }
            Pace::Step { step, steps } => format!("{steps} steps of {} s", short(step)),
            Pace::Accuracy(tolerance) => format!("{} s to {tolerance:e}", short(self.run.duration)),
        };
        let sweep = self.sweep.as_ref().map(|sweep| format!(", a sweep of {}", sweep.points.len()));
        let ensemble = self.ensemble.as_ref().map(|ensemble| format!(", an ensemble of {}", ensemble.members));
        let turn = self.turn_of_a_step().map(|turn| format!(", hΩ = {} rad", round(turn))).unwrap_or_default();
        format!("{}, {pace}{turn}{}{}", self.sum(), sweep.unwrap_or_default(), ensemble.unwrap_or_default())
    }

    /// A description of the terms, in words.
    pub(crate) fn sum(&self) -> String {
        let first = if self.lagrangian.is_some() { "a Lagrangian of its own" } else { "body" };
        let effects = self.effects().map(|(effect, _)| effect.name(" "));
        let force = self.force.as_ref().map(|_| "a force of its own".to_owned());
        effects.chain(force).fold(first.to_owned(), |sum, effect| format!("{sum} + {effect}"))
    }

    /// The name of the first force.
    pub(crate) fn first_force(&self) -> Option<String> {
        let listed = self.effects().find(|(effect, _)| effect.does_work()).map(|(effect, _)| effect.name(" "));
        listed.or_else(|| self.force.as_ref().map(|_| "`force`".to_owned()))
    }

    /// The effects that vary along an orbit: the keys that lead to their orbits, and the orbits.
    pub(crate) fn turning(&self) -> impl Iterator<Item = ([&'static str; 3], &Orbit)> {
        self.effects()
            .filter_map(|(effect, table)| table.orbit().map(|(key, orbit)| ([effect.key, key, "orbit"], orbit)))
    }

    /// The kinetic term of the library's body.
    pub(crate) fn kinetic(&self) -> Kinetic {
        self.body.map(|body| body.kinetic).unwrap_or_default()
    }

    /// The inertia at the identity attitude; none for a Lagrangian that isn't of a body.
    pub(crate) fn inertia(&self) -> Option<Matrix3<f64>> {
        let of_lagrangian = || self.lagrangian.as_ref().and_then(Declared::inertia);
        self.body.map(|body| *body.J.as_matrix()).or_else(of_lagrangian)
    }

    /// Order of the scene's own step; effects are kicks of second order.
    pub(crate) fn order(&self) -> u32 {
        if self.effects().next().is_none() && self.force.is_none() { self.kinetic().order() } else { 2 }
    }
}

/// The scenes of a sweep: one for each combination of its values. The last key varies fastest.
#[derive(Clone)]
#[non_exhaustive]
pub struct Sweep {
    /// The varied keys, such as `gravity.m`, in the order of the file.
    pub names: Vec<String>,
    /// Each scene, with the texts of its varied values.
    pub points: Vec<(Vec<String>, SceneFile)>,
}
