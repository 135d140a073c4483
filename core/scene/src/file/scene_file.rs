//! The file of a scene: one body, or several of them, with all that both have.

use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;

use liestep_late::{Declaration, LateError};
use nalgebra::Matrix3;
use serde::Deserialize;
use toml::Spanned;
use toml::de::{DeValue, Error, ValueDeserializer};

use crate::file::beginning::Beginning;
use crate::file::body::{Body, Kinetic};
use crate::file::column::{Column, Output};
use crate::file::control::{self, Control, Wheel};
use crate::file::effects::{self, EFFECTS, EffectEntry, Table, effects};
use crate::file::event::Event;
use crate::file::group::Group;
use crate::file::kepler::Orbit;
use crate::file::lagrangian::{DeclaredTerm, taken};
use crate::file::mistake::SpanMessage;
use crate::file::orbit::{Time, put};
use crate::file::over_time::OverTime;
use crate::file::parameter::in_value;
use crate::file::picture::Picture;
use crate::file::pointing::Pointing;
use crate::file::quantity::{Rate, in_si, round};
use crate::file::schedule::{Pace, Schedule};
use crate::file::system::System;
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
        #[derive(Clone, Default, Deserialize)]
        #[serde(deny_unknown_fields)]
        pub struct SceneFile {
            $($fields)+
            $(pub(crate) $name: Option<effects::$table>,)+
        }

        impl SceneFile {
            /// The effects of the scene.
            pub(crate) fn effects(&self) -> impl Iterator<Item = (&'static EffectEntry, &dyn Table)> {
                let tables = [$(self.$name.as_ref().map(|table| table as &dyn Table)),+];
                EFFECTS.iter().zip(tables).filter_map(|(effect, table)| Some((effect, table?)))
            }

            /// Sets a component of the value of these keys to a number with a unit, see
            /// [`Parameter::put`](crate::file::orbit::Parameter::put). The keys belong to an effect, or to the velocity
            /// of the start.
            pub(crate) fn put(&mut self, [name, key]: [&str; 2], component: usize, number: f64, unit: &str) -> bool {
                match name {
                    "start" if key == "velocity" && self.group.is_rotation() && self.start.is_in_space() => {
                        put(self.start.velocity.get_mut(component), in_si::<Rate>(number, unit))
                    }
                    $(stringify!($name) => {
                        self.$name.as_mut().is_some_and(|table| table.put((key, component), number, unit))
                    })+
                    _ => false,
                }
            }

            /// Replaces the body, the orbit, the start or an effect by one read from a table; other names are ignored.
            pub(crate) fn set(&mut self, name: &str, value: &Spanned<DeValue<'_>>) -> Result<(), SpanMessage> {
                let table = || ValueDeserializer::from(value.clone());
                let wrong = |error: Error| in_value(value, &error);
                match name {
                    "body" => self.body = Some(Body::deserialize(table()).map_err(wrong)?),
                    "start" => self.start = Beginning::read(value, &self.group, self.orbit.as_ref())?,
                    "orbit" => self.orbit = Some(Orbit::deserialize(table()).map_err(wrong)?),
                    $(stringify!($name) => self.$name = Some(effects::$table::deserialize(table()).map_err(wrong)?),)+
                    _ => {}
                }
                Ok(())
            }
        }
    };
}

effects! { scene_file
    #[serde(default, deserialize_with = "title")]
    pub(crate) title: String,
    /// A body of the library; none with a Lagrangian that has the kinetic energy.
    pub(crate) body: Option<Body>,
    pub(crate) start: Beginning,
    pub(crate) run: Schedule,
    pub(crate) orbit: Option<Orbit>,
    #[serde(default)]
    pub(crate) pointing: Vec<Pointing>,
    #[serde(default)]
    pub(crate) picture: Picture,
    #[serde(default)]
    pub(crate) event: Vec<Event>,
    #[serde(default)]
    pub(crate) output: Output,
    #[serde(default, deserialize_with = "taken")]
    pub(crate) lagrangian: Vec<DeclaredTerm>,
    #[serde(default, deserialize_with = "taken")]
    pub(crate) hamiltonian: Vec<DeclaredTerm>,
    #[serde(default, deserialize_with = "taken")]
    pub(crate) force: Vec<DeclaredTerm>,
    #[serde(default, deserialize_with = "taken")]
    pub(crate) nonholonomic: Vec<DeclaredTerm>,
    #[serde(default, deserialize_with = "control::taken")]
    pub(crate) control: Vec<Control>,
    #[serde(default, deserialize_with = "control::taken")]
    pub(crate) wheel: Vec<Wheel>,
    /// Several bodies in the place of one.
    #[serde(skip)]
    pub(crate) system: Option<Arc<System>>,
    /// The group of the scene; of several bodies that of each.
    #[serde(skip)]
    pub(crate) group: Group,
    /// The sum of all terms where the file has the kinetic energy itself.
    #[serde(skip)]
    pub(crate) sum: Option<&'static Declaration>,
    /// The parameters that change with time, but for those of the library's effects along the orbit.
    #[serde(skip)]
    pub(crate) over_time: Arc<[OverTime]>,
    #[serde(skip)]
    pub(crate) columns: Vec<Column>,
    #[serde(skip)]
    pub(crate) origin: Origin,
}

