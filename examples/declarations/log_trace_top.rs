//! The integrable discrete Lagrange top.

use liestep::{SO3, lagrangian};
use nalgebra::Vector3;

/// The discrete Lagrange top of Bobenko and Suris (1999); the spin about the axis enters only through `p₃`.
///
/// Its potential is evaluated at one end of the step, so it isn't self-adjoint and its momentum is of first order;
/// `p + (h/2) m g w × ρ` is of second order.
#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = -(2.0 * I1 / h) * ((1.0 + F.trace()) / 4.0).ln() - h * weight * w.dot(&rho),
)]
#[derive(Clone, Debug)]
pub struct LogTraceTop {
    /// Moment of inertia about an axis through the pivot and normal to that of the top, kg m².
    pub I1: f64,
    /// Weight `m g`, N.
    pub weight: f64,
    /// Centre of mass from the pivot, body frame, m.
    pub rho: Vector3<f64>,
    /// The vertical, in space.
    pub up: Vector3<f64>,
}
