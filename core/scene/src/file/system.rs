//! A system of several bodies, with the joints and springs between them.

use std::collections::BTreeSet;

use liestep::with::Scheme;
use nalgebra::Vector3;
use toml::Spanned;

use crate::file::column::Column;
use crate::file::effects::EffectEntry;
use crate::file::event::{Event, Quantity};
use crate::file::joint::{Joint, Limits, Number};
use crate::file::joint_kind::Kind;
use crate::file::mistake::SpanMessage;
use crate::file::orbit::put;
use crate::file::part::{Between, SystemBody};
use crate::file::quantity::round;
use crate::file::tables::Document;

/// Several bodies, with joints and springs between them.
///
/// | table | keys |
/// |---|---|
/// | | `title`, by default the name of the file |
/// | `[[body]]` | `name`; `m`, kg; one of `moments`, `J_d`, `J`, kg m², about the centre of mass, in the body's frame, where three zeros are those of a point mass; or a shape with its middle in the centre of mass, from which the inertia follows, with `m` or a `density`, kg/m³: a `box` by its edges, a `cylinder` or a `capsule` by the `radius` and the `length` of the cylinder and its `axis`, by default the third, a `sphere` by its `radius`, m; a shape beside an inertia is for the page alone; `kinetic`: `geodesic` by default, `rigid`, which is (3.13), or `cayley`; `position` of the centre of mass in space, m, and its velocity `moving`, m/s; `start` as for [one body](crate::SceneFile), where `relative_to` is the frame of attitude and angular velocity alone; without a position a body is placed by a joint with one that has a place; `dipole`, `rotor`, `drag`, `air_drag`, `torque`, `magnetic_damping`, the effects that turn [one body](crate::SceneFile), with the same keys, also along the orbit |
/// | `gravity` | `g`, m/s²; `up`, in space |
/// | `[[joint]]` | `name`, by which programs reach it, by default `joint-1` and so on; `kind`: `ball`, `pin`, `universal`, `cylinder`, `slider`, `weld`, `plane`, `distance`, see [`liestep::methods::Joint`]; `bodies`: two names, of which one may be `space`; `at`: a point of each, m, from the centre of mass in the body's frame, in `space` from the origin; `axes` where the kind has some: one in each of the same frames; `zero`: the attitude of the second body in the frame of the first at the angle zero, by default that of the least turn that makes the axes parallel; `length` of a distance, m |
/// | | where the joint starts, of a body without a `position`: `angle` and `rate` about the axis, `shift`, m, and `speed`, m/s, along it, of the second body relative to the first, zero by default |
/// | | in a joint that turns: `damping`, N m s; `stiffness`, N m/rad, with the angle at `rest`; a motor's `torque` about the axis, N m; dry `friction`: its `torque` and the rate `below` which it is viscous; the inertia of a motor's rotor behind its gear, `armature`, kg m². In a slider: `damping`, N s/m; `stiffness`, N/m, with the shift at `rest`; a `force`, N; dry `friction`: its `force`, N, and the speed `below` which it is viscous, m/s; `armature`, kg |
/// | | `limits` of a pin or a slider: `from` and `to`, angles or shifts, and whether the run is to `stop` where the joint passes one of them. They aren't imposed but watched: each passing is an event with the joint's name |
/// | `[[spring]]` | `bodies`, `at` as for joints; `k`, N/m, and the `length` at rest, m |
/// | numbers over time | as for [one body](crate::SceneFile): of `torque`, `force`, `stiffness`, `rest`, `damping` and `friction` in a joint, of a spring, of the effects on a body, and `g` |
/// | `orbit` | as for [one body](crate::SceneFile): the origin is a place that follows it, and the axes don't turn |
/// | `gravity_gradient` | as for [one body](crate::SceneFile): it pulls on the inertia of each body, and on its mass away from the origin |
/// | `[[wheel]]`, `[[control]]`, `[[pointing]]` | as for [one body](crate::SceneFile), with the name of their `body` |
/// | `[[event]]` | as for [one body](crate::SceneFile), with the name of its `body`; or with an `energy`, or a `column` of the table and its `value`: `upper_z`, `joint-1_angle` |
/// | `run` | `duration`; `step` or `accuracy` as for [one body](crate::SceneFile): the cheapest of the step and its compositions is chosen, also beside numbers over time, and with friction in joints a step; `method`: `step`, or a `composition` by its name, of systems without friction in joints; `nearest`: whether joints that are open at the start are closed: positions and their velocities are corrected first, then attitudes and angular velocities by as little as possible |
/// | `picture` | `plane`: `xy`, `xz`, `yz`; by default the plane in which the motion is the widest; `panels` as for [one body](crate::SceneFile), by default `turns` and `energy-error`, and the `axis` of `tilt` |
/// | `output` | `columns` that follow the time in a table, see [`Column`]; `every`: the number of steps from row to row |
/// | `sweep`, `ensemble` | as for [one body](crate::SceneFile): the key of a body, a joint, a spring or an event follows its name, `joint.elbow.damping`, `spring.spring-1.k`; an ensemble draws keys of `body`, `gravity`, `joint`, `spring`, `orbit`, `control`, `wheel` and `pointing` |
///
/// The error of an `accuracy` is the largest one among the bodies' attitudes with their angular velocities and their places with their
/// velocities, these also relative to the mean of all, by [`Accuracy`](liestep::accuracy::Accuracy). Places count relative to the
/// largest length of the system: radii of gyration, points of joints and springs, rods.
///
/// Joints may form loops. Other effects on several bodies need a program: [`liestep::methods::Multibody`].
#[derive(Clone)]
pub struct System {
    pub(crate) bodies: Vec<SystemBody>,
    pub(crate) gravity: Option<(f64, Vector3<f64>)>,
    pub(crate) joints: Vec<Between<Joint>>,
    pub(crate) joint_names: Vec<String>,
    pub(crate) springs: Vec<Between<Spring>>,
    /// Whether forces and torques of joints are asked for, by a column or by an event.
    pub(crate) has_reactions: bool,
    pub(crate) places: SystemPlaces,
}

