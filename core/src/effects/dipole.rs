//! A magnetic dipole in a uniform field.

use nalgebra::Vector3;

use crate::groups::SO3;
use liestep_macros::lagrangian;

/// A magnetic moment fixed in the body, in a uniform field: the energy `−m·B`.
#[lagrangian(group = SO3, gradients, advected(b = field), l_d = 0.5 * h * b.dot(&(moment + F * moment)))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dipole<T = f64> {
    /// Magnetic moment, body frame, A m².
    pub moment: Vector3<T>,
    /// Magnetic flux density, in space, T.
    pub field: Vector3<T>,
}
