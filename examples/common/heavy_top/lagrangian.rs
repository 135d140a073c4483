//! The declaration that the integrator is made from.

use liestep::{DiagonalNonstandardInertia, SO3, lagrangian};
use nalgebra::Vector3;

/// A heavy top: the reduced discrete Lagrangian \[RDAE, (3.13)\].
#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)
        - 0.5 * h * m * g * w.dot(&(rho + F * rho)),
)]
#[allow(non_snake_case)] // the paper's name
#[derive(Clone, Debug)]
pub(crate) struct HeavyTop {
    /// Nonstandard inertia about the pivot, kg m².
    pub(crate) J_d: DiagonalNonstandardInertia,
    /// Mass, kg.
    pub(crate) m: f64,
    /// Gravitational acceleration, m/s².
    pub(crate) g: f64,
    /// Centre of mass from the pivot, body frame, m.
    pub(crate) rho: Vector3<f64>,
    /// The vertical, in the inertial frame; `w` is the same vector seen from the body.
    pub(crate) up: Vector3<f64>,
}
