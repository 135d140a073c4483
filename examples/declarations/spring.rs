//! A body on a spring.

use liestep::{NonstandardInertia, SO3, lagrangian};
use nalgebra::Vector3;

/// A body about a pivot, with a spring between one of its points and a point of space.
#[lagrangian(
    group = SO3,
    advected(a = anchor),
    l_d = {
        let kinetic = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h);
        let before = (a - rho).norm() - length;
        let after = (a - F * rho).norm() - length;
        kinetic - 0.25 * h * k * (before.powi(2) + after.powi(2))
    },
)]
#[derive(Clone, Debug)]
pub struct Spring {
    /// Nonstandard inertia about the pivot, kg m².
    pub J_d: NonstandardInertia,
    /// Stiffness, N/m.
    pub k: f64,
    /// Length of the spring at rest, m.
    pub length: f64,
    /// The spring's end on the body, from the pivot, body frame, m.
    pub rho: Vector3<f64>,
    /// The spring's end in space, from the pivot, m.
    pub anchor: Vector3<f64>,
}
