//! The kinetic energy of a rigid body.

use crate::groups::SO3;
use crate::mechanics::{DiagonalNonstandardInertia, NonstandardInertia};
use liestep_macros::lagrangian;

/// A rigid body about a fixed point or its centre of mass: the kinetic term of (3.13).
///
/// A body without other terms conserves the spatial momentum and the energy to rounding, and not the phase: a spin turns by `asin hΩ` a
/// step, 0.6° too far in each turn at `hΩ` = 0.1. A step has a solution up to `hΩ` = 1 rad. [The table](crate::effects) has
/// other kinetic terms for what spins fast, [`GeodesicBody`](super::GeodesicBody) first.
#[lagrangian(group = SO3, gradients, l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidBody<T = f64> {
    /// Nonstandard inertia about the fixed point or the centre of mass, kg m².
    pub J_d: NonstandardInertia<T>,
}

/// A [`RigidBody`] in its principal axes: the same motion for half the operations of an iteration.
#[lagrangian(group = SO3, gradients, l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrincipalBody<T = f64> {
    /// Nonstandard inertia about the fixed point or the centre of mass, kg m².
    pub J_d: DiagonalNonstandardInertia<T>,
}