/// Lines and columns of tables, from one.
#[derive(Clone)]
pub(crate) struct SystemPlaces {
    pub(crate) bodies: Vec<(usize, usize)>,
    pub(crate) joints: Vec<(usize, usize)>,
    pub(crate) springs: Vec<(usize, usize)>,
}

/// A spring between two points, from their centres of mass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Spring {
    pub(crate) k: f64,
    pub(crate) length: f64,
    pub(crate) at: [Vector3<f64>; 2],
}

impl Spring {
    /// Sets a value over time; returns whether it can have this number. A stiffness of zero is no spring.
    fn put(&mut self, key: &str, number: f64) -> bool {
        match key {
            "k" => put(Some(&mut self.k), Some(number).filter(|k| *k >= 0.0)),
            "length" => put(Some(&mut self.length), Some(number)),
            _ => false,
        }
    }
}

impl System {
    /// Sets a value over time by its table, the number among several, and the key; returns whether it can have these numbers.
    pub(crate) fn put(&mut self, (table, at, key): (&str, usize, &str), numbers: &[f64]) -> bool {
        let Some(&number) = numbers.first() else { return false };
        let is_one = numbers.len() == 1;
        match table {
            "gravity" => put(self.gravity.as_mut().filter(|_| key == "g" && is_one).map(|(g, _)| g), Some(number)),
            "spring" => self.springs.get_mut(at).is_some_and(|spring| is_one && spring.of.put(key, number)),
            "joint" => self.joints.get_mut(at).is_some_and(|joint| is_one && joint.of.put(key, number)),
            _ => self.bodies.get_mut(at).is_some_and(|body| body.put(key, numbers)),
        }
    }

