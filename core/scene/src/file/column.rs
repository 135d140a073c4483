//! What a table of a run has: the table `output`.

use std::fmt;

use liestep::with;
use nalgebra::Vector3;
use serde::Deserialize;
use serde::de::{Deserializer, Error, Visitor};

use crate::file::sample::{BodySample, Sample};

/// A key of `columns`: numbers of a state, each a column of the table.
///
/// | of one body | |
/// |---|---|
/// | `quaternion` | the attitude, body to space, as the unit quaternion `w, x, y, z`: of the two the one nearer to the row before |
/// | `axis` | the third axis of the body, in space |
/// | `velocity` | the angular velocity, body frame, rad/s |
/// | `momentum`, `spatial-momentum` | the angular momentum, body frame and in space, kg m²/s |
/// | `energy` | that of the continuous limit, J |
/// | `energy-error` | what has been added to the energy since the start, J |
/// | `vertical-momentum-error` | what has been added to the angular momentum along the third axis of space, kg m²/s |
/// | `momentum-error` | the length of what has been added to the angular momentum in space, kg m²/s |
///
/// | of several bodies | |
/// |---|---|
/// | `position`, `moving` | of each body the centre of mass in space, m, and its velocity, m/s |
/// | `quaternion`, `velocity` | of each body, as above |
/// | `energy` | the energy of all, J |
/// | `momentum` | the momentum of all, kg m/s |
/// | `angular-momentum` | the angular momentum of all about the origin, kg m²/s |
/// | `gap` | how far the joint that is open farthest is open, m; of pins with the cosines of their axes |
///
/// Those that [`Recorder`](liestep::with::Recorder) has, too, are called as there and have the same numbers. Of several
/// bodies the body's name is before those of its numbers: `upper_x`.
#[derive(Clone, Copy, Debug)]
pub struct Column {
    key: &'static str,
    names: &'static [&'static str],
    unit: &'static str,
    numbers: Numbers,
}

/// How the numbers of a column are found.
#[derive(Clone, Copy, Debug)]
enum Numbers {
    OfBody(fn(&BodySample) -> Vec<f64>),
    OfScene(fn(&Sample) -> Vec<f64>),
    /// Of a state and the first of the run.
    SinceStart(fn(&Sample, &Sample) -> f64),
}

impl Column {
    pub(crate) const QUATERNION: Self =
        Self::of_body("quaternion", &["q_w", "q_x", "q_y", "q_z"], "1", |body| body.quaternion.to_vec());
    pub(crate) const VELOCITY: Self =
        Self::of_body("velocity", &["velocity_x", "velocity_y", "velocity_z"], "rad/s", |body| three(body.velocity));
    pub(crate) const SPATIAL_MOMENTUM: Self = Self::of_scene(
        "spatial-momentum",
        &["spatial_momentum_x", "spatial_momentum_y", "spatial_momentum_z"],
        "kg m²/s",
        |sample| three(sample.angular_momentum),
    );
    pub(crate) const ENERGY: Self = Self::of_scene("energy", &["energy"], "J", |sample| vec![sample.energy]);
    pub(crate) const ENERGY_ERROR: Self =
        Self::since_start("energy-error", &["energy_error"], "J", |first, now| now.energy - first.energy);
    pub(crate) const MOMENTUM_ERROR: Self =
        Self::since_start("momentum-error", &["momentum_error"], "kg m²/s", |first, now| {
            (now.angular_momentum - first.angular_momentum).norm()
        });

    const OF_ONE_BODY: [Self; 9] = [
        Self::QUATERNION,
        Self::of_body("axis", &["axis_x", "axis_y", "axis_z"], "1", |body| three(body.matrix().column(2).into())),
        Self::VELOCITY,
        Self::of_body("momentum", &["momentum_x", "momentum_y", "momentum_z"], "kg m²/s", |body| three(body.momentum)),
        Self::SPATIAL_MOMENTUM,
        Self::ENERGY,
        Self::ENERGY_ERROR,
        Self::since_start("vertical-momentum-error", &["vertical_momentum_error"], "kg m²/s", |first, now| {
            (now.angular_momentum - first.angular_momentum).z
        }),
        Self::MOMENTUM_ERROR,
    ];

    const OF_SEVERAL_BODIES: [Self; 8] = [
        Self::of_body("position", &["x", "y", "z"], "m", |body| three(body.position)),
        Self::QUATERNION,
        Self::VELOCITY,
        Self::of_body("moving", &["moving_x", "moving_y", "moving_z"], "m/s", |body| three(body.moving)),
        Self::ENERGY,
        Self::of_scene("momentum", &["momentum_x", "momentum_y", "momentum_z"], "kg m/s", |sample| {
            three(sample.momentum)
        }),
        Self::of_scene(
            "angular-momentum",
            &["angular_momentum_x", "angular_momentum_y", "angular_momentum_z"],
            "kg m²/s",
            |sample| three(sample.angular_momentum),
        ),
        Self::of_scene("gap", &["gap"], "m", |sample| vec![sample.gap]),
    ];

