//! The kinetic energy of a rigid body along geodesics.

use crate::groups::SO3;
use crate::mechanics::Inertia;
use liestep_macros::lagrangian;

/// A rigid body with the geodesic kinetic term `ξ·Jξ/(2h)`, `F = exp(ξ̂)`: of second order, and exact for a sphere and
/// for a spin about a principal axis.
///
/// The error is several times below that of [`RigidBody`](super::RigidBody), whose phase is off by the part `(hΩ)²/6`, and a
/// step may turn by more than a right angle; the energy of a free body oscillates.
#[lagrangian(
    group = SO3,
    gradients,
    l_d = {
        let xi = log(F);
        xi.dot(&(J * xi)) / (2.0 * h)
    },
)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GeodesicBody<T = f64> {
    /// Inertia about the fixed point or the centre of mass, kg m².
    pub J: Inertia<T>,
}