/// The origin of a scene, for messages about its run.
#[derive(Clone, Default)]
pub(crate) struct Origin {
    pub(crate) path: PathBuf,
    pub(crate) places: Places,
    /// A remark about the file, with its line and column.
    pub(crate) note: Option<((usize, usize), String)>,
}

/// Lines and columns of keys, from one.
#[derive(Clone, Copy, Default)]
pub(crate) struct Places {
    pub(crate) body: (usize, usize),
    pub(crate) start: (usize, usize),
    pub(crate) attitude: (usize, usize),
    /// Place of the step or the accuracy.
    pub(crate) pace: (usize, usize),
    pub(crate) method: (usize, usize),
    pub(crate) spring: (usize, usize),
    /// Place of the first law that reads an attitude without saying relative to what.
    pub(crate) law: (usize, usize),
}

impl SceneFile {
    /// The Lagrangian with a pace.
    pub(crate) fn paced(&self) -> Option<&DeclaredTerm> {
        self.lagrangian.iter().find(|own| own.has_a_pace)
    }

    /// The angle by which the body turns in an equal step at the start, approximately, rad.
    pub(crate) fn turn_of_a_step(&self) -> Option<f64> {
        match self.run.pace {
            Pace::Step { step, .. } if !self.has_steps_of_its_own() && self.group.is_rotation() => {
                Some(step * self.start.rate()?.norm())
            }
            _ => None,
        }
    }

    /// The terms of the file's own.
    pub(crate) fn own(&self) -> impl Iterator<Item = &DeclaredTerm> {
        let [before, behind] = self.around();
        before.chain(behind)
    }

    /// The terms of the file's own, those before the effects in a sum and those behind.
    pub(crate) fn around(&self) -> [impl Iterator<Item = &DeclaredTerm>; 2] {
        [self.lagrangian.iter().chain(&self.hamiltonian), self.force.iter().chain(&self.nonholonomic)]
    }

