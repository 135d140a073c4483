//! A top whose inertia depends on its attitude.

use liestep::{NonstandardInertia, SO3, lagrangian};
use nalgebra::Vector3;

/// A top on a smooth horizontal plane. Its tip slides without friction, so its centre of mass moves along a vertical,
/// with the velocity `(w·(F − I) ρ)/h`: the mass adds to the inertia of a tilted top, and not to that of an upright
/// one.
#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)
        + m * w.dot(&((F - I) * rho)).powi(2) / (2.0 * h)
        - 0.5 * h * m * g * w.dot(&(rho + F * rho)),
)]
#[derive(Clone, Debug)]
pub struct SlidingTop {
    /// Nonstandard inertia about the centre of mass, kg m².
    pub J_d: NonstandardInertia,
    /// Mass, kg.
    pub m: f64,
    /// Gravitational acceleration, m/s².
    pub g: f64,
    /// Centre of mass from the tip, body frame, m.
    pub rho: Vector3<f64>,
    /// The vertical, in space.
    pub up: Vector3<f64>,
}
