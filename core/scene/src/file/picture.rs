//! Pictures of a run: the table `picture`.

use nalgebra::Vector3;
use serde::Deserialize;

use crate::file::quantity::Direction;

/// The picture of one body.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct SpherePicture {
    /// The path on the sphere.
    pub(crate) path: Trace,
    /// The body axis that `path = "axis"` and the panel `tilt` follow.
    pub(crate) axis: Direction,
    /// Panels from top to bottom.
    pub(crate) panels: Vec<Curve>,
}

impl SpherePicture {
    /// The panels of a group other than SO(3), which has no sphere.
    pub(crate) fn on_group() -> Self {
        Self { panels: vec![Curve::Attitude, Curve::Rates, Curve::Energy], ..Self::default() }
    }
}

/// The point whose path is drawn on the sphere.
#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Trace {
    /// An axis of the body, in space.
    Axis,
    /// The direction of the angular momentum, body frame.
    Momentum,
    /// The direction of the angular velocity, body frame.
    Velocity,
}

/// The curve of a panel, over time.
#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Curve {
    /// The columns of the attitude.
    Attitude,
    /// The angular velocity, body frame; on any group the velocity.
    Rates,
    /// The angle between the axis and the third axis of space.
    Tilt,
    Energy,
    /// The deviation of the energy from its start, in powers of ten.
    EnergyError,
    /// The angular momentum, in space.
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

/// The picture of several bodies.
#[derive(Clone, Deserialize, Default)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct PlanePicture {
    /// The plane of projection; by default the plane of the widest motion.
    pub(crate) plane: Option<Plane>,
}

/// The plane of projection of the bodies' paths.
#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Plane {
    Xy,
    Xz,
    Yz,
}
