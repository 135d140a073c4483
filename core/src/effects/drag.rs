//! Viscous drag.

use crate::{SO3, force};

/// A torque `−c Ω` against the body velocity, which `((F − Fᵀ)/2)^∨/h` stands for in a step.
///
/// The energy falls at any strength. Half of the torque acts at either end of the step, so the scheme stays of second
/// order; where `c h` is more than twice a moment of inertia a spin changes its sign from step to step while it decays.
#[force(group = SO3, work = -0.5 * c * vee(F).dot(&(eta + eta_next)))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drag<T = f64> {
    /// Coefficient, N m s.
    pub c: T,
}
