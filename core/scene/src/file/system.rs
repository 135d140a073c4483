//! The file of a system of several bodies.

use std::ops::Range;
use std::path::{Path, PathBuf};

use liestep::NonstandardInertia;
use liestep::recording;
use nalgebra::{UnitQuaternion, Vector3};
use serde::Deserialize;
use toml::Spanned;

use crate::file::body::{INERTIA, InertiaRows, Kinetic, Moments, NonstandardMoments};
use crate::file::column::{Column, Output};
use crate::file::joint::{Joint, JointTable, Names};
use crate::file::mistake::{Mistake, SpanMessage, advised, place_of};
use crate::file::part::{Between, JointName, SystemBody};
use crate::file::picture::PlanePicture;
use crate::file::placed::place;
use crate::file::quantity::{
    Acceleration, Direction, Duration, Length, Mass, PositiveScalar, Scalar, Speed, Stiffness, Triple, round, short,
};
use crate::file::schedule::{equal_steps, fraction};
use crate::file::start::Start;
use crate::file::text::title;

/// Several bodies, with joints and springs between them.
///
/// | table | keys |
/// |---|---|
/// | | `title` |
/// | `[[body]]` | `name`; `m`, kg; one of `moments`, `J_d`, `J`, kg m², about the centre of mass, in the body's frame; `kinetic`: `geodesic` by default, `rigid`, which is (3.13), or `cayley`; `position` of the centre of mass in space, m, and its velocity `moving`, m/s; `start` as for [one body](crate::SceneFile); without a position a body is placed by a joint with one that has a place |
/// | `gravity` | `g`, m/s²; `up`, in space |
/// | `[[joint]]` | `name`, if programs are to reach it; `kind`: `ball`, `pin`, `universal`, `cylinder`, `slider`, `weld`, `plane`, `distance`, see [`liestep::methods::Joint`]; `bodies`: two names, of which one may be `space`; `at`: a point of each, m, from the centre of mass in the body's frame, in `space` from the origin; `axes` where the kind has some: one in each of the same frames; `zero`: the attitude of the second body in the frame of the first at the angle zero, by default that of the least turn that makes the axes parallel; `length` of a distance, m |
/// | | where the joint starts, of a body without a `position`: `angle` and `rate` about the axis, `shift`, m, and `speed`, m/s, along it, of the second body relative to the first, zero by default |
/// | | in a joint that turns: `damping`, N m s; `stiffness`, N m/rad, with the angle at `rest`; a motor's `torque` about the axis, N m; dry `friction`: its `torque` and the rate `below` which it is viscous. In a slider: `damping`, N s/m; `stiffness`, N/m, with the shift at `rest`; a `force`, N |
/// | `[[spring]]` | `bodies`, `at` as for joints; `k`, N/m, and the `length` at rest, m |
/// | `run` | `duration`; `step`, of which the duration is a whole number; `nearest`: whether joints that are open at the start are closed: positions and their velocities are corrected first, then attitudes and angular velocities by as little as possible |
/// | `picture` | `plane`: `xy`, `xz`, `yz`; by default the plane in which the motion is the widest |
/// | `output` | `columns` that follow the time in a table, see [`Column`]; `every`: the number of steps from row to row |
///
/// Joints may form loops. Other effects on several bodies need a program: [`liestep::methods::Multibody`].
#[derive(Clone)]
pub struct System {
    pub(crate) title: String,
    pub(crate) bodies: Vec<SystemBody>,
    pub(crate) gravity: Option<(f64, Vector3<f64>)>,
    pub(crate) joints: Vec<Between<Joint>>,
    /// One for each joint.
    pub(crate) joint_names: Vec<JointName>,
    pub(crate) springs: Vec<Between<Spring>>,
    pub(crate) step: f64,
    pub(crate) steps: u32,
    pub(crate) nearest: bool,
    pub(crate) picture: PlanePicture,
    pub(crate) output: Output,
    pub(crate) columns: Vec<Column>,
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
    #[serde(deserialize_with = "title")]
    title: String,
    body: Vec<Spanned<BodyTable>>,
    gravity: Option<FieldTable>,
    #[serde(default)]
    joint: Vec<Spanned<JointTable>>,
    #[serde(default)]
    spring: Vec<Spanned<SpringTable>>,
    run: RunTable,
    #[serde(default)]
    picture: PlanePicture,
    #[serde(default)]
    output: Output,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct BodyTable {
    name: Spanned<String>,
    m: PositiveScalar<Mass>,
    moments: Option<Moments>,
    J_d: Option<NonstandardMoments>,
    J: Option<InertiaRows>,
    kinetic: Option<Spanned<Kinetic>>,
    position: Option<Triple<Length>>,
    moving: Option<Triple<Speed>>,
    start: Option<Start>,
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

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RunTable {
    step: Spanned<PositiveScalar<Duration>>,
    duration: Spanned<PositiveScalar<Duration>>,
    #[serde(default)]
    nearest: bool,
}

impl System {
    /// Parses the system of a text; `path` appears in messages.
    ///
    /// # Errors
    ///
    /// The first [`Mistake`] in it.
    pub fn parse(path: impl AsRef<Path>, text: &str) -> Result<Self, Mistake> {
        let path = path.as_ref();
        let table: SystemTable = toml::from_str(text).map_err(|error| Mistake::of_toml(path, text, &error))?;
        let place = |span: &Range<usize>| place_of(text, span);
        let places = SystemPlaces {
            bodies: table.body.iter().map(|body| place(&body.span())).collect(),
            joints: table.joint.iter().map(|joint| place(&joint.span())).collect(),
            springs: table.spring.iter().map(|spring| place(&spring.span())).collect(),
            pace: place(&table.run.step.span()),
        };
        of_table(table, path, places).map_err(|(span, message)| Mistake::at(path, place(&span), message))
    }

    /// The title of the scene.
    #[must_use]
    pub fn title(&self) -> &str {
        &self.title
    }

    /// The names of the bodies.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.bodies.iter().map(|body| body.name.as_str())
    }

    /// The columns that follow the time in a table. The gap of pins has the unit `m, 1`.
    #[must_use]
    pub fn columns(&self) -> Vec<recording::Column> {
        let listed = Column::listed(&self.columns, &self.names().collect::<Vec<_>>());
        let unit = |column: recording::Column| {
            // The gap combines a length with the cosines of axes.
            let is_mixed = column.name == "gap" && self.has_cosines();
            if is_mixed { recording::Column { unit: "m, 1".to_owned(), ..column } } else { column }
        };
        listed.into_iter().map(|(column, _)| unit(column)).collect()
    }

    /// A description of the parts and the steps, in words.
    #[must_use]
    pub fn about(&self) -> String {
        let turn = |body: &SystemBody| format!("{} ({})", round(self.step * body.start.velocity.norm()), body.name);
        let turns: Vec<_> = self.bodies.iter().map(turn).collect();
        let (sum, steps, step) = (self.sum(), self.steps, short(self.step));
        format!("{sum}, {steps} steps of {step} s, hΩ in rad: {}", turns.join(", "))
    }

    pub(crate) fn has_cosines(&self) -> bool {
        self.joints.iter().any(|joint| joint.of.kind.has_cosines())
    }

    /// A description of the parts, in words.
    pub(crate) fn sum(&self) -> String {
        let counted = |count: usize, one: &str| match count {
            0 => None,
            1 => Some(format!("1 {one}")),
            count => Some(format!("{count} {one}s")),
        };
        let bodies =
            if self.bodies.len() == 1 { Some("1 body".to_owned()) } else { counted(self.bodies.len(), "bodie") };
        let gravity = self.gravity.is_some().then(|| "gravity".to_owned());
        let all = [bodies, gravity, counted(self.joints.len(), "joint"), counted(self.springs.len(), "spring")];
        all.into_iter().flatten().collect::<Vec<_>>().join(" + ")
    }
}

fn of_table(table: SystemTable, path: &Path, places: SystemPlaces) -> Result<System, SpanMessage> {
    let (mut bodies, mut names): (Vec<SystemBody>, Vec<Range<usize>>) = Default::default();
    let mut is_placed = Vec::new();
    for body in table.body {
        let (body, name, has_place) = body_of(body)?;
        if bodies.iter().any(|other| other.name == body.name) {
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
    let columns = table.output.columns(&Column::of_several_bodies(), &["position", "quaternion", "energy", "gap"])?;
    if let Some((body, name)) = name_twice(&columns, &called) {
        let message = format!("two columns of the table would be called `{name}`: give the body another name");
        return Err((names[body].clone(), message));
    }
    let joint_names = joint_names(&table.joint, &called)?;
    let joints = table.joint.into_iter().map(|joint| joint_of(joint.into_inner(), &bodies));
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
    let springs = table.spring.into_iter().map(|spring| {
        let SpringTable { bodies: names, at, k, length } = spring.into_inner();
        let spring = Spring { k: k.value, length: length.value, at: at.map(|point| point.value) };
        Ok(Between { bodies: numbers(&names, &bodies)?, of: spring })
    });
    let springs = springs.collect::<Result<_, SpanMessage>>()?;
    let step = table.run.step.get_ref().value;
    let duration = table.run.duration.get_ref().value;
    let steps = equal_steps(step, duration).map_err(|message| (table.run.step.span(), message))?;
    if let Some(message) = fraction(step, duration) {
        return Err((table.run.duration.span(), message));
    }
    Ok(System {
        title: table.title,
        bodies,
        gravity: table.gravity.map(|field| (field.g.value, field.up.0)),
        joints,
        joint_names,
        springs,
        step,
        steps,
        nearest: table.run.nearest,
        picture: table.picture,
        output: table.output,
        columns,
        path: path.to_owned(),
        places,
    })
}

/// A name that two columns share, and the number of the body that one of them belongs to.
fn name_twice(columns: &[Column], bodies: &[&str]) -> Option<(usize, String)> {
    let all = Column::listed(columns, bodies);
    all.iter().enumerate().find_map(|(number, (column, body))| {
        let (_, other) = all[..number].iter().find(|(other, _)| other.name == column.name)?;
        Some((body.or(*other)?, column.name.clone()))
    })
}

fn is_plain(name: &str) -> bool {
    !name.is_empty() && name.chars().all(|letter| letter.is_alphanumeric() || "_-".contains(letter))
}

/// The names of joints, which are different from each other and from those of bodies.
fn joint_names(joints: &[Spanned<JointTable>], bodies: &[&str]) -> Result<Vec<JointName>, SpanMessage> {
    let mut names: Vec<JointName> = Vec::new();
    for joint in joints {
        let JointTable { name, bodies: between, .. } = joint.get_ref();
        let is_swapped = between.get_ref()[1].get_ref() == SPACE;
        if let Some(name) = name {
            let own = name.get_ref();
            let refuse = |message: String| Err((name.span(), message));
            if !is_plain(own) {
                return refuse("the `name` of a joint has letters, digits, - and _ only".to_owned());
            }
            if own == SPACE || bodies.contains(&own.as_str()) {
                return refuse(format!("a body and a joint are called `{own}`"));
            }
            if names.iter().any(|other| other.name.as_ref() == Some(own)) {
                return refuse(format!("there are two joints called `{own}`"));
            }
        }
        names.push(JointName { name: name.as_ref().map(|name| name.get_ref().clone()), is_swapped });
    }
    Ok(names)
}

/// A body, the place of its name, and whether it has a place in space.
fn body_of(body: Spanned<BodyTable>) -> Result<(SystemBody, Range<usize>, bool), SpanMessage> {
    let span = body.span();
    let BodyTable { name, m, moments, J_d, J, kinetic, position, moving, start } = body.into_inner();
    // The name of a body is the prefix of its columns.
    if !is_plain(name.get_ref()) {
        return Err((name.span(), "the `name` of a body has letters, digits, - and _ only".to_owned()));
    }
    if name.get_ref() == SPACE {
        return Err((name.span(), "`space` is what bodies move in; give the body another name".to_owned()));
    }
    let J = match (moments, J_d, J) {
        (Some(Moments { J, .. }), None, None) | (None, None, Some(InertiaRows(J))) => J,
        (None, Some(NonstandardMoments(J_d)), None) => NonstandardInertia::from(J_d).to_inertia(),
        _ => return Err((span, INERTIA.to_owned())),
    };
    if let Some(kinetic) = kinetic.as_ref().filter(|kinetic| kinetic.get_ref().order() != 2) {
        let message = "a body among several is `geodesic`, `rigid` or `cayley`: joints and springs are of second order";
        return Err((kinetic.span(), message.to_owned()));
    }
    let kinetic = kinetic.map_or(Kinetic::Geodesic, Spanned::into_inner);
    let has_place = position.is_some();
    let wrong = match (has_place, start.is_some(), moving.is_some()) {
        (true, false, _) => Some("a body with a `position` has a `start`, too: its attitude and angular velocity"),
        (false, true, _) => Some("a body with a `start` has a `position`, too; one that joints place has neither"),
        (false, false, true) => {
            Some("a body that is `moving` has a `position` and a `start`; joints have `rate` and `speed`")
        }
        _ => None,
    };
    if let Some(message) = wrong {
        return Err((name.span(), message.to_owned()));
    }
    let moving = moving.map_or_else(Vector3::zeros, |moving| moving.value);
    let position = position.map_or_else(Vector3::zeros, |position| position.value);
    let start = start.unwrap_or(Start { attitude: UnitQuaternion::identity(), velocity: Vector3::zeros() });
    let place = name.span();
    let body = SystemBody { name: name.into_inner(), m: m.value, J, kinetic, position, moving, start };
    Ok((body, place, has_place))
}

/// The name of space among bodies.
const SPACE: &str = "space";

/// The numbers of two named bodies.
fn numbers(names: &Names, bodies: &[SystemBody]) -> Result<[Option<usize>; 2], SpanMessage> {
    let mut numbers = [None; 2];
    for (number, name) in numbers.iter_mut().zip(names.get_ref()) {
        if name.get_ref() == SPACE {
            continue;
        }
        *number = bodies.iter().position(|body| body.name == *name.get_ref());
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
fn joint_of(joint: JointTable, bodies: &[SystemBody]) -> Result<(Between<Joint>, Option<Range<usize>>), SpanMessage> {
    let mut between = numbers(&joint.bodies, bodies)?;
    let (is_swapped, coordinate) = (between[1].is_none(), joint.coordinate());
    if is_swapped {
        between.swap(0, 1);
    }
    Ok((Between { bodies: between, of: joint.joint(is_swapped)? }, coordinate))
}
