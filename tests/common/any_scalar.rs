//! A top with any scalar: SIMD lanes, dual numbers or plain ones.

use liestep::numbers::Real;
use liestep::prelude::*;
use nalgebra::Vector3;

/// (3.13) in principal axes, for any scalar.
#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)
        - 0.5 * h * weight * w.dot(&(rho + F * rho)),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Top<T: Real> {
    pub J_d: DiagonalNonstandardInertia<T>,
    pub weight: T,
    pub rho: Vector3<T>,
    pub up: Vector3<T>,
}
