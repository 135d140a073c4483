//! The torque of a field of gravity that isn't uniform over the body.

use nalgebra::Vector3;

use crate::groups::SO3;
use crate::mechanics::Inertia;
use liestep_macros::lagrangian;

/// The second-order term of the potential of a body about its centre of mass in the field of a far point mass,
/// `3 GM/(2 r³) n·Jn` with the direction `n` of that mass; it turns the axis of the least moment into that direction.
///
/// The direction is fixed in space. For a satellite on an orbit, [`step_with`](crate::Stepper::step_with) prescribes
/// the planet's direction in the middle of each step.
#[lagrangian(
    group = SO3,
    gradients,
    advected(n = direction),
    l_d = {
        let after = F.transpose() * n;
        -0.75 * h * GM / r.powi(3) * (n.dot(&(J * n)) + after.dot(&(J * after)))
    },
)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GravityGradient<T = f64> {
    /// The gravitational parameter of the far mass, m³/s².
    pub GM: T,
    /// Distance of the far mass, m.
    pub r: T,
    /// Inertia of the body about its centre of mass, kg m².
    pub J: Inertia<T>,
    /// Direction of the far mass, in space; of length one.
    pub direction: Vector3<T>,
}
