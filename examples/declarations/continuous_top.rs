//! The heavy top by its continuous Lagrangian, discretised in the thesis' way.

use liestep::mechanics::DiagonalNonstandardInertia;
use liestep::{SO3, lagrangian};
use nalgebra::Vector3;

/// The heavy top of section 3.2: `l(Ω, w) = ½ tr(Ω̂ J_d Ω̂ᵀ) − m g ⟨w, ρ⟩`.
///
/// `discretise = trapezoid` replaces `Ω̂` by `(F − I)/h` and evaluates the potential at both ends of a step. The result
/// is (3.13): the steps are those of [`HeavyTop`](crate::HeavyTop), to the bit.
#[lagrangian(
    group = SO3,
    velocity = Omega,
    advected(w = up),
    l = 0.5 * (hat(Omega) * J_d * hat(Omega).transpose()).trace() - m * g * w.dot(&rho),
    discretise = trapezoid,
)]
#[derive(Clone, Debug)]
pub struct ContinuousTop {
    /// Nonstandard inertia about the pivot, principal axes, kg m².
    pub J_d: DiagonalNonstandardInertia,
    /// Mass, kg.
    pub m: f64,
    /// Gravitational acceleration, m/s².
    pub g: f64,
    /// Centre of mass from the pivot, body frame, m.
    pub rho: Vector3<f64>,
    /// The vertical, in the inertial frame.
    pub up: Vector3<f64>,
}
