//! Columns of a run's table: the table `output`.

use liestep::recording;
use nalgebra::Vector3;
use serde::Deserialize;
use toml::Spanned;

use crate::file::mistake::{Wrong, advised};
use crate::file::sample::{BodySample, Sample};

use Numbers::{OfBody, OfScene, SinceStart};

#[doc = include_str!("column.md")]
#[derive(Clone, Copy, Debug)]
pub struct Column {
    key: &'static str,
    names: &'static [&'static str],
    unit: &'static str,
    numbers: Numbers,
}

/// The function that computes the numbers of a column.
#[derive(Clone, Copy, Debug)]
enum Numbers {
    OfBody(fn(&BodySample) -> Vec<f64>),
    OfScene(fn(&Sample) -> Vec<f64>),
    /// A difference between a state and the first state of the run.
    SinceStart(fn(&Sample, &Sample) -> f64),
}

impl Column {
    pub(crate) const QUATERNION: Self =
        Self::new("quaternion", &["q_w", "q_x", "q_y", "q_z"], "1", OfBody(|body| body.quaternion.to_vec()));
    pub(crate) const VELOCITY: Self = Self::new(
        "velocity",
        &["velocity_x", "velocity_y", "velocity_z"],
        "rad/s",
        OfBody(|body| three(body.velocity)),
    );
    pub(crate) const SPATIAL_MOMENTUM: Self = Self::new(
        "spatial-momentum",
        &["spatial_momentum_x", "spatial_momentum_y", "spatial_momentum_z"],
        "kg m²/s",
        OfScene(|sample| three(sample.angular_momentum)),
    );
    const ENERGY: Self = Self::new("energy", &["energy"], "J", OfScene(|sample| vec![sample.energy]));
    pub(crate) const ENERGY_ERROR: Self =
        Self::new("energy-error", &["energy_error"], "J", SinceStart(|first, now| now.energy - first.energy));
    pub(crate) const MOMENTUM_ERROR: Self = Self::new(
        "momentum-error",
        &["momentum_error"],
        "kg m²/s",
        SinceStart(|first, now| (now.angular_momentum - first.angular_momentum).norm()),
    );

    pub(crate) const OF_ONE_BODY: [Self; 9] = [
        Self::QUATERNION,
        Self::new("axis", &["axis_x", "axis_y", "axis_z"], "1", OfBody(|body| three(body.matrix().column(2).into()))),
        Self::VELOCITY,
        Self::new("momentum", &MOMENTUM, "kg m²/s", OfBody(|body| three(body.momentum))),
        Self::SPATIAL_MOMENTUM,
        Self::ENERGY,
        Self::ENERGY_ERROR,
        Self::new(
            "vertical-momentum-error",
            &["vertical_momentum_error"],
            "kg m²/s",
            SinceStart(|first, now| (now.angular_momentum - first.angular_momentum).z),
        ),
        Self::MOMENTUM_ERROR,
    ];

    pub(crate) const OF_SEVERAL_BODIES: [Self; 8] = [
        Self::new("position", &["x", "y", "z"], "m", OfBody(|body| three(body.position))),
        Self::QUATERNION,
        Self::VELOCITY,
        Self::new("moving", &["moving_x", "moving_y", "moving_z"], "m/s", OfBody(|body| three(body.moving))),
        Self::ENERGY,
        Self::new("momentum", &MOMENTUM, "kg m/s", OfScene(|sample| three(sample.momentum))),
        Self::new(
            "angular-momentum",
            &["angular_momentum_x", "angular_momentum_y", "angular_momentum_z"],
            "kg m²/s",
            OfScene(|sample| three(sample.angular_momentum)),
        ),
        Self::new("gap", &["gap"], "m", OfScene(|sample| vec![sample.gap])),
    ];

    const fn new(key: &'static str, names: &'static [&'static str], unit: &'static str, numbers: Numbers) -> Self {
        Self { key, names, unit, numbers }
    }

    /// The column's key in a file.
    #[must_use]
    pub const fn key(self) -> &'static str {
        self.key
    }

    /// The names of the column's numbers in the head of a table. With several bodies, the body's name precedes them.
    #[must_use]
    pub const fn names(self) -> &'static [&'static str] {
        self.names
    }

    /// Whether the column measures from the start of a run, so that a state alone doesn't determine it.
    pub(crate) const fn is_since_the_start(self) -> bool {
        matches!(self.numbers, SinceStart(_))
    }

    /// The numbers of these columns in the state `now` of a run that started from `first`.
    pub(crate) fn row(columns: &[Self], first: &Sample, now: &Sample) -> Vec<f64> {
        let numbers = |column: &Self| match column.numbers {
            OfBody(numbers) => now.bodies.iter().flat_map(numbers).collect(),
            OfScene(numbers) => numbers(now),
            SinceStart(number) => vec![number(first, now)],
        };
        columns.iter().flat_map(numbers).collect()
    }

    /// The columns of a table, each with the number of its body. A single body has an empty name.
    pub(crate) fn listed(columns: &[Self], bodies: &[&str]) -> Vec<(recording::Column, Option<usize>)> {
        let mut all = Vec::new();
        for column in columns {
            let mut add = |before: &str, body| {
                let named = |name| recording::Column { name: format!("{before}{name}"), unit: column.unit.to_owned() };
                all.extend(column.names.iter().map(|name| (named(name), body)));
            };
            match column.numbers {
                OfBody(_) if bodies != [""] => {
                    bodies.iter().enumerate().for_each(|(number, body)| add(&format!("{body}_"), Some(number)));
                }
                _ => add("", None),
            }
        }
        all
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
    pub(crate) fn columns(&self, known: &[Column], default: &[&str]) -> Result<Vec<Column>, Wrong> {
        let find = |key: &str| known.iter().find(|column| column.key == key).copied();
        let Some(keys) = &self.columns else { return Ok(default.iter().filter_map(|key| find(key)).collect()) };
        let column = |key: &Spanned<String>| {
            find(key.get_ref()).ok_or_else(|| {
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
