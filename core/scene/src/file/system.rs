//! The file of a system of several bodies.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use liestep::with::Scheme;
use nalgebra::Vector3;
use serde::Deserialize;
use toml::Spanned;
use toml::de::Deserializer;

use crate::file::column::{Column, Output};
use crate::file::common::Parts;
use crate::file::effects::EffectEntry;
use crate::file::event::{Event, Quantity};
use crate::file::joint::{Joint, JointTable, Limits, Names};
use crate::file::mistake::{Lines, Mistake, SpanMessage, advised};
use crate::file::part::{Between, BodyTable, SPACE, SystemBody};
use crate::file::picture::PlanePicture;
use crate::file::placed::place;
use crate::file::quantity::{Acceleration, Direction, Length, PositiveScalar, Scalar, Stiffness, Triple, round};
use crate::file::schedule::Schedule;
use crate::file::tables::{Document, has, span};
use crate::file::text::{check_name, or_name, title};

/// Several bodies, with joints and springs between them.
///
/// | table | keys |
/// |---|---|
/// | | `title`, by default the name of the file |
/// | `[[body]]` | `name`; `m`, kg; one of `moments`, `J_d`, `J`, kg m², about the centre of mass, in the body's frame, where three zeros are those of a point mass; or a shape with its middle in the centre of mass, from which the inertia follows, with `m` or a `density`, kg/m³: a `box` by its edges, a `cylinder` or a `capsule` by the `radius` and the `length` of the cylinder and its `axis`, by default the third, a `sphere` by its `radius`, m; a shape beside an inertia is for the page alone; `kinetic`: `geodesic` by default, `rigid`, which is (3.13), or `cayley`; `position` of the centre of mass in space, m, and its velocity `moving`, m/s; `start` as for [one body](crate::SceneFile); without a position a body is placed by a joint with one that has a place; `dipole`, `rotor`, `drag`, `torque`, `magnetic_damping`, the effects that turn [one body](crate::SceneFile), with the same keys |
/// | `gravity` | `g`, m/s²; `up`, in space |
/// | `[[joint]]` | `name`, by which programs reach it, by default `joint-1` and so on; `kind`: `ball`, `pin`, `universal`, `cylinder`, `slider`, `weld`, `plane`, `distance`, see [`liestep::methods::Joint`]; `bodies`: two names, of which one may be `space`; `at`: a point of each, m, from the centre of mass in the body's frame, in `space` from the origin; `axes` where the kind has some: one in each of the same frames; `zero`: the attitude of the second body in the frame of the first at the angle zero, by default that of the least turn that makes the axes parallel; `length` of a distance, m |
/// | | where the joint starts, of a body without a `position`: `angle` and `rate` about the axis, `shift`, m, and `speed`, m/s, along it, of the second body relative to the first, zero by default |
/// | | in a joint that turns: `damping`, N m s; `stiffness`, N m/rad, with the angle at `rest`; a motor's `torque` about the axis, N m; dry `friction`: its `torque` and the rate `below` which it is viscous. In a slider: `damping`, N s/m; `stiffness`, N/m, with the shift at `rest`; a `force`, N |
/// | | `limits` of a pin or a slider: `from` and `to`, angles or shifts, and whether the run is to `stop` where the joint passes one of them. They aren't imposed but watched: each passing is an event with the joint's name |
/// | `[[spring]]` | `bodies`, `at` as for joints; `k`, N/m, and the `length` at rest, m |
/// | `[[event]]` | as for [one body](crate::SceneFile), with an `energy`, or a `column` of the table and its `value`: `upper_z`, `joint-1_angle` |
/// | `run` | `duration`; `step` or `accuracy` as for [one body](crate::SceneFile): without friction the cheapest of the step and its compositions is chosen, and with friction a step; `method`: `step`, or a `composition` by its name, of systems without friction; `nearest`: whether joints that are open at the start are closed: positions and their velocities are corrected first, then attitudes and angular velocities by as little as possible |
/// | `picture` | `plane`: `xy`, `xz`, `yz`; by default the plane in which the motion is the widest |
/// | `output` | `columns` that follow the time in a table, see [`Column`]; `every`: the number of steps from row to row |
/// | `sweep`, `ensemble` | as for [one body](crate::SceneFile): the key of a body, a joint, a spring or an event follows its name, `joint.elbow.damping`, `spring.spring-1.k`; an ensemble draws keys of `body`, `gravity`, `joint` and `spring` |
///
/// The error of an `accuracy` is that of the attitudes and places of all bodies together, relative to their size, and of their
/// velocities relative to the largest: turns in rad count as places in m, so that it is one for bodies of about a metre.
///
/// Joints may form loops. Other effects on several bodies need a program: [`liestep::methods::Multibody`].
#[derive(Clone)]
pub struct System {
    pub(crate) title: String,
    pub(crate) bodies: Vec<SystemBody>,
    pub(crate) gravity: Option<(f64, Vector3<f64>)>,
    pub(crate) joints: Vec<Between<Joint>>,
    pub(crate) joint_names: Vec<String>,
    pub(crate) springs: Vec<Between<Spring>>,
    pub(crate) run: Schedule,
    pub(crate) picture: PlanePicture,
    pub(crate) output: Output,
    pub(crate) columns: Vec<Column>,
    /// The places of quaternions in a sample.
    pub(crate) quaternions: Arc<[usize]>,
    pub(crate) event: Vec<Event>,
    /// Whether forces and torques of joints are asked for, by a column or by an event.
    pub(crate) has_reactions: bool,
    pub(crate) path: PathBuf,
    pub(crate) places: SystemPlaces,
}

