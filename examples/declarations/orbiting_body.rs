//! Gravity gradient without expansion, orbit and attitude together.

use liestep::groups::SE3;
use liestep::lagrangian;
use nalgebra::{Matrix4, Point3};

/// A rigid body in the 1/r field of a centre fixed in space, attracted at two of its points.
///
/// Orbit and attitude are coupled. Points are written in homogeneous coordinates, `(x, y, z, 1)`; the centre is a point
/// of space, which is advected. As `F` preserves their distances, `‖F⁻¹c − p‖ = ‖c − F p‖`.
#[lagrangian(
    group = SE3,
    advected(c = centre),
    l_d = {
        let d = F - I;
        let kinetic = (d * J * d.transpose()).trace() / (2.0 * h);
        let before = m1 / (c - p1).norm() + m2 / (c - p2).norm();
        let after = m1 / (c - F * p1).norm() + m2 / (c - F * p2).norm();
        kinetic + 0.5 * h * GM * (before + after)
    },
)]
#[derive(Clone, Debug)]
pub struct OrbitingBody {
    /// `∫ X Xᵀ dm` of the whole body in homogeneous coordinates: second moments in kg m², first in kg m, mass in kg.
    pub J: Matrix4<f64>,
    /// The mass attracted at the first point, kg.
    pub m1: f64,
    /// The first point, body frame.
    pub p1: Point3<f64>,
    /// The mass attracted at the second point, kg.
    pub m2: f64,
    /// The second point, body frame.
    pub p2: Point3<f64>,
    /// Gravitational constant times the attracting mass, m³/s².
    pub GM: f64,
    /// The attracting centre, in space.
    pub centre: Point3<f64>,
}
