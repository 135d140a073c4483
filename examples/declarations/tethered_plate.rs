//! A planar body on a tether.

use liestep::groups::SE2;
use liestep::lagrangian;
use nalgebra::{Matrix3, Point2};

/// A rigid body in the plane, with an elastic tether between one of its points and a point of the plane.
///
/// Points are written in homogeneous coordinates, `(x, y, 1)`. The anchor is a point of space, which is advected.
#[lagrangian(
    group = SE2,
    advected(a = anchor),
    l_d = {
        let kinetic = ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h);
        let before = (a - p).norm() - length;
        let after = (a - F * p).norm() - length;
        kinetic - 0.25 * h * k * (before.powi(2) + after.powi(2))
    },
)]
#[derive(Clone, Debug)]
pub struct TetheredPlate {
    /// `∫ X Xᵀ dm` in homogeneous coordinates: second moments in kg m², first in kg m, mass in kg.
    pub J: Matrix3<f64>,
    /// Stiffness, N/m.
    pub k: f64,
    /// Length of the tether at rest, m.
    pub length: f64,
    /// The tether's end on the body, body frame.
    pub p: Point2<f64>,
    /// The tether's end in the plane.
    pub anchor: Point2<f64>,
}
