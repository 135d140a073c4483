//! Bodies of one material: mass and inertia by their shape.

use nalgebra::{Matrix3, Vector3};
use serde::Deserialize;

use crate::file::quantity::{Direction, Length, PositiveScalar, Triple};

/// A shape with its middle in the centre of mass, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Shape {
    /// A box by its edges along the body's axes.
    Box(Vector3<f64>),
    Round(Round),
    /// A ball by its radius.
    Sphere(f64),
}

/// A cylinder, or one between two halves of a ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Round {
    pub(crate) radius: f64,
    /// The length of the cylinder, without the halves.
    pub(crate) length: f64,
    /// A unit vector.
    pub(crate) axis: Vector3<f64>,
    pub(crate) has_caps: bool,
}

/// A cylinder or a capsule in a file.
#[derive(Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct RoundTable {
    radius: PositiveScalar<Length>,
    length: PositiveScalar<Length>,
    /// Axis, by default the third of the body's.
    axis: Option<Direction>,
}

/// A sphere in a file.
#[derive(Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SphereTable {
    radius: PositiveScalar<Length>,
}

/// The edges of a box in a file.
#[derive(Clone, Copy, Deserialize)]
#[serde(try_from = "Triple<Length>")]
pub(crate) struct BoxTable(Vector3<f64>);

impl TryFrom<Triple<Length>> for BoxTable {
    type Error = &'static str;

    fn try_from(edges: Triple<Length>) -> Result<Self, &'static str> {
        if edges.value.min() > 0.0 { Ok(Self(edges.value)) } else { Err("the edges of a box are above zero") }
    }
}

impl From<BoxTable> for Shape {
    fn from(edges: BoxTable) -> Self {
        Self::Box(edges.0)
    }
}

impl From<SphereTable> for Shape {
    fn from(sphere: SphereTable) -> Self {
        Self::Sphere(sphere.radius.value)
    }
}

impl RoundTable {
    /// The cylinder, or the capsule of this cylinder.
    pub(crate) fn shape(self, has_caps: bool) -> Shape {
        let axis = self.axis.map_or_else(Vector3::z, |axis| axis.0);
        Shape::Round(Round { radius: self.radius.value, length: self.length.value, axis, has_caps })
    }
}

impl Shape {
    /// Volume, m³.
    pub(crate) fn volume(&self) -> f64 {
        match self {
            Self::Box(edges) => edges.product(),
            Self::Sphere(radius) => ball(*radius),
            Self::Round(round) => round.volumes().iter().sum(),
        }
    }

    /// The moments of inertia about the middle by the mass, m².
    pub(crate) fn inertia(&self) -> Matrix3<f64> {
        match *self {
            // A twelfth of the squared edges across each axis.
            Self::Box(edges) => {
                let squares = edges.component_mul(&edges);
                Matrix3::from_diagonal(&(squares.map(|square| squares.sum() - square) / 12.0))
            }
            Self::Sphere(radius) => Matrix3::identity() * (0.4 * radius * radius),
            Self::Round(round) => round.inertia(),
        }
    }
}

impl Round {
    /// The volumes of the cylinder and of both caps, m³.
    fn volumes(&self) -> [f64; 2] {
        let cylinder = std::f64::consts::PI * self.radius * self.radius * self.length;
        [cylinder, if self.has_caps { ball(self.radius) } else { 0.0 }]
    }

    /// The moments of inertia by the mass, m².
    fn inertia(&self) -> Matrix3<f64> {
        let volumes = self.volumes();
        let [cylinder, caps] = volumes.map(|part| part / (volumes[0] + volumes[1]));
        let (r, l) = (self.radius, self.length);
        let along = cylinder * r * r / 2.0 + caps * 0.4 * r * r;
        // A half ball has its centre of mass 3r/8 above its face, which is l/2 away: 2r²/5 − (3r/8)² + (l/2 + 3r/8)².
        let across = cylinder * (r * r / 4.0 + l * l / 12.0) + caps * (0.4 * r * r + l * l / 4.0 + 0.375 * l * r);
        Matrix3::identity() * across + self.axis * self.axis.transpose() * (along - across)
    }
}

/// The volume of a ball, m³.
fn ball(radius: f64) -> f64 {
    4.0 / 3.0 * std::f64::consts::PI * radius.powi(3)
}
