//! Angles of a body's axes: the tables `[[pointing]]`.

use nalgebra::Matrix3;
use serde::Deserialize;
use toml::Spanned;

use crate::file::orbit::{DirectionInTime, Parameter as _, Time};
use crate::file::quantity::Direction;

/// The angle between an axis of the body and a direction in space, or that of the mass.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Pointing {
    pub(crate) name: String,
    pub(crate) body: Option<Spanned<String>>,
    /// The number of the body, which is found when all are known.
    #[serde(skip)]
    pub(crate) number: usize,
    /// Axis, body frame.
    axis: Direction,
    to: DirectionInTime,
}

impl Pointing {
    /// The angle at an attitude, body to space, at a time; rad.
    pub(crate) fn angle(&self, attitude: &Matrix3<f64>, time: Time<'_>) -> f64 {
        let (axis, to) = (attitude * self.axis.0, self.to.at(time));
        // The cosine alone doesn't know a small angle.
        axis.cross(&to).norm().atan2(axis.dot(&to))
    }

    /// Whether the direction is that of the mass.
    pub(crate) fn is_on_orbit(&self) -> bool {
        self.to.is_on_orbit()
    }
}
