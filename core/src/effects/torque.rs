//! A torque that is constant in the body.

use nalgebra::Vector3;

use crate::groups::SO3;
use liestep_macros::force;

/// A torque that is constant in the body frame, as that of a thruster.
#[force(group = SO3, gradients, work = 0.5 * h * torque.dot(&(eta + eta_next)))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Torque<T = f64> {
    /// Torque, body frame, N m.
    pub torque: Vector3<T>,
}
