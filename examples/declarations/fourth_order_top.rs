//! The heavy top to the fourth order.

use liestep::prelude::*;
use nalgebra::Vector3;

/// The heavy top to the fourth order in one solve: the action of a path that satisfies the equations of motion to first
/// order, with the correction of the trapezoidal rule by the torque `f` and the change of the potential. In the small
/// terms `x = 2 sin(θ/2) n` replaces the rotation vector, with which it agrees to their order.
#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = {
        let xi = log(F);
        let x = 2.0 * vee(F) / (1.0 + F.trace()).sqrt();
        let next = F.transpose() * w;
        let f = (J * x).cross(&x) / h.powi(2) + 0.5 * weight * (w + next).cross(&rho);
        xi.dot(&(J * xi)) / (2.0 * h) - 0.5 * h * weight * (w + next).dot(&rho)
            + (h / 12.0) * weight * (next - w).cross(&x).dot(&rho)
            - (h.powi(3) / 24.0) * f.dot(&(inverse(J) * f))
    },
)]
#[derive(Clone, Debug)]
pub struct FourthOrderTop {
    /// Inertia about the pivot, kg m².
    pub J: Inertia,
    /// Weight `m g`, N.
    pub weight: f64,
    /// Centre of mass from the pivot, body frame, m.
    pub rho: Vector3<f64>,
    /// The vertical, in space.
    pub up: Vector3<f64>,
}
