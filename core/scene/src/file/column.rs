//! Columns of a run's table: the table `output`.

use std::ops::Range;

use liestep::recording;
use nalgebra::Vector3;
use serde::Deserialize;
use toml::Spanned;

use crate::file::group::Group;
use crate::file::joint_kind::Kind;
use crate::file::mistake::{SpanMessage, advised};
use crate::file::sample::{BodySample, Sample};

use Numbers::{Change, OfBody, Part, SinceStart};

#[doc = include_str!("column.md")]
#[derive(Clone, Debug)]
pub struct Column {
    key: &'static str,
    names: Names,
    numbers: Numbers,
}

/// The name of each number of a column, and its unit.
pub(crate) type Names = Vec<(String, &'static str)>;

/// The function that computes the numbers of a column.
#[derive(Clone, Debug)]
enum Numbers {
    /// A part of a sample's numbers on a group.
    Part(Range<usize>),
    /// The norm of the change of such a part since the first state of the run; the change itself for one number.
    Change(Range<usize>),
    OfBody(fn(&BodySample) -> Vec<f64>),
    /// A difference between a state and the first state of the run.
    SinceStart(fn(&Sample, &Sample) -> f64),
}

impl Column {
    /// The names of a quaternion's columns.
    pub(crate) const QUATERNION: [&'static str; 4] = ["q_w", "q_x", "q_y", "q_z"];
    /// The names of an angular velocity's columns.
    pub(crate) const VELOCITY: [&'static str; 3] = ["velocity_x", "velocity_y", "velocity_z"];
    /// The names of the columns of an angular momentum in space.
    pub(crate) const SPATIAL_MOMENTUM: [&'static str; 3] =
        ["spatial_momentum_x", "spatial_momentum_y", "spatial_momentum_z"];

    /// The columns of a scene on a group, with further ones behind the numbers of its motion.
    pub(crate) fn of_group<const N: usize>(group: &Group, behind: [(&'static str, Names); N]) -> Vec<Self> {
        let named = |quantity: &str, unit: Option<usize>| {
            let components = group.factors.iter().flat_map(|factor| &factor.components);
            let column = |(name, units): &(String, [&'static str; 2])| {
                (format!("{quantity}_{name}"), unit.map_or("", |unit| units[unit]))
            };
            components.map(column).collect::<Vec<_>>()
        };
        let one = |name: &str, unit| vec![(name.to_owned(), unit)];
        let of = |key, names, numbers| Self { key, names, numbers };
        let (energy, in_space) = (group.energy()..group.energy() + 1, group.in_space());
        let (unit, is_rotation) = (group.unit_of_energy(), group.is_rotation());
        let unit_of_momentum = if is_rotation { "kg m²/s" } else { "" };
        let attitude = group.factors.iter().flat_map(liestep::motion::Factor::columns).collect();
        let mut all = vec![of(if is_rotation { "quaternion" } else { "attitude" }, attitude, Part(group.attitude()))];
        if is_rotation {
            let axis = |body: &BodySample| three(body.matrix().column(2).into());
            all.push(Self::new("axis", &["axis_x", "axis_y", "axis_z"], "1", OfBody(axis)));
        }
        all.extend([
            of("velocity", named("velocity", Some(0)), Part(group.velocity())),
            of("momentum", named("momentum", Some(1)), Part(group.momentum())),
            // A unit of a component in space is another where factors of several units make one.
            of("spatial-momentum", named("spatial_momentum", Some(1)), Part(in_space.clone())),
            of("energy", one("energy", unit), Part(energy.clone())),
            of("energy-error", one("energy_error", unit), Change(energy.clone())),
        ]);
        if is_rotation {
            let vertical = |first: &Sample, now: &Sample| (now.angular_momentum - first.angular_momentum).z;
            all.push(Self::new(
                "vertical-momentum-error",
                &["vertical_momentum_error"],
                "kg m²/s",
                SinceStart(vertical),
            ));
        }
        all.extend([
            of("momentum-error", one("momentum_error", unit_of_momentum), Change(in_space)),
            of("defect", one("defect", "1"), Part(energy.end..energy.end + 1)),
        ]);
        let mut end = energy.end + 1;
        let behind = behind.into_iter().filter(|(_, names)| !names.is_empty());
        all.extend(behind.map(|(key, names)| Self::next(&mut end, key, names)));
        all
    }

    /// The column of the next numbers of a sample, behind those before this end.
    fn next(end: &mut usize, key: &'static str, names: Names) -> Self {
        let start = *end;
        *end += names.len();
        Self { key, numbers: Part(start..*end), names }
    }

    /// The columns of several bodies with joints of these names and kinds: the numbers of a sample, one after the other. The
    /// gap has another unit where it combines a length with the cosines of axes.
    pub(crate) fn of_system<const N: usize>(
        bodies: &[&str],
        joints: &[(&str, Kind)],
        behind: [(&'static str, Names); N],
    ) -> Vec<Self> {
        let named = |all: &mut dyn Iterator<Item = &&str>, names: &[&str], unit| -> Vec<_> {
            all.flat_map(|one| names.iter().map(move |name| (format!("{one}_{name}"), unit))).collect()
        };
        let of_bodies = |names: &[&str], unit| named(&mut bodies.iter(), names, unit);
        let of_joints = |has: fn(Kind) -> bool, names: &[&str], unit| {
            named(&mut joints.iter().filter(|(_, kind)| has(*kind)).map(|(name, _)| name), names, unit)
        };
        let of_all = |names: &[&str], unit| names.iter().map(|name| ((*name).to_owned(), unit)).collect::<Vec<_>>();
        let unit_of_gap = if joints.iter().any(|(_, kind)| kind.has_cosines()) { "m, 1" } else { "m" };
        let every = |_: Kind| true;
        let all = [
            ("position", of_bodies(&["x", "y", "z"], "m")),
            ("quaternion", of_bodies(&Self::QUATERNION, "1")),
            ("velocity", of_bodies(&Self::VELOCITY, "rad/s")),
            ("moving", of_bodies(&["moving_x", "moving_y", "moving_z"], "m/s")),
            ("energy", of_all(&["energy"], "J")),
            ("momentum", of_all(&MOMENTUM, "kg m/s")),
            (
                "angular-momentum",
                of_all(&["angular_momentum_x", "angular_momentum_y", "angular_momentum_z"], "kg m²/s"),
            ),
            ("gap", of_all(&["gap"], unit_of_gap)),
            ("angle", of_joints(Kind::turns_about_axis, &["angle"], "rad")),
            ("shift", of_joints(Kind::shifts_along_axis, &["shift"], "m")),
        ];
        let of_forces = [
            ("force", of_joints(every, &["force_x", "force_y", "force_z"], "N")),
            ("torque", of_joints(every, &["torque_x", "torque_y", "torque_z"], "N m")),
        ];
        let behind = behind.into_iter().filter(|(_, names)| !names.is_empty());
        let mut end = 0;
        let column = |(key, names): (&'static str, Names)| Self::next(&mut end, key, names);
        let mut all: Vec<_> = all.into_iter().chain(behind).chain(of_forces).map(column).collect();
        let energy = all.iter().find(|column| column.key == "energy").and_then(Self::part);
        let error =
            |energy| Self { key: "energy-error", names: of_all(&["energy_error"], "J"), numbers: Change(energy) };
        all.extend(energy.map(error));
        all
    }

    fn new(key: &'static str, names: &[&str], unit: &'static str, numbers: Numbers) -> Self {
        Self { key, names: names.iter().map(|name| ((*name).to_owned(), unit)).collect(), numbers }
    }

    /// The column's key in a file.
    #[must_use]
    pub const fn key(&self) -> &'static str {
        self.key
    }

    /// The places of the column's numbers in a sample, if they are a part of its numbers.
    pub(crate) fn part(&self) -> Option<Range<usize>> {
        if let Part(part) = &self.numbers { Some(part.clone()) } else { None }
    }

    /// The names of the column's numbers in the head of a table. With several bodies, the body's name precedes them.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.names.iter().map(|(name, _)| name.as_str())
    }

    /// The unit of a number of this name.
    pub(crate) fn unit(&self, name: &str) -> Option<&'static str> {
        self.names.iter().find(|(own, _)| own == name).map(|(_, unit)| *unit)
    }

    /// Whether the column measures from the start of a run, so that a state alone doesn't determine it.
    pub(crate) const fn is_since_the_start(&self) -> bool {
        matches!(self.numbers, SinceStart(_) | Change(_))
    }

    /// The place of a number of this name in a sample.
    pub(crate) fn place(&self, name: &str) -> Option<usize> {
        let part = self.part()?;
        self.names().position(|own| own == name).map(|at| part.start + at)
    }

    /// Whether the number of this place in a sample is an angle that jumps from π to −π.
    pub(crate) fn goes_around(&self, place: usize) -> bool {
        match self.key {
            "angle" => true,
            // Roll and yaw go around, pitch between them doesn't.
            "roll-pitch-yaw" => self.part().is_some_and(|part| (place - part.start) % 3 != 1),
            _ => false,
        }
    }

    /// The numbers of these columns in the state `now` of a run that started from `first`.
    pub(crate) fn row(columns: &[Self], first: &Sample, now: &Sample) -> Vec<f64> {
        let numbers = |column: &Self| match &column.numbers {
            Part(part) => now.numbers[part.clone()].to_vec(),
            Change(part) => vec![change(&first.numbers[part.clone()], &now.numbers[part.clone()])],
            OfBody(numbers) => now.bodies.iter().flat_map(numbers).collect(),
            SinceStart(number) => vec![number(first, now)],
        };
        columns.iter().flat_map(numbers).collect()
    }

    /// The columns of a table, by name and unit.
    #[must_use]
    pub fn listed(columns: &[Self]) -> Vec<recording::Column> {
        let named = |(name, unit): &(String, &str)| recording::Column { name: name.clone(), unit: (*unit).to_owned() };
        columns.iter().flat_map(|column| column.names.iter().map(named)).collect()
    }
}

/// The change of a number, or the norm of that of several.
fn change(first: &[f64], now: &[f64]) -> f64 {
    match (first, now) {
        ([first], [now]) => now - first,
        _ => first.iter().zip(now).map(|(first, now)| (now - first).powi(2)).sum::<f64>().sqrt(),
    }
}

const MOMENTUM: [&str; 3] = ["momentum_x", "momentum_y", "momentum_z"];

fn three(vector: Vector3<f64>) -> Vec<f64> {
    vec![vector.x, vector.y, vector.z]
}

/// The table `output` of a file.
#[derive(Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Output {
    columns: Option<Spanned<Vec<Spanned<String>>>>,
    /// Steps from row to row. By default there are as many rows as a picture has samples.
    every: Option<Stride>,
}

/// A number of steps.
#[derive(Clone, Copy, Deserialize)]
#[serde(try_from = "i64")]
struct Stride(u64);

impl TryFrom<i64> for Stride {
    type Error = &'static str;

    fn try_from(steps: i64) -> Result<Self, &'static str> {
        u64::try_from(steps)
            .ok()
            .filter(|steps| *steps > 0)
            .map(Self)
            .ok_or("must be a whole number of steps, above zero")
    }
}

/// Most samples of a picture, more than it can resolve.
const SAMPLES_IN_A_PICTURE: u64 = 20_000;

/// Steps from one sample of a picture to the next in a run of this many steps.
pub(crate) fn picture_stride(steps: u64) -> u64 {
    steps.div_ceil(SAMPLES_IN_A_PICTURE).max(1)
}

impl Output {
    /// The columns by their keys among the known ones, or the default.
    pub(crate) fn columns(&self, known: &[Column], default: &[&str]) -> Result<Vec<Column>, SpanMessage> {
        let find = |key: &str| known.iter().find(|column| column.key == key).cloned();
        let Some(keys) = &self.columns else { return Ok(default.iter().filter_map(|key| find(key)).collect()) };
        let column = |key: &Spanned<String>| {
            find(key.get_ref()).ok_or_else(|| {
                if let Some(column) = known.iter().find(|column| column.names().any(|name| name == key.get_ref())) {
                    return (key.span(), format!("`{}` is a part of `{}`: write that", key.get_ref(), column.key));
                }
                let known: Vec<_> = known.iter().map(|column| format!("`{}`", column.key)).collect();
                let message = format!("unknown variant `{}`, expected one of {}", key.get_ref(), known.join(", "));
                (key.span(), advised(&message))
            })
        };
        let columns = keys.get_ref().iter().map(column).collect::<Result<Vec<_>, _>>()?;
        let is_there_before = |place: usize| columns[..place].iter().any(|other| other.key == columns[place].key);
        if (1..columns.len()).any(is_there_before) {
            return Err((keys.span(), "a table has each of its columns once".to_owned()));
        }
        Ok(columns)
    }

    /// Steps from one row to the next in a run of this many steps.
    pub(crate) fn stride(&self, steps: u64) -> u64 {
        self.every.map_or_else(|| picture_stride(steps), |every| every.0)
    }
}
