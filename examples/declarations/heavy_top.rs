//! The heavy top (3.13).

use liestep::{DiagonalNonstandardInertia, NonstandardInertia, SO3, lagrangian};
use nalgebra::Vector3;

/// The heavy top (3.13) in principal axes.
#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)
        - 0.5 * h * m * g * w.dot(&(rho + F * rho)),
)]
#[derive(Clone, Debug)]
pub struct HeavyTop {
    /// Nonstandard inertia about the pivot, kg m².
    pub J_d: DiagonalNonstandardInertia,
    /// Mass, kg.
    pub m: f64,
    /// Gravitational acceleration, m/s².
    pub g: f64,
    /// Centre of mass from the pivot, body frame, m.
    pub rho: Vector3<f64>,
    /// The vertical, in space.
    pub up: Vector3<f64>,
}

/// The heavy top (3.13) with a full inertia tensor.
#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)
        - 0.5 * h * m * g * w.dot(&(rho + F * rho)),
)]
#[derive(Clone, Debug)]
pub struct FullTop {
    /// Nonstandard inertia about the pivot, kg m².
    pub J_d: NonstandardInertia,
    /// Mass, kg.
    pub m: f64,
    /// Gravitational acceleration, m/s².
    pub g: f64,
    /// Centre of mass from the pivot, body frame, m.
    pub rho: Vector3<f64>,
    /// The vertical, in space.
    pub up: Vector3<f64>,
}