    /// The names of the bodies.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.bodies.iter().map(|body| body.name.as_str())
    }

    /// The names of the joints, with their kinds.
    pub(crate) fn kinds(&self) -> Vec<(&str, Kind)> {
        self.joint_names.iter().zip(&self.joints).map(|(name, joint)| (name.as_str(), joint.of.kind)).collect()
    }

    /// The numbers of the joints with limits, and the limits.
    pub(crate) fn limited(&self) -> impl Iterator<Item = (usize, Limits)> {
        self.joints.iter().enumerate().filter_map(|(number, joint)| Some((number, joint.of.limits?)))
    }

    /// The largest length of the system's own, m, in which its places and their rounding errors are counted: radii of gyration, points
    /// of joints and springs from their bodies, rods, springs, and shifts at the start; none where all these are zero.
    pub(crate) fn length(&self) -> Option<f64> {
        let radius = |body: &SystemBody| body.J.as_ref().map(|J| (J.as_matrix().trace() / (2.0 * body.m)).sqrt());
        let arm = |(body, at): (Option<usize>, Vector3<f64>)| body.map_or(0.0, |_| at.norm());
        let of_joint = |Between { bodies, of }: &Between<Joint>| {
            let [one, other] = [0, 1].map(|side| arm((bodies[side], of.at[side])));
            [one, other, of.length, of.number(Number::Shift).unwrap_or(0.0).abs()]
        };
        let of_spring = |Between { bodies, of }: &Between<Spring>| {
            let [one, other] = [0, 1].map(|side| arm((bodies[side], of.at[side])));
            [one, other, of.length]
        };
        let of_joints = self.joints.iter().flat_map(of_joint);
        let all = self.bodies.iter().filter_map(radius).chain(of_joints).chain(self.springs.iter().flat_map(of_spring));
        let largest = all.fold(0.0, f64::max);
        (largest > 0.0).then_some(largest)
    }

    /// This length, 1 m where there is none.
    pub(crate) fn size(&self) -> f64 {
        self.length().unwrap_or(1.0)
    }

    /// The place of the first number of a sample that is one of joints.
    pub(crate) fn joint_columns(&self) -> usize {
        13 * self.bodies.len() + 8
    }

    /// Whether some of all columns, or events, need forces or torques of joints.
    pub(crate) fn asks_for_reactions(all: &[Column], columns: &[Column], events: &[Event]) -> bool {
        let is_reaction = |column: &&Column| ["force", "torque"].contains(&column.key());
        let is_seen = |event: &Event| {
            let Quantity::Column(place, _) = event.quantity else { return false };
            all.iter().filter(is_reaction).filter_map(Column::part).any(|part| part.contains(&place))
        };
        columns.iter().any(|column| is_reaction(&column)) || events.iter().any(is_seen)
    }

    /// The effects on bodies.
    pub(crate) fn effects(&self) -> impl Iterator<Item = &'static EffectEntry> {
        self.bodies.iter().flat_map(|body| &body.effects).map(|(entry, _)| *entry)
    }

    /// The reason against steps back, which turn friction in a joint into its opposite.
    pub(crate) fn one_way(&self) -> Option<String> {
        let has_friction = |joint: &Between<Joint>| joint.of.has(&[Number::Damping, Number::Friction]);
        let joint = self.joints.iter().position(has_friction)?;
        Some(format!(
            "a composition has steps back, in which friction adds energy, and `{}` has some: leave one of both out",
            self.joint_names[joint]
        ))
    }

    /// Whether gaps of joints are cosines in part.
    pub(crate) fn has_cosines(&self) -> bool {
        self.joints.iter().any(|joint| joint.of.kind.has_cosines())
    }

    /// The number of bodies, and what acts on them and between them, in words.
    pub(crate) fn terms(&self) -> Vec<String> {
        let counted = |count: usize, [one, several]: [&str; 2]| match count {
            0 => None,
            1 => Some(format!("1 {one}")),
            count => Some(format!("{count} {several}")),
        };
        let mut effects: Vec<_> = self.effects().map(|effect| effect.name(" ")).collect();
        effects.sort_unstable();
        effects.dedup();
        let gravity = self.gravity.map(|_| "gravity".to_owned());
        let parts =
            [counted(self.joints.len(), ["joint", "joints"]), counted(self.springs.len(), ["spring", "springs"])];
        let bodies = [counted(self.bodies.len(), ["body", "bodies"]), gravity].into_iter().flatten();
        bodies.chain(effects).chain(parts.into_iter().flatten()).collect()
    }

    /// The angles by which the bodies turn in a step of this length, s, at the start, approximately.
    pub(crate) fn turns(&self, step: f64) -> String {
        let turn = |body: &SystemBody| format!("{} ({})", round(step * body.start.velocity.norm()), body.name);
        format!(", hΩ in rad: {}", self.bodies.iter().map(turn).collect::<Vec<_>>().join(", "))
    }

    /// The reason why the system can't have a method.
    pub(crate) fn of_method(&self, method: &Scheme) -> Option<String> {
        match method {
            Scheme::Step => None,
            Scheme::Composition(composition) if composition.base() != 2 => {
                let (name, base) = (composition.name(), composition.base());
                Some(format!("{name} composes a step of order {base}, and that of several bodies is of order 2"))
            }
            Scheme::Composition(_) => self.one_way(),
            _ => Some("several bodies have their own step, or a `composition` of it".to_owned()),
        }
    }

    /// Checks that columns have names of their own.
    pub(crate) fn check_columns(&self, document: &Document<'_>, columns: &[Column]) -> Result<(), SpanMessage> {
        let mut taken = BTreeSet::new();
        let twice =
            Column::listed(columns).into_iter().map(|column| column.name).find(|name| !taken.insert(name.clone()));
        let Some(name) = twice else { return Ok(()) };
        let owns = |owner: &str| name.strip_prefix(owner).is_some_and(|rest| rest.starts_with('_'));
        let tables = document.get_ref().get("body").and_then(|bodies| bodies.get_ref().as_array());
        let body = self.names().zip(tables.into_iter().flatten()).filter(|(body, _)| owns(body)).last();
        let place = body.and_then(|(_, table)| table.get_ref().get("name")).map(Spanned::span);
        let owner = if place.is_some() { "body" } else { "joint" };
        let message = format!("two columns of the table would be called `{name}`: give the {owner} another name");
        Err((place.unwrap_or(0..0), message))
    }
}
