//! A spring to a point fixed in space.

use nalgebra::Vector3;

use crate::groups::SO3;
use liestep_macros::lagrangian;

/// A linear spring from a point of the body to a point of space, both from the fixed point that the body turns about.
///
/// The two points mustn't meet, as the force has no direction there.
#[lagrangian(
    group = SO3,
    gradients,
    advected(a = anchor),
    l_d = -0.25 * h * k * (((at - a).norm() - length).powi(2) + ((F * at - a).norm() - length).powi(2)),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spring<T = f64> {
    /// Stiffness, N/m.
    pub k: T,
    /// Length at rest, m.
    pub length: T,
    /// The end on the body, body frame, m.
    pub at: Vector3<T>,
    /// The other end, in space, m.
    pub anchor: Vector3<T>,
}
