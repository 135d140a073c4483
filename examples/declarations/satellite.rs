//! Gravity gradient without expansion, attitude alone.

use liestep::{NonstandardInertia, SO3, lagrangian};
use nalgebra::Vector3;

/// A satellite with its centre of mass at a fixed position in the 1/r field of an attracting centre.
///
/// It is a hub and two equal masses at the ends of a boom through the hub. The hub is heavy but small: the field acts
/// on its centre alone, without a moment. If the distance to the centre is large against the boom, this is the gravity
/// gradient of textbooks; here the potential of the two masses is the full one. The orbit isn't modelled: the centre
/// has a constant direction in space. [`OrbitingBody`](super::OrbitingBody) moves along its orbit.
#[lagrangian(
    group = SO3,
    advected(c = centre),
    l_d = {
        let d = F - I;
        let kinetic = (d * J_d * d.transpose()).trace() + 2.0 * m * (d * tip).norm_squared();
        let before = 1.0 / (c - tip).norm() + 1.0 / (c + tip).norm();
        let after = 1.0 / (c - F * tip).norm() + 1.0 / (c + F * tip).norm();
        kinetic / (2.0 * h) + 0.5 * h * GM * m * (before + after)
    },
)]
#[derive(Clone, Debug)]
pub struct Satellite {
    /// Nonstandard inertia of the hub about its centre of mass, kg m².
    pub J_d: NonstandardInertia,
    /// Each of the two masses, kg.
    pub m: f64,
    /// One end of the boom, body frame, m; the other is opposite.
    pub tip: Vector3<f64>,
    /// Gravitational constant times the attracting mass, m³/s².
    pub GM: f64,
    /// The attracting centre from the satellite's, in space, m.
    pub centre: Vector3<f64>,
}
