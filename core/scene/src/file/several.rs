//! The tables of several bodies, with the joints and springs between them.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use serde::Deserialize;
use toml::Spanned;
use toml::de::{DeValue, Deserializer};

use crate::file::column::Output;
use crate::file::control::{self, Control, Wheel};
use crate::file::effects::GravityGradientTable;
use crate::file::event::Event;
use crate::file::joint::{Joint, JointTable, Names};
use crate::file::kepler::Orbit;
use crate::file::mistake::{Lines, Mistake, SpanMessage};
use crate::file::over_time;
use crate::file::part::{Between, BodyTable, SPACE, SystemBody};
use crate::file::picture::Picture;
use crate::file::placed::place;
use crate::file::pointing::Pointing;
use crate::file::quantity::{Acceleration, Direction, Length, PositiveScalar, Scalar, Stiffness, Triple};
use crate::file::scene_file::SceneFile;
use crate::file::schedule::Schedule;
use crate::file::system::{Spring, System, SystemPlaces};
use crate::file::tables::Document;
use crate::file::text::{check_name, number_of, title};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SystemTable {
    #[serde(default, deserialize_with = "title")]
    title: String,
    body: Vec<Spanned<BodyTable>>,
    gravity: Option<FieldTable>,
    gravity_gradient: Option<GravityGradientTable>,
    orbit: Option<Orbit>,
    #[serde(default)]
    pointing: Vec<Pointing>,
    #[serde(default, deserialize_with = "control::taken")]
    control: Vec<Control>,
    #[serde(default, deserialize_with = "control::taken")]
    wheel: Vec<Wheel>,
    #[serde(default)]
    joint: Vec<Spanned<JointTable>>,
    #[serde(default)]
    spring: Vec<Spanned<SpringTable>>,
    #[serde(default)]
    event: Vec<Event>,
    run: Schedule,
    #[serde(default)]
    picture: Picture,
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

/// The scene of a document with several bodies, but for what is seen of it.
pub(crate) fn several(path: &Path, document: &Document<'_>, lines: &Lines<'_>) -> Result<SceneFile, Mistake> {
    let located = |(span, message): SpanMessage| Mistake::at(path, lines.place(span.start), message);
    let mut rest = document.clone();
    let over_time = over_time::take(&mut rest, path).map_err(located)?;
    let table = SystemTable::deserialize(Deserializer::from(rest))
        .map_err(|error| Mistake::of_toml(path, lines.text, &error))?;
    let place = |span: Range<usize>| lines.place(span.start);
    let places = SystemPlaces {
        bodies: table.body.iter().map(|body| place(body.span())).collect(),
        joints: table.joint.iter().map(|joint| place(joint.span())).collect(),
        springs: table.spring.iter().map(|spring| place(spring.span())).collect(),
    };
    let SystemTable { title, gravity_gradient, orbit, pointing, event, run, picture, output, .. } = table;
    let (control, wheel) = (table.control, table.wheel);
    let gravity = table.gravity.map(|field| (field.g.value, field.up.0));
    let system = of_tables((table.body, orbit.as_ref()), table.joint, table.spring, places).map_err(located)?;
    let observed = SceneFile { title, run, pointing, picture, event, output, ..SceneFile::default() };
    let mut file = SceneFile { orbit, control, wheel, gravity_gradient, ..observed };
    file.run.count(document, file.orbit.as_ref()).map_err(located)?;
    // Three coordinates of each place are in front.
    let bodies = system.bodies.len();
    file.group.quaternions = (0..bodies).map(|body| 3 * bodies + 4 * body).collect();
    let names: Vec<&str> = system.names().collect();
    let of_value = |value: &Spanned<DeValue<'_>>| over_time::of_value(value, path);
    (file.control, file.wheel) = control::take(&mut document.clone(), &of_value, &names).map_err(located)?;
    let of_laws = file.control.iter().map(|control| (control.body, &control.span));
    let turned = of_laws.chain(file.wheel.iter().map(|wheel| (wheel.body, &wheel.span)));
    if let Some((body, span)) = { turned }.find(|(body, _)| system.bodies[*body].J.is_none()) {
        let message = format!("laws and wheels turn a body, and the point mass `{}` has no inertia", names[body]);
        return Err(located((span.clone(), message)));
    }
    file.system = Some(Arc::new(System { gravity, ..system }));
    file.over_time = over_time.into();
    Ok(file)
}

/// The bodies of their tables, with the joints and springs between them.
fn of_tables(
    (tables, orbit): (Vec<Spanned<BodyTable>>, Option<&Orbit>),
    joints: Vec<Spanned<JointTable>>,
    springs: Vec<Spanned<SpringTable>>,
    places: SystemPlaces,
) -> Result<System, SpanMessage> {
    let (mut bodies, mut names): (Vec<SystemBody>, Vec<Range<usize>>) = Default::default();
    let (mut is_placed, mut numbered) = (Vec::new(), BTreeMap::new());
    for body in tables {
        let span = body.span();
        let (body, name, has_place) = body.into_inner().body(span, orbit)?;
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
    let joint_names = names_of_joints(&joints, bodies.iter().map(|body| body.name.clone()))?;
    let joints = joints.into_iter().map(|joint| joint_of(joint.into_inner(), (&bodies, &numbered)));
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
    let springs = springs_of(springs, (&bodies, &numbered))?;
    Ok(System { bodies, gravity: None, joints, joint_names, springs, has_reactions: false, places })
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

/// The names of the joints, given or by their numbers from one, which are different from each other and from those of bodies.
fn names_of_joints(
    joints: &[Spanned<JointTable>],
    bodies: impl Iterator<Item = String>,
) -> Result<Vec<String>, SpanMessage> {
    let mut taken: BTreeSet<String> = bodies.chain([SPACE.to_owned()]).collect();
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
            let known: Vec<_> = bodies.iter().map(|body| body.name.as_str()).chain([SPACE]).collect();
            number_of(Some(name), &known, &name.span())?;
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
