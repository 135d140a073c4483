//! A thruster.

use nalgebra::Vector3;

use crate::groups::SO3;
use liestep_macros::force;

/// The thrust of an engine that is fixed to the body: a force that turns with it, of constant size, with the torque
/// `at × thrust` about the point that the body turns about.
///
/// A follower force has no potential, so the energy may grow or fall, and no momentum is conserved.
#[force(group = SO3, gradients, work = 0.5 * h * at.cross(&thrust).dot(&(eta + eta_next)))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thrust<T = f64> {
    /// Point of the body at which the engine pushes, body frame, m.
    pub at: Vector3<T>,
    /// The force on the body, body frame, N.
    pub thrust: Vector3<T>,
}
