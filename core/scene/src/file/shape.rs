//! Bodies of one material: mass and inertia by their shape.

use nalgebra::{Matrix3, Vector3};
use serde::Deserialize;

use crate::file::quantity::{Direction, Length, PositiveScalar, Triple};

/// A shape with its middle in the centre of mass, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Shape {
    /// The edges along the body's axes.
    Box(Vector3<f64>),
    Round(Round),
    /// The radius.
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
    /// By default the third of the body's axes.
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
    /// m³.
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

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix3, Vector3};

    use super::{Round, Shape};

    /// Whether a point is inside of a shape.
    fn has(shape: &Shape, point: Vector3<f64>) -> bool {
        match shape {
            Shape::Box(edges) => (0..3).all(|k| 2.0 * point[k].abs() < edges[k]),
            Shape::Sphere(radius) => point.norm() < *radius,
            Shape::Round(Round { radius, length, axis, has_caps }) => {
                let along = point.dot(axis);
                let away = (point - axis * along).norm();
                let beyond = along.abs() - length / 2.0;
                if beyond < 0.0 { away < *radius } else { *has_caps && away.hypot(beyond) < *radius }
            }
        }
    }

    /// Volume and inertia of each shape are those of the small cubes inside of it.
    #[test]
    fn shapes_are_sums_of_cubes() {
        let axis = Vector3::new(0.48, 0.6, 0.64);
        let round = |has_caps| Shape::Round(Round { radius: 0.3, length: 0.7, axis, has_caps });
        let shapes = [Shape::Box(Vector3::new(0.4, 0.9, 1.3)), Shape::Sphere(0.6), round(false), round(true)];
        for shape in shapes {
            let (count, half) = (96, 0.8);
            let edge = 2.0 * half / f64::from(count);
            let at = |k: i32| (f64::from(k) + 0.5) * edge - half;
            let (mut inside, mut inertia) = (0.0, Matrix3::zeros());
            for i in 0..count {
                for j in 0..count {
                    for k in 0..count {
                        let point = Vector3::new(at(i), at(j), at(k));
                        if has(&shape, point) {
                            inside += 1.0;
                            inertia += Matrix3::identity() * point.norm_squared() - point * point.transpose();
                        }
                    }
                }
            }
            let volume = inside * edge.powi(3);
            let inertia = inertia / inside;
            assert!((volume / shape.volume() - 1.0).abs() < 4e-3, "{shape:?}: {volume}, {}", shape.volume());
            let off = (inertia - shape.inertia()).amax() / inertia.amax();
            assert!(off < 4e-3, "{shape:?}: {inertia}, {}", shape.inertia());
        }
    }
}