/// Lines and columns of tables, from one.
#[derive(Clone)]
pub(crate) struct SystemPlaces {
    pub(crate) bodies: Vec<(usize, usize)>,
    pub(crate) joints: Vec<(usize, usize)>,
    pub(crate) springs: Vec<(usize, usize)>,
    pub(crate) pace: (usize, usize),
}

/// A spring between two points, from their centres of mass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Spring {
    pub(crate) k: f64,
    pub(crate) length: f64,
    pub(crate) at: [Vector3<f64>; 2],
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SystemTable {
    #[serde(default, deserialize_with = "title")]
    title: String,
    body: Vec<Spanned<BodyTable>>,
    gravity: Option<FieldTable>,
    #[serde(default)]
    joint: Vec<Spanned<JointTable>>,
    #[serde(default)]
    spring: Vec<Spanned<SpringTable>>,
    #[serde(default)]
    event: Vec<Spanned<Event>>,
    run: Schedule,
    #[serde(default)]
    picture: PlanePicture,
    #[serde(default)]
    output: Output,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FieldTable {
    g: Scalar<Acceleration>,
    up: Direction,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SpringTable {
    bodies: Names,
    at: [Triple<Length>; 2],
    k: PositiveScalar<Stiffness>,
    length: Scalar<Length>,
}

impl System {
    /// The system of a document without a sweep.
    pub(crate) fn of_document(path: &Path, text: &str, document: &Document<'_>) -> Result<Self, Mistake> {
        let lines = Lines::of(text);
        let table = SystemTable::deserialize(Deserializer::from(document.clone()))
            .map_err(|error| Mistake::of_toml(path, text, &error))?;
        let place = |span: &Range<usize>| lines.place(span.start);
        let places = SystemPlaces {
            bodies: table.body.iter().map(|body| place(&body.span())).collect(),
            joints: table.joint.iter().map(|joint| place(&joint.span())).collect(),
            springs: table.spring.iter().map(|spring| place(&spring.span())).collect(),
            pace: place(&pace_of(document)),
        };
        let located = |(span, message): SpanMessage| Mistake::at(path, place(&span), message);
        let mut system = of_table(table, path, places).map_err(located)?;
        system.run.count(document).map_err(located)?;
        at_odds(document, &system).map_or(Ok(system), Err).map_err(located)
    }

    /// The names of the bodies.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.bodies.iter().map(|body| body.name.as_str())
    }

    /// All columns that a table can have.
    pub(crate) fn all_columns(&self) -> Vec<Column> {
        let joints = self.joint_names.iter().zip(&self.joints).map(|(name, joint)| (name.as_str(), joint.of.kind));
        Column::of_system(&self.names().collect::<Vec<_>>(), &joints.collect::<Vec<_>>())
    }

    /// The numbers of the joints with limits, and the limits.
    pub(crate) fn limited(&self) -> impl Iterator<Item = (usize, Limits)> {
        self.joints.iter().enumerate().filter_map(|(number, joint)| Some((number, joint.of.limits?)))
    }

    /// The place of the first number of a sample that is one of joints.
    pub(crate) fn joint_columns(&self) -> usize {
        let gap = self.all_columns().iter().find(|column| column.key() == "gap").and_then(Column::part);
        gap.map_or(usize::MAX, |gap| gap.end)
    }

    /// Whether a column or an event needs forces or torques of joints.
    fn asks_for_reactions(&self) -> bool {
        let is_reaction = |column: &Column| ["force", "torque"].contains(&column.key());
        let all = self.all_columns();
        let is_seen = |place: usize| {
            let mut parts = all.iter().filter(|column| is_reaction(column)).filter_map(Column::part);
            parts.any(|part| part.contains(&place))
        };
        let places = self.event.iter().filter_map(|event| match event.quantity {
            Quantity::Column(place, _) => Some(place),
            _ => None,
        });
        self.columns.iter().any(is_reaction) || places.into_iter().any(is_seen)
    }

    /// The effects on bodies, each with its body.
    pub(crate) fn effects(&self) -> impl Iterator<Item = (&SystemBody, &'static EffectEntry)> {
        self.bodies.iter().flat_map(|body| body.effects.iter().map(move |(entry, _)| (body, *entry)))
    }

    /// The reason why a step has none back that undoes it.
    pub(crate) fn one_way(&self) -> Option<String> {
        let has_friction =
            |joint: &Between<Joint>| joint.of.terms.damping.is_some() || joint.of.terms.friction.is_some();
        if let Some(joint) = self.joints.iter().position(has_friction) {
            return Some(format!(
                "a composition has steps back, in which friction adds energy, and `{}` has some: leave one of both out",
                self.joint_names[joint]
            ));
        }
        let (body, effect) = self.effects().find(|(_, effect)| effect.does_work())?;
        let (effect, body) = (effect.name(" "), &body.name);
        Some(format!("a composition needs a conservative scene; {effect} of `{body}` does work"))
    }

    /// Whether gaps of joints are cosines in part.
    pub(crate) fn has_cosines(&self) -> bool {
        self.joints.iter().any(|joint| joint.of.kind.has_cosines())
    }
}

impl Parts for System {
    fn title(&self) -> &str {
        &self.title
    }

    fn schedule(&self) -> &Schedule {
        &self.run
    }

    fn schedule_mut(&mut self) -> &mut Schedule {
        &mut self.run
    }

    fn columns(&self) -> &[Column] {
        &self.columns
    }

    fn output(&self) -> &Output {
        &self.output
    }

    fn path(&self) -> &Path {
        &self.path
    }

    fn event_names(&self) -> Vec<&str> {
        let of_joints = self.limited().map(|(joint, _)| self.joint_names[joint].as_str());
        self.event.iter().map(|event| event.name.as_str()).chain(of_joints).collect()
    }

    fn sum(&self) -> String {
        let counted = |count: usize, one: &str| match count {
            0 => None,
            1 => Some(format!("1 {one}")),
            count => Some(format!("{count} {one}s")),
        };
        let bodies =
            if self.bodies.len() == 1 { Some("1 body".to_owned()) } else { counted(self.bodies.len(), "bodie") };
        let gravity = self.gravity.is_some().then(|| "gravity".to_owned());
        let mut effects: Vec<_> = self.effects().map(|(_, effect)| effect.name(" ")).collect();
        effects.sort_unstable();
        effects.dedup();
        let parts = [counted(self.joints.len(), "joint"), counted(self.springs.len(), "spring")];
        let all = [bodies, gravity].into_iter().chain(effects.into_iter().map(Some)).chain(parts);
        all.flatten().collect::<Vec<_>>().join(" + ")
    }

    fn about(&self) -> String {
        let turn =
            |step: f64, body: &SystemBody| format!("{} ({})", round(step * body.start.velocity.norm()), body.name);
        let turns = self.run.step().map_or_else(String::new, |step| {
            let turns: Vec<_> = self.bodies.iter().map(|body| turn(step, body)).collect();
            format!(", hΩ in rad: {}", turns.join(", "))
        });
        format!("{}, {}{turns}", self.sum(), self.run.about(false))
    }

    fn unwatched(mut self) -> Self {
        self.joints.iter_mut().for_each(|joint| joint.of.limits = None);
        Self { event: Vec::new(), columns: Vec::new(), has_reactions: false, ..self }
    }
}

fn of_table(table: SystemTable, path: &Path, places: SystemPlaces) -> Result<System, SpanMessage> {
    let (mut bodies, mut names): (Vec<SystemBody>, Vec<Range<usize>>) = Default::default();
    let (mut is_placed, mut numbered) = (Vec::new(), BTreeMap::new());
    for body in table.body {
        let span = body.span();
        let (body, name, has_place) = body.into_inner().body(span)?;
        if numbered.insert(body.name.clone(), bodies.len()).is_some() {
            return Err((name, format!("there are two bodies called `{}`", body.name)));
        }
        bodies.push(body);
        names.push(name);
        is_placed.push(has_place);
    }
    if bodies.is_empty() {
        return Err((0..0, "a system has a body at least".to_owned()));
    }
    let called: Vec<&str> = bodies.iter().map(|body| body.name.as_str()).collect();
    let columns = table.output.columns(&Column::of_system(&called, &[]), &DEFAULT)?;
    name_twice(&columns).map_or(Ok(()), |name| Err(shared(&name, &called, &names)))?;
    let joint_names = names_of_joints(&table.joint, &called)?;
    let joints = table.joint.into_iter().map(|joint| joint_of(joint.into_inner(), (&bodies, &numbered)));
    let (joints, coordinates): (Vec<_>, Vec<_>) = joints.collect::<Result<Vec<_>, _>>()?.into_iter().unzip();
    let (placing, unplaced) = place(&mut bodies, &mut is_placed, &joints);
    if let Some(body) = unplaced {
        let message =
            "has no place: give its `position` and `start`, or a joint with a body that has one, or with `space`";
        return Err((names[body].clone(), format!("`{}` {message}", bodies[body].name)));
    }
    let idle = coordinates.into_iter().enumerate().find_map(|(k, span)| span.filter(|_| !placing.contains(&k)));
    if let Some(span) = idle {
        let message = "both bodies of this joint have places already, so that it doesn't give one: leave this out, or `position` and `start` of one of them";
        return Err((span, message.to_owned()));
    }
    let springs = springs_of(table.spring, (&bodies, &numbered))?;
    let mut system = System {
        title: or_name(table.title, path),
        bodies,
        gravity: table.gravity.map(|field| (field.g.value, field.up.0)),
        joints,
        joint_names,
        springs,
        run: table.run,
        picture: table.picture,
        output: table.output,
        columns: Vec::new(),
        quaternions: [].into(),
        event: Vec::new(),
        has_reactions: false,
        path: path.to_owned(),
        places,
    };
    let all = system.all_columns();
    system.columns = system.output.columns(&all, &DEFAULT)?;
    name_twice(&system.columns)
        .map_or(Ok(()), |name| Err(shared(&name, &system.names().collect::<Vec<_>>(), &names)))?;
    system.quaternions = quaternions(&all);
    for event in table.event {
        let span = event.span();
        let mut event = event.into_inner();
        event.placed((&all, &system.quaternions), Err(SEVERAL), &|| span.clone())?;
        system.event.push(event);
    }
    system.has_reactions = system.asks_for_reactions();
    Ok(system)
}

/// The springs between named bodies.
fn springs_of(springs: Vec<Spanned<SpringTable>>, bodies: Named<'_>) -> Result<Vec<Between<Spring>>, SpanMessage> {
    let springs = springs.into_iter().map(|spring| {
        let SpringTable { bodies: names, at, k, length } = spring.into_inner();
        let spring = Spring { k: k.value, length: length.value, at: at.map(|point| point.value) };
        Ok(Between { bodies: numbers(&names, bodies)?, of: spring })
    });
    springs.collect()
}

/// The place of the key by which a run has its steps.
fn pace_of(document: &Document<'_>) -> Range<usize> {
    let key = if has(document, "run", "accuracy") { "accuracy" } else { "step" };
    span(document, &["run", key])
}

/// The conflict of a run with the bodies.
fn at_odds(document: &Document<'_>, system: &System) -> Option<SpanMessage> {
    let wrong = |key: &str, message: String| Some((span(document, &["run", key]), message));
    if has(document, "run", "steps_per_orbit") {
        let message = "`steps_per_orbit` are those of one body on an orbit: give a `step` or an `accuracy`";
        return wrong("steps_per_orbit", message.to_owned());
    }
    if has(document, "run", "density") {
        return wrong("density", "a `density` is that of one body: leave it out".to_owned());
    }
    let of_method = || Some((span(document, &["run", "method"]), of_method(system)?));
    system.run.at_odds(document, false).or_else(of_method)
}

/// The reason why the system can't have its method.
fn of_method(system: &System) -> Option<String> {
    match system.run.method {
        Scheme::Step => None,
        Scheme::Composition(composition) if composition.base() != 2 => {
            let (name, base) = (composition.name(), composition.base());
            Some(format!("{name} composes a step of order {base}, and that of several bodies is of order 2"))
        }
        Scheme::Composition(_) => system.one_way(),
        _ => Some("several bodies have their own step, or a `composition` of it".to_owned()),
    }
}

/// The columns of a table by default.
const DEFAULT: [&str; 4] = ["position", "quaternion", "energy", "gap"];

const SEVERAL: &str =
    "only a single body has this quantity: of several an event has a `column` with a `value`, or an `energy`";

/// The places of quaternions among the numbers of these columns.
fn quaternions(all: &[Column]) -> Arc<[usize]> {
    let parts = all.iter().filter(|column| column.key() == "quaternion").filter_map(Column::part);
    parts.flat_map(|part| part.step_by(4)).collect()
}

/// The names of the joints, given or by their numbers from one, which are different from each other and from those of bodies.
fn names_of_joints(joints: &[Spanned<JointTable>], bodies: &[&str]) -> Result<Vec<String>, SpanMessage> {
    let mut taken: BTreeSet<String> = bodies.iter().map(|&body| body.to_owned()).chain([SPACE.to_owned()]).collect();
    let mut names: Vec<String> = Vec::new();
    for (number, joint) in joints.iter().enumerate() {
        let (name, place) = match &joint.get_ref().name {
            Some(name) => (name.get_ref().clone(), name.span()),
            None => (format!("joint-{}", number + 1), joint.span()),
        };
        check_name("a joint", &name).map_err(|message| (place.clone(), message))?;
        if !taken.insert(name.clone()) {
            let both = if names.contains(&name) { "there are two joints" } else { "a body and a joint are" };
            return Err((place, format!("{both} called `{name}`")));
        }
        names.push(name);
    }
    Ok(names)
}

/// A name that two columns share.
fn name_twice(columns: &[Column]) -> Option<String> {
    let mut taken = BTreeSet::new();
    Column::listed(columns).into_iter().map(|column| column.name).find(|name| !taken.insert(name.clone()))
}

/// The mistake of the body whose columns share a name with others, at the place of its name.
fn shared(name: &str, bodies: &[&str], names: &[Range<usize>]) -> SpanMessage {
    let owns = |owner: &str| name.strip_prefix(owner).is_some_and(|rest| rest.starts_with('_'));
    let body = bodies.iter().zip(names).rfind(|(body, _)| owns(body));
    let (place, owner) = body.map_or((0..0, "joint"), |(_, place)| (place.clone(), "body"));
    (place, format!("two columns of the table would be called `{name}`: give the {owner} another name"))
}

/// The bodies, and their numbers by name.
type Named<'a> = (&'a [SystemBody], &'a BTreeMap<String, usize>);

/// The numbers of two named bodies.
fn numbers(names: &Names, (bodies, numbered): Named<'_>) -> Result<[Option<usize>; 2], SpanMessage> {
    let mut numbers = [None; 2];
    for (number, name) in numbers.iter_mut().zip(names.get_ref()) {
        if name.get_ref() == SPACE {
            continue;
        }
        *number = numbered.get(name.get_ref()).copied();
        if number.is_none() {
            let known: Vec<_> = bodies.iter().map(|body| format!("`{}`", body.name)).collect();
            let message = format!("unknown body `{}`, expected one of {}, `{SPACE}`", name.get_ref(), known.join(", "));
            return Err((name.span(), advised(&message)));
        }
    }
    if numbers[0] == numbers[1] {
        return Err((names.span(), "two different ones are joined, of which one may be `space`".to_owned()));
    }
    Ok(numbers)
}

/// The joint of two named bodies, and the place of its coordinates at the start. Space comes first.
fn joint_of(joint: JointTable, bodies: Named<'_>) -> Result<(Between<Joint>, Option<Range<usize>>), SpanMessage> {
    let mut between = numbers(&joint.bodies, bodies)?;
    let (is_swapped, coordinate) = (between[1].is_none(), joint.coordinate());
    if is_swapped {
        between.swap(0, 1);
    }
    Ok((Between { bodies: between, of: joint.joint(is_swapped)? }, coordinate))
}
