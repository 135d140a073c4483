//! What the file of a system says.

// The letters of the field.
#![allow(non_snake_case)]

use std::ops::Range;
use std::path::{Path, PathBuf};

use liestep::NonstandardInertia;
use liestep::methods::{BallJoint, Joint, PinJoint};
use nalgebra::Vector3;
use serde::Deserialize;
use toml::Spanned;

use super::columns::Output;
use super::held::Arranged;
use super::picture::Picture;
use crate::body::{Full, INERTIA, Moments, Nonstandard};
use crate::document::Wrong;
use crate::file::{equal_steps, title};
use crate::mistake::{Mistake, place_of};
use crate::quantity::{Acceleration, Direction, Duration, Length, Mass, Positive, Scalar, Speed, Stiffness, Triple};
use crate::start::Start;
use crate::tables::short;

/// As many bodies as a file may have: of so many one type of stepper is compiled.
pub(super) const BODIES: usize = 8;
/// As many joints as may close loops.
pub(super) const LOOPS: usize = 4;
/// As many springs.
pub(super) const SPRINGS: usize = 16;

/// Several bodies, with joints and springs between them.
///
/// | table | keys |
/// |---|---|
/// | | `title` |
/// | `[[body]]`, up to eight | `name`; `m`, kg; one of `moments`, `J_d`, `J`, kg m², about the centre of mass, in the body's frame; `position` of that in space, m, and how fast it is `moving` there, m/s; `start` as of [one body](crate::SceneFile) |
/// | `gravity` | `g`, m/s²; `up`, in space |
/// | `[[joint]]`, up to four more than make a tree | `kind`: `ball` or `pin`; `bodies`: two names, of which one may be `space`; `at`: the point of each, m, from its centre of mass in its own frame, of `space` from the origin; `axes` of a pin: that of each, in the same frames |
/// | `[[spring]]`, up to sixteen | `bodies`, `at` as of joints; `k`, N/m, and `length`, m, at rest |
/// | `run` | `duration`, `step`; `nearest`: whether joints that are open at the start are closed, with the velocities that keep them so |
/// | `picture` | `plane`: `xy`, `xz`, `yz` |
/// | `output` | `columns` of a table behind the time, see [`SystemColumn`](crate::SystemColumn); `every`: so many steps from row to row |
///
/// Joints may form loops, up to four of them. Everything else that several bodies can have is for programs: [`liestep::Stepper::jointed`].
#[derive(Clone)]
pub struct System {
    pub(super) title: String,
    pub(super) bodies: Vec<Body>,
    pub(super) gravity: Option<(f64, Vector3<f64>)>,
    pub(super) joints: Vec<Between<Joint>>,
    pub(super) springs: Vec<Between<Spring>>,
    pub(super) step: f64,
    pub(super) steps: u32,
    pub(super) nearest: bool,
    pub(super) picture: Picture,
    pub(super) output: Output,
    pub(super) path: PathBuf,
    pub(super) places: Places,
    pub(super) arranged: Arranged,
}

/// Lines and columns of tables, from one.
#[derive(Clone)]
pub(super) struct Places {
    pub(super) bodies: Vec<(usize, usize)>,
    pub(super) joints: Vec<(usize, usize)>,
    pub(super) pace: (usize, usize),
}

#[derive(Clone)]
pub(super) struct Body {
    pub(super) name: String,
    pub(super) m: f64,
    pub(super) J_d: NonstandardInertia,
    pub(super) position: Vector3<f64>,
    pub(super) moving: Vector3<f64>,
    pub(super) start: Start,
}

/// Something between two bodies, by their numbers; `None` is space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Between<T> {
    pub(super) bodies: [Option<usize>; 2],
    pub(super) of: T,
}