    const fn of_body(
        key: &'static str,
        names: &'static [&'static str],
        unit: &'static str,
        numbers: fn(&BodySample) -> Vec<f64>,
    ) -> Self {
        Self { key, names, unit, numbers: Numbers::OfBody(numbers) }
    }

    const fn of_scene(
        key: &'static str,
        names: &'static [&'static str],
        unit: &'static str,
        numbers: fn(&Sample) -> Vec<f64>,
    ) -> Self {
        Self { key, names, unit, numbers: Numbers::OfScene(numbers) }
    }

    const fn since_start(
        key: &'static str,
        names: &'static [&'static str],
        unit: &'static str,
        number: fn(&Sample, &Sample) -> f64,
    ) -> Self {
        Self { key, names, unit, numbers: Numbers::SinceStart(number) }
    }

    /// What it is called in a file.
    #[must_use]
    pub const fn key(self) -> &'static str {
        self.key
    }

    /// What its numbers are called in the first row of a table, those of a body behind the body's name.
    #[must_use]
    pub const fn names(self) -> &'static [&'static str] {
        self.names
    }

    /// The unit of its numbers.
    #[must_use]
    pub const fn unit(self) -> &'static str {
        self.unit
    }

    /// Whether each body has it.
    #[must_use]
    pub const fn is_of_bodies(self) -> bool {
        matches!(self.numbers, Numbers::OfBody(_))
    }

    /// Whether it is measured from the start of a run, and so isn't known of a state alone.
    pub(crate) const fn is_since_the_start(self) -> bool {
        matches!(self.numbers, Numbers::SinceStart(_))
    }

    /// Its numbers in a state of a run with this first one.
    pub(crate) fn numbers(self, first: &Sample, now: &Sample) -> Vec<f64> {
        match self.numbers {
            Numbers::OfBody(numbers) => now.bodies.iter().flat_map(numbers).collect(),
            Numbers::OfScene(numbers) => numbers(now),
            Numbers::SinceStart(number) => vec![number(first, now)],
        }
    }

    /// The numbers of columns, one after the other.
    pub(crate) fn row(columns: &[Self], first: &Sample, now: &Sample) -> Vec<f64> {
        columns.iter().flat_map(|column| column.numbers(first, now)).collect()
    }

    /// The columns of a table, each with the number of its body; the name of one body that is alone is empty.
    pub(crate) fn listed(columns: &[Self], bodies: &[&str]) -> Vec<(with::Column, Option<usize>)> {
        let mut all = Vec::new();
        for column in columns {
            let mut add = |before: &str, body| {
                let named = |name| with::Column { name: format!("{before}{name}"), unit: column.unit.to_owned() };
                all.extend(column.names.iter().map(|name| (named(name), body)));
            };
            if column.is_of_bodies() {
                for (number, body) in bodies.iter().enumerate() {
                    let before = if body.is_empty() { String::new() } else { format!("{body}_") };
                    add(&before, Some(number));
                }
            } else {
                add("", None);
            }
        }
        all
    }
}

fn three(vector: Vector3<f64>) -> Vec<f64> {
    vec![vector.x, vector.y, vector.z]
}

/// What a table has, of one body or of several.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Output<const SEVERAL: bool> {
    #[serde(default = "default_columns::<SEVERAL>", deserialize_with = "different::<_, SEVERAL>")]
    pub(crate) columns: Vec<Column>,
    /// In steps from row to row; as many as a picture has room for, where it isn't given.
    every: Option<Stride>,
}

impl<const SEVERAL: bool> Default for Output<SEVERAL> {
    fn default() -> Self {
        Self { columns: default_columns::<SEVERAL>(), every: None }
    }
}

fn default_columns<const SEVERAL: bool>() -> Vec<Column> {
    let keys: &[&str] = if SEVERAL {
        &["position", "quaternion", "energy", "gap"]
    } else {
        &["velocity", "spatial-momentum", "energy", "axis", "quaternion"]
    };
    keys.iter().filter_map(|key| find::<SEVERAL>(key)).collect()
}

fn all<const SEVERAL: bool>() -> &'static [Column] {
    if SEVERAL { &Column::OF_SEVERAL_BODIES } else { &Column::OF_ONE_BODY }
}

fn find<const SEVERAL: bool>(key: &str) -> Option<Column> {
    all::<SEVERAL>().iter().find(|column| column.key == key).copied()
}

/// Columns of different names.
fn different<'de, D: Deserializer<'de>, const SEVERAL: bool>(source: D) -> Result<Vec<Column>, D::Error> {
    let columns: Vec<Column> =
        Vec::<Key<SEVERAL>>::deserialize(source)?.into_iter().map(|Key(column)| column).collect();
    let is_there_before = |place: usize| columns[..place].iter().any(|other| other.key == columns[place].key);
    if (1..columns.len()).any(is_there_before) {
        return Err(D::Error::custom("a table has each of its columns once"));
    }
    Ok(columns)
}

/// A column by its key.
struct Key<const SEVERAL: bool>(Column);

impl<'de, const SEVERAL: bool> Deserialize<'de> for Key<SEVERAL> {
    fn deserialize<D: Deserializer<'de>>(source: D) -> Result<Self, D::Error> {
        source.deserialize_str(KeyText::<SEVERAL>).map(Self)
    }
}

struct KeyText<const SEVERAL: bool>;

impl<const SEVERAL: bool> Visitor<'_> for KeyText<SEVERAL> {
    type Value = Column;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the name of a column")
    }

    fn visit_str<E: Error>(self, key: &str) -> Result<Column, E> {
        find::<SEVERAL>(key).ok_or_else(|| {
            let known: Vec<_> = all::<SEVERAL>().iter().map(|column| format!("`{}`", column.key)).collect();
            E::custom(format!("unknown variant `{key}`, expected one of {}", known.join(", ")))
        })
    }
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

/// More samples than a picture has room for.
const SAMPLES_IN_A_PICTURE: u64 = 20_000;

/// Steps from one sample of a picture to the next, in a run of this many steps.
pub(crate) fn picture_stride(steps: u64) -> u64 {
    steps.div_ceil(SAMPLES_IN_A_PICTURE).max(1)
}

impl<const SEVERAL: bool> Output<SEVERAL> {
    /// Steps from one row to the next, in a run of this many steps.
    pub(crate) fn stride(&self, steps: u64) -> u64 {
        self.every.map_or_else(|| picture_stride(steps), |every| every.0)
    }
}
