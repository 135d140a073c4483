//! The heavy top with the Cayley kinetic term.

use liestep::prelude::*;
use nalgebra::Vector3;

/// The heavy top with the Cayley kinetic term: in `x = tan(θ/2) n` its Legendre transform is
/// `h p = 2 (J x + x × J x + (x·J x) x)`, which is solvable for every `h`.
#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = {
        let x = vee(F - F.transpose()) / (1.0 + F.trace());
        2.0 * x.dot(&(J * x)) / h - 0.5 * h * weight * w.dot(&(rho + F * rho))
    },
)]
#[derive(Clone, Debug)]
pub struct CayleyTop {
    /// Inertia about the pivot, kg m².
    pub J: Inertia,
    /// Weight `m g`, N.
    pub weight: f64,
    /// Centre of mass from the pivot, body frame, m.
    pub rho: Vector3<f64>,
    /// The vertical, in space.
    pub up: Vector3<f64>,
}
