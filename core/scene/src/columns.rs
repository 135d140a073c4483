//! What a table of a run has: the table `output`.

use liestep::groups::LieGroup as _;
use liestep::with;
use nalgebra::Vector3;
use serde::Deserialize;

use crate::run::Sample;

/// What is known of a state beside its time: one column of a table for each number.
///
/// Those that [`Recorder`](liestep::with::Recorder) has, too, are called as there and have the same numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Column {
    /// The attitude, body to space, as the unit quaternion `w, x, y, z`: of the two the one nearer to the row before.
    Quaternion,
    /// The third axis of the body, in space.
    Axis,
    /// The angular velocity, body frame, rad/s.
    Velocity,
    /// The angular momentum, body frame, kg m²/s.
    Momentum,
    /// The angular momentum, in space, kg m²/s.
    SpatialMomentum,
    /// The energy of the continuous limit, J.
    Energy,
    /// What has been added to the energy since the start, J.
    EnergyError,
    /// What has been added to the angular momentum along the third axis of space, kg m²/s.
    VerticalMomentumError,
    /// The length of what has been added to the angular momentum in space, kg m²/s.
    MomentumError,
}

impl Column {
    /// All of them.
    pub const ALL: [Self; 9] = [
        Self::Quaternion,
        Self::Axis,
        Self::Velocity,
        Self::Momentum,
        Self::SpatialMomentum,
        Self::Energy,
        Self::EnergyError,
        Self::VerticalMomentumError,
        Self::MomentumError,
    ];

    /// What its numbers are called in the first row of a table.
    #[must_use]
    pub const fn names(self) -> &'static [&'static str] {
        match self {
            Self::Quaternion => &["q_w", "q_x", "q_y", "q_z"],
            Self::Axis => &["axis_x", "axis_y", "axis_z"],
            Self::Velocity => &["velocity_x", "velocity_y", "velocity_z"],
            Self::Momentum => &["momentum_x", "momentum_y", "momentum_z"],
            Self::SpatialMomentum => &["spatial_momentum_x", "spatial_momentum_y", "spatial_momentum_z"],
            Self::Energy => &["energy"],
            Self::EnergyError => &["energy_error"],
            Self::VerticalMomentumError => &["vertical_momentum_error"],
            Self::MomentumError => &["momentum_error"],
        }
    }

    /// The unit of its numbers.
    #[must_use]
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Quaternion | Self::Axis => "1",
            Self::Velocity => "rad/s",
            Self::Momentum | Self::SpatialMomentum | Self::VerticalMomentumError | Self::MomentumError => "kg m²/s",
            Self::Energy | Self::EnergyError => "J",
        }
    }

    /// Whether it is measured from the start of a run, and so isn't known of a state alone.
    pub(crate) const fn is_since_the_start(self) -> bool {
        matches!(self, Self::EnergyError | Self::VerticalMomentumError | Self::MomentumError)
    }

    /// Its numbers in a row.
    pub(crate) fn values(self, row: &Row) -> Vec<f64> {
        let Row { sample, first, quaternion } = row;
        let three = |vector: Vector3<f64>| vec![vector.x, vector.y, vector.z];
        let added = || sample.spatial_momentum() - first.spatial_momentum();
        match self {
            Self::Quaternion => quaternion.to_vec(),
            Self::Axis => three(sample.matrix().column(2).into()),
            Self::Velocity => three(sample.velocity),
            Self::Momentum => three(sample.momentum),
            Self::SpatialMomentum => three(sample.spatial_momentum()),
            Self::Energy => vec![sample.energy],
            Self::EnergyError => vec![sample.energy - first.energy],
            Self::VerticalMomentumError => vec![added().z],
            Self::MomentumError => vec![added().norm()],
        }
    }

    /// The columns of a table, behind the time.
    pub(crate) fn listed(columns: &[Self]) -> impl Iterator<Item = with::Column> {
        columns.iter().flat_map(|column| {
            let unit = column.unit();
            column.names().iter().map(move |&name| with::Column { name: name.to_owned(), unit: unit.to_owned() })
        })
    }
}

/// A sample, and what its numbers need of those before it.
#[derive(Clone, Copy)]
pub(crate) struct Row {
    sample: Sample,
    first: Sample,
    quaternion: [f64; 4],
}

impl Row {
    /// The first of a run.
    pub(crate) fn new(first: Sample) -> Self {
        let mut row = Self { sample: first, first, quaternion: [0.0; 4] };
        row.show(first);
        row
    }

    /// Goes on to a sample that is later.
    pub(crate) fn show(&mut self, sample: Sample) {
        self.sample = sample;
        sample.attitude.write_numbers(&mut self.quaternion);
    }

    /// The numbers of these columns.
    pub(crate) fn numbers(&self, columns: &[Column]) -> Vec<f64> {
        columns.iter().flat_map(|column| column.values(self)).collect()
    }

    /// The quaternion `w, x, y, z`.
    pub(crate) fn quaternion(&self) -> [f64; 4] {
        self.quaternion
    }
}

/// What a table has.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct Output {
    #[serde(deserialize_with = "different")]
    pub(crate) columns: Vec<Column>,
    /// In steps from row to row; as many as a picture has room for, where it isn't given.
    pub(crate) every: Option<Stride>,
}

impl Default for Output {
    fn default() -> Self {
        use Column::{Axis, Energy, Quaternion, SpatialMomentum, Velocity};
        Self { columns: vec![Velocity, SpatialMomentum, Energy, Axis, Quaternion], every: None }
    }
}

/// A number of steps.
#[derive(Clone, Copy, Deserialize)]
#[serde(try_from = "i64")]
pub(crate) struct Stride(pub(crate) u64);

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

/// Columns of different names.
pub(crate) fn different<'de, D, C>(source: D) -> Result<Vec<C>, D::Error>
where
    D: serde::Deserializer<'de>,
    C: Deserialize<'de> + PartialEq,
{
    let columns = Vec::<C>::deserialize(source)?;
    match (1..columns.len()).find(|&place| columns[..place].contains(&columns[place])) {
        Some(_) => Err(serde::de::Error::custom("a table has each of its columns once")),
        None => Ok(columns),
    }
}

/// More samples than a picture has room for.
const DRAWN_SAMPLES: u64 = 20_000;

/// Steps from one sample of a picture to the next, of so many.
pub(crate) fn drawn(steps: u64) -> u64 {
    steps.div_ceil(DRAWN_SAMPLES).max(1)
}

impl Output {
    /// Steps from one row to the next, of so many.
    pub(crate) fn stride(&self, steps: u64) -> u64 {
        self.every.map_or_else(|| drawn(steps), |every| every.0)
    }
}
