//! What to draw: the table `picture`.

use nalgebra::Vector3;
use serde::Deserialize;

use crate::file::quantity::Direction;

/// What to draw of one body.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct SpherePicture {
    /// The path on the sphere.
    pub(crate) path: Trace,
    /// The body axis that `path = "axis"` and the panel `tilt` follow.
    pub(crate) axis: Direction,
    /// From above to below.
    pub(crate) panels: Vec<Curve>,
}

/// What moves on the sphere.
#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Trace {
    /// An axis of the body, in space.
    Axis,
    /// The direction of the angular momentum, in the body.
    Momentum,
    /// The direction of the velocity, in the body.
    Velocity,
}

/// What is drawn over time.
#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Curve {
    /// The body velocity.
    Rates,
    /// The angle of the axis to the third axis of space.
    Tilt,
    Energy,
    /// The deviation of the energy from its start, in powers of ten.
    EnergyError,
    /// In space.
    Momentum,
    /// The deviation of the vertical momentum from its start, in powers of ten.
    VerticalMomentumError,
    /// The length of the deviation of the spatial momentum from its start, in powers of ten.
    MomentumError,
}

impl Default for SpherePicture {
    fn default() -> Self {
        let panels = vec![Curve::Rates, Curve::Momentum, Curve::Energy];
        Self { path: Trace::Axis, axis: Direction(Vector3::z()), panels }
    }
}

/// What to draw of several bodies.
#[derive(Clone, Deserialize, Default)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct PlanePicture {
    /// The plane of the motion, if it isn't given.
    pub(crate) plane: Option<Plane>,
}

/// What the paths of the bodies are seen in.
#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Plane {
    Xy,
    Xz,
    Yz,
}