    /// The sum of a body's text, if any, and of the file's Lagrangians, effects, forces and constraints, or its Hamiltonian, which is
    /// derived once per process; none of nothing.
    pub(crate) fn declared(&self, body: Option<&str>) -> Result<Option<&'static Declaration>, LateError> {
        let body = body.map(Declaration::parse).into_iter();
        let [before, behind] = self.around().map(|own| own.map(|own| Ok(own.declaration)));
        let listed = self.effects().map(|(effect, _)| Declaration::parse(effect.derived.1));
        let terms = body.chain(before).chain(listed).chain(behind).collect::<Result<Vec<_>, _>>()?;
        if terms.is_empty() { Ok(None) } else { Declaration::sum(&terms).map(Some) }
    }

    /// The name of the first force.
    pub(crate) fn first_force(&self) -> Option<String> {
        let listed = self.effects().find(|(effect, _)| effect.does_work()).map(|(effect, _)| effect.name(" "));
        listed.or_else(|| self.force.first().map(|_| "`force`".to_owned()))
    }

    /// The parameters that follow the orbit: their tables and keys.
    pub(crate) fn turning(&self) -> impl Iterator<Item = [&str; 2]> {
        let own = self.over_time.iter().filter(|one| one.is_on_orbit()).map(|one| [&*one.table, &*one.key]);
        let bodies = self.system.iter().flat_map(|system| &system.bodies).flat_map(|body| &body.effects);
        let of_bodies = bodies.filter_map(|(effect, table)| Some([effect.key, table.on_orbit()?]));
        self.effects().filter_map(|(effect, table)| Some([effect.key, table.on_orbit()?])).chain(of_bodies).chain(own)
    }

    /// Whether laws or wheels turn the body.
    pub(crate) fn has_devices(&self) -> bool {
        !self.control.is_empty() || !self.wheel.is_empty()
    }

    /// The place of a law that reads the attitude in space where the start is relative to the local vertical.
    pub(crate) fn law_of_no_frame(&self) -> Option<&Range<usize>> {
        control::of_no_frame(&self.control, &self.wheel).filter(|_| self.start.is_relative)
    }

    /// A time, s, with the orbit.
    pub(crate) const fn at(&self, time: f64) -> Time<'_> {
        Time { time, orbit: self.orbit.as_ref() }
    }

    /// The first term that changes with time, by its table; none in a scene without any.
    pub(crate) fn changing(&self) -> Option<String> {
        let turning = self.turning().next().map(|[effect, _]| effect.replace('_', " "));
        turning.or_else(|| self.over_time.first().map(OverTime::subject))
    }

    /// Whether each step has numbers of its own: by laws, wheels, or what changes with time.
    pub(crate) fn is_driven(&self) -> bool {
        self.has_devices() || self.changing().is_some()
    }

    /// Sets all parameters over time to their means over a step of this start and length, s; at a time by the length 0.
    /// Returns whether each has a value.
    pub(crate) fn set_over(&mut self, span: [f64; 2]) -> bool {
        let all = Arc::clone(&self.over_time);
        all.iter().all(|one| self.set_one(one, &one.numbers(span)))
    }

    /// Sets a parameter over time to these numbers; returns whether it can have them.
    pub(crate) fn set_one(&mut self, one: &OverTime, numbers: &[f64]) -> bool {
        let own = match one.table.as_str() {
            "lagrangian" => &mut self.lagrangian,
            "hamiltonian" => &mut self.hamiltonian,
            "force" => &mut self.force,
            "nonholonomic" => &mut self.nonholonomic,
            "body" if self.system.is_none() => {
                return self.body.as_mut().is_some_and(|body| body.put(&one.key, numbers));
            }
            table => {
                // The gradient of several bodies is a table of the file, as that of one.
                let system = self.system.as_mut().filter(|_| table != "gravity_gradient").map(Arc::make_mut);
                if let Some(system) = system {
                    let place = (table, one.number, one.key.as_str());
                    return system.put(place, numbers);
                }
                return numbers.iter().enumerate().all(|(at, &number)| self.put([table, &one.key], at, number, ""));
            }
        };
        let Some(own) = own.get_mut(one.number) else { return false };
        numbers.iter().all(|number| number.is_finite())
            && own.declaration.set(&mut own.numbers, &one.key, numbers).is_ok()
    }

    /// The kinetic term of the library's body.
    pub(crate) fn kinetic(&self) -> Kinetic {
        self.body.map(|body| body.kinetic).unwrap_or_default()
    }

    /// The inertia at the identity attitude; none for a Lagrangian that isn't of a body.
    pub(crate) fn inertia(&self) -> Option<Matrix3<f64>> {
        let own = self.lagrangian.iter().filter(|own| own.declaration.has_kinetic && self.group.is_rotation());
        let of_lagrangian = || own.filter_map(DeclaredTerm::inertia).reduce(|sum, own| sum + own);
        self.body.map(|body| *body.J.as_matrix()).or_else(of_lagrangian)
    }

    /// Order of the scene's own step; effects are kicks of second order.
    pub(crate) fn own_order(&self) -> u32 {
        let is_free = self.effects().next().is_none() && self.own().next().is_none() && !self.has_devices();
        if is_free { self.kinetic().order() } else { 2 }
    }

    /// Whether the steps have different lengths.
    pub(crate) fn has_steps_of_its_own(&self) -> bool {
        let is_varied = self.run.steps_per_orbit.is_some() || self.run.density.is_some();
        is_varied || self.paced().is_some()
    }

    /// The names of the events, those of joints with limits after those of the file.
    pub(crate) fn event_names(&self) -> Vec<&str> {
        let of_joints = self.system.iter().flat_map(|system| {
            system.limited().filter_map(|(joint, _)| system.joint_names.get(joint).map(String::as_str))
        });
        self.event.iter().map(|event| event.name.as_str()).chain(of_joints).collect()
    }

    /// The scene without events and columns.
    pub(crate) fn unwatched(mut self) -> Self {
        self.event.clear();
        self.columns.clear();
        if let Some(system) = self.system.as_mut().map(Arc::make_mut) {
            system.joints.iter_mut().for_each(|joint| joint.of.limits = None);
            system.has_reactions = false;
        }
        self
    }

    /// A description of the terms, in words.
    pub(crate) fn sum(&self) -> String {
        let counted = |count: usize, one: &str| match count {
            0 => None,
            1 => Some(format!("a {one}")),
            count => Some(format!("{count} {one}s")),
        };
        let own = |all: &[DeclaredTerm], kind: &str| vec![format!("a {kind} of its own"); all.len()];
        let bodies = self.system.iter().flat_map(|system| system.terms());
        let body = self.body.iter().map(|_| "body".to_owned());
        let effects = self.effects().map(|(effect, _)| effect.name(" "));
        let terms =
            bodies.chain(body).chain(own(&self.lagrangian, "Lagrangian")).chain(own(&self.hamiltonian, "Hamiltonian"));
        let terms = terms.chain(effects).chain(own(&self.force, "force")).chain(own(&self.nonholonomic, "constraint"));
        let laws = vec!["a law".to_owned(); self.control.len()];
        terms.chain(laws).chain(counted(self.wheel.len(), "wheel")).collect::<Vec<_>>().join(" + ")
    }

    /// A description of the terms and the steps, in words.
    pub(crate) fn about(&self) -> String {
        let turn = match &self.system {
            Some(system) => self.run.step().map(|step| system.turns(step)),
            None => self.turn_of_a_step().map(|turn| format!(", hΩ = {} rad", round(turn))),
        };
        let steps = self.run.about(self.has_steps_of_its_own());
        format!("{}, {steps}{}", self.sum(), turn.unwrap_or_default())
    }
}
