//! What a table of a run has: the table `output`.

use nalgebra::Vector3;
use serde::Deserialize;

use crate::file::{Pace, Schedule};
use crate::run::Sample;
use crate::tables::csv;

/// What is known of a state: one column of a table for each number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Column {
    /// The time, s.
    Time,
    /// The attitude, body to space, as the unit quaternion `w, x, y, z`.
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
    pub const ALL: [Self; 10] = [
        Self::Time,
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
            Self::Time => &["t"],
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

    /// Its numbers for a state of a run that began with `first`.
    pub(crate) fn values(self, sample: &Sample, first: &Sample) -> Vec<f64> {
        let three = |vector: Vector3<f64>| vec![vector.x, vector.y, vector.z];
        let added = || sample.spatial_momentum() - first.spatial_momentum();
        match self {
            Self::Time => vec![sample.time],
            Self::Quaternion => {
                let quaternion = sample.attitude.to_quaternion();
                vec![quaternion.w, quaternion.i, quaternion.j, quaternion.k]
            }
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
}

/// What is kept of a run.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct Output {
    pub(crate) columns: Vec<Column>,
    /// In steps; as many as a picture has room for, where it isn't given.
    pub(crate) every: Option<Stride>,
}

impl Default for Output {
    fn default() -> Self {
        use Column::{Axis, Energy, Quaternion, SpatialMomentum, Time, Velocity};
        Self { columns: vec![Time, Velocity, SpatialMomentum, Energy, Axis, Quaternion], every: None }
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

/// More samples than a picture has room for.
const DRAWN_SAMPLES: u64 = 20_000;

/// Some hundred megabytes of them.
const MOST_SAMPLES: u64 = 2_000_000;

impl Output {
    /// Steps from one sample to the next, of so many.
    pub(crate) fn stride(&self, steps: u64) -> u64 {
        self.every.map_or_else(|| steps.div_ceil(DRAWN_SAMPLES), |every| every.0).max(1)
    }

    /// What is wrong with `every`.
    pub(crate) fn at_odds(&self, run: &Schedule) -> Option<String> {
        let (every, Pace::Step { steps, .. }) = (self.every?.0, run.pace) else { return None };
        let samples = u64::from(steps) / every;
        (samples > MOST_SAMPLES).then(|| {
            format!("`every` makes {samples} samples, more than {MOST_SAMPLES}; take more steps from one to the next")
        })
    }
}

/// The samples as comma-separated values, of a run that began with `first`.
pub(crate) fn table(columns: &[Column], first: Option<&Sample>, samples: &[Sample]) -> String {
    let names: Vec<_> = columns.iter().flat_map(|column| column.names()).copied().collect();
    let row = |sample: &Sample| {
        columns.iter().flat_map(|column| column.values(sample, first.unwrap_or(sample))).collect::<Vec<_>>()
    };
    csv(&names, samples.iter().map(row))
}