/// Between a point of each, from its centre of mass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Spring {
    pub(super) k: f64,
    pub(super) length: f64,
    pub(super) at: [Vector3<f64>; 2],
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
    picture: Picture,
    #[serde(default)]
    output: Output,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct BodyTable {
    name: Spanned<String>,
    m: Positive<Mass>,
    moments: Option<Moments>,
    J_d: Option<Nonstandard>,
    J: Option<Full>,
    position: Triple<Length>,
    moving: Option<Triple<Speed>>,
    start: Start,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FieldTable {
    g: Scalar<Acceleration>,
    up: Direction,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Kind {
    Ball,
    Pin,
}

type Names = Spanned<[Spanned<String>; 2]>;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct JointTable {
    kind: Spanned<Kind>,
    bodies: Names,
    at: [Triple<Length>; 2],
    axes: Option<Spanned<[Direction; 2]>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SpringTable {
    bodies: Names,
    at: [Triple<Length>; 2],
    k: Positive<Stiffness>,
    length: Scalar<Length>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RunTable {
    step: Spanned<Positive<Duration>>,
    duration: Positive<Duration>,
    #[serde(default)]
    nearest: bool,
}

impl System {
    /// Reads the file of a system.
    ///
    /// # Errors
    ///
    /// The first [`Mistake`] in it.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, Mistake> {
        let path = path.as_ref();
        Self::parse(path, &crate::text(path)?)
    }

    /// The system that a text describes; `path` is for messages.
    ///
    /// # Errors
    ///
    /// The first [`Mistake`] in it.
    pub fn parse(path: impl AsRef<Path>, text: &str) -> Result<Self, Mistake> {
        let path = path.as_ref();
        let table: SystemTable = toml::from_str(text).map_err(|error| Mistake::of_toml(path, text, &error))?;
        let place = |span: &Range<usize>| place_of(text, span);
        let places = Places {
            bodies: table.body.iter().map(|body| place(&body.span())).collect(),
            joints: table.joint.iter().map(|joint| place(&joint.span())).collect(),
            pace: place(&table.run.step.span()),
        };
        of_table(table, path, places).map_err(|(span, message)| Mistake::at(path, place(&span), message))
    }

    /// What the scene is called.
    #[must_use]
    pub fn title(&self) -> &str {
        &self.title
    }

    /// The names of the bodies.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.bodies.iter().map(|body| body.name.as_str())
    }

    /// What there is, and how it is stepped, in words.
    #[must_use]
    pub fn about(&self) -> String {
        format!("{}, {} steps of {} s", self.sum(), self.steps, short(self.step))
    }

    pub(super) fn has_pins(&self) -> bool {
        self.joints.iter().any(|joint| matches!(joint.of, Joint::Pin(_)))
    }

    /// What there is, in words.
    pub(super) fn sum(&self) -> String {
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

fn of_table(table: SystemTable, path: &Path, places: Places) -> Result<System, Wrong> {
    if let Some(body) = table.body.get(BODIES) {
        return Err((body.span(), format!("a file has up to {BODIES} bodies; a program may have any number")));
    }
    if let Some(spring) = table.spring.get(SPRINGS) {
        return Err((spring.span(), format!("a file has up to {SPRINGS} springs; a program may have any number")));
    }
    let (mut bodies, mut names): (Vec<Body>, Vec<Range<usize>>) = Default::default();
    for body in table.body {
        let body = body_of(body)?;
        if bodies.iter().any(|other| other.name == body.0.name) {
            return Err((body.1, format!("there are two bodies called `{}`", body.0.name)));
        }
        bodies.push(body.0);
        names.push(body.1);
    }
    if bodies.is_empty() {
        return Err((0..0, "a system has a body at least".to_owned()));
    }
    let called: Vec<&str> = bodies.iter().map(|body| body.name.as_str()).collect();
    if let Some((body, name)) = table.output.name_twice(&called) {
        let message = format!("two columns of the table would be called `{name}`: give the body another name");
        return Err((names[body].clone(), message));
    }
    let spans: Vec<Range<usize>> = table.joint.iter().map(Spanned::span).collect();
    let joints: Vec<_> =
        table.joint.into_iter().map(|joint| joint_of(joint.into_inner(), &bodies)).collect::<Result<_, _>>()?;
    let arranged = Arranged::of(&joints, bodies.len()).map_err(|joint| {
        let message = format!(
            "this joint closes one loop more than the {LOOPS} that a file may have; a program may have any number"
        );
        (spans[joint].clone(), message)
    })?;
    let springs = table.spring.into_iter().map(|spring| {
        let SpringTable { bodies: names, at, k, length } = spring.into_inner();
        let spring = Spring { k: k.value, length: length.value, at: at.map(|point| point.value) };
        Ok(Between { bodies: numbers(&names, &bodies)?, of: spring })
    });
    let springs = springs.collect::<Result<_, Wrong>>()?;
    let step = table.run.step.get_ref().value;
    let steps = equal_steps(step, table.run.duration.value).map_err(|message| (table.run.step.span(), message))?;
    Ok(System {
        title: table.title,
        bodies,
        gravity: table.gravity.map(|field| (field.g.value, field.up.0)),
        joints,
        springs,
        step,
        steps,
        nearest: table.run.nearest,
        picture: table.picture,
        output: table.output,
        path: path.to_owned(),
        places,
        arranged,
    })
}

/// A body, and where its name is.
fn body_of(body: Spanned<BodyTable>) -> Result<(Body, Range<usize>), Wrong> {
    let span = body.span();
    let BodyTable { name, m, moments, J_d, J, position, moving, start } = body.into_inner();
    // It begins the names of columns.
    let is_plain = |letter: char| letter.is_alphanumeric() || "_-".contains(letter);
    if name.get_ref().is_empty() || !name.get_ref().chars().all(is_plain) {
        return Err((name.span(), "the `name` of a body has letters, digits, - and _ only".to_owned()));
    }
    if name.get_ref() == SPACE {
        return Err((name.span(), "`space` is what bodies move in; give the body another name".to_owned()));
    }
    let principal = |J_d| NonstandardInertia::from(J_d);
    let J_d = match (moments, J_d, J) {
        (Some(Moments(J_d)), None, None) | (None, Some(Nonstandard(J_d)), None) => principal(J_d),
        (None, None, Some(Full(J_d))) => J_d,
        _ => return Err((span, INERTIA.to_owned())),
    };
    let moving = moving.map_or_else(Vector3::zeros, |moving| moving.value);
    let place = name.span();
    Ok((Body { name: name.into_inner(), m: m.value, J_d, position: position.value, moving, start }, place))
}

/// What isn't a body.
const SPACE: &str = "space";

/// The numbers of two that are named.
fn numbers(names: &Names, bodies: &[Body]) -> Result<[Option<usize>; 2], Wrong> {
    let mut numbers = [None; 2];
    for (number, name) in numbers.iter_mut().zip(names.get_ref()) {
        if name.get_ref() == SPACE {
            continue;
        }
        *number = bodies.iter().position(|body| body.name == *name.get_ref());
        if number.is_none() {
            let known: Vec<_> = bodies.iter().map(|body| format!("`{}`", body.name)).collect();
            let message = format!("there is no body `{}`; there are {}, and `space`", name.get_ref(), known.join(", "));
            return Err((name.span(), message));
        }
    }
    if numbers[0] == numbers[1] {
        return Err((names.span(), "two different ones are joined, of which one may be `space`".to_owned()));
    }
    Ok(numbers)
}

fn joint_of(joint: JointTable, bodies: &[Body]) -> Result<Between<Joint>, Wrong> {
    let JointTable { kind, bodies: names, at, axes } = joint;
    let mut between = numbers(&names, bodies)?;
    let mut ends = at.map(|point| point.value);
    let mut axes_of = axes.as_ref().map(|axes| axes.get_ref().each_ref().map(|axis| axis.0));
    // Space is always above.
    if between[1].is_none() {
        between.swap(0, 1);
        ends.swap(0, 1);
        if let Some(axes) = &mut axes_of {
            axes.swap(0, 1);
        }
    }
    let [above, below] = ends;
    let of = match (kind.get_ref(), axes_of) {
        (Kind::Ball, None) => Joint::Ball(BallJoint { above, below }),
        (Kind::Pin, Some([axis_above, axis_below])) => Joint::Pin(PinJoint { above, below, axis_above, axis_below }),
        (Kind::Ball, Some(_)) => {
            let span = axes.map_or_else(|| kind.span(), |axes| axes.span());
            return Err((span, "a ball joint turns about any axis; leave `axes` out, or make it a `pin`".to_owned()));
        }
        (Kind::Pin, None) => {
            return Err((kind.span(), "a pin has `axes`: that of each of its bodies, in that body's frame".to_owned()));
        }
    };
    Ok(Between { bodies: between, of })
}
