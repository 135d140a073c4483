//! Uniform gravity.

use nalgebra::Vector3;

use crate::groups::SO3;
use liestep_macros::lagrangian;

/// The weight of a body that turns about a fixed point: the potential term of (3.13).
#[lagrangian(group = SO3, gradients, advected(w = up), l_d = -0.5 * h * m * g * w.dot(&(rho + F * rho)))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gravity<T = f64> {
    /// Mass, kg.
    pub m: T,
    /// Gravitational acceleration, m/s².
    pub g: T,
    /// Centre of mass from the fixed point, body frame, m.
    pub rho: Vector3<T>,
    /// The vertical, in space; of length one.
    pub up: Vector3<T>,
}
