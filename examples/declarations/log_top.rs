//! The heavy top with the geodesic kinetic term.

use liestep::prelude::*;
use nalgebra::Vector3;

/// The heavy top with the geodesic kinetic term `ξ·Jξ/(2h)`, `F = exp(ξ̂)`, which is exact for a sphere.
#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = {
        let xi = log(F);
        xi.dot(&(J * xi)) / (2.0 * h) - 0.5 * h * weight * w.dot(&(rho + F * rho))
    },
)]
#[derive(Clone, Debug)]
pub struct LogTop {
    /// Inertia about the pivot, kg m².
    pub J: Inertia,
    /// Weight `m g`, N.
    pub weight: f64,
    /// Centre of mass from the pivot, body frame, m.
    pub rho: Vector3<f64>,
    /// The vertical, in space.
    pub up: Vector3<f64>,
}
