//! Pictures of a run: the table `picture`.

use nalgebra::Vector3;
use serde::Deserialize;

use crate::file::quantity::Direction;

/// The picture of a run: on the left a path on a sphere, or the ways of several bodies in a plane; on the right panels.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct Picture {
    /// The path on the sphere.
    pub(crate) path: Trace,
    /// The body axis that `path = "axis"` and the panel `tilt` follow.
    pub(crate) axis: Direction,
    /// Panels from top to bottom.
    pub(crate) panels: Option<Vec<Curve>>,
    /// The plane of projection; by default the plane of the widest motion.
    pub(crate) plane: Option<Plane>,
}

impl Default for Picture {
    fn default() -> Self {
        Self { path: Trace::Axis, axis: Direction(Vector3::z()), panels: None, plane: None }
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

/// The curves of a panel, over time; those of several bodies one for each, but for energy and momentum.
#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Curve {
    /// The columns of the attitude.
    Attitude,
    /// The angular velocity, body frame; on any group the velocity; of several bodies its norm.
    Rates,
    /// The angle between the axis and the third axis of space.
    Tilt,
    /// The angle by which a body is turned from its start.
    Turns,
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

/// The plane of projection of the bodies' paths.
#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Plane {
    Xy,
    Xz,
    Yz,
}
