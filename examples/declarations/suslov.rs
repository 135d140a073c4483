//! Suslov's problem: a body that can't turn about an axis of its own.

use liestep::{SO3, nonholonomic};
use nalgebra::Vector3;

/// A constraint on a body's angular velocity, which has no component about an axis that is fixed in the body: as wheels
/// with sharp edges on a sphere around it would do it, after Suslov and Vagner. It adds to any scene on SO(3).
#[nonholonomic(group = SO3, velocity = Omega, zero = a.dot(&Omega))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Suslov {
    /// The axis, body frame.
    pub a: Vector3<f64>,
}
