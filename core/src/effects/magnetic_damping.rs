//! Damping by a uniform magnetic field.

use nalgebra::Vector3;

use crate::groups::SO3;
use crate::mechanics::Inertia;
use liestep_macros::force;

/// Magnetic damping, the torque `m × B` of a moment `m = −k dB/dt`, with the rate of the field in the body frame,
/// `−Ω × B`.
///
/// Magnetorquers detumble a satellite in this way (the B-dot law), and eddy currents damp a sphere. The power is
/// `−k |B × Ω|²`, so a turn about the field isn't damped, and the momentum along it is conserved.
///
/// Both ends of a step take the field `(b + Fᵀb)/2` of its middle: so that momentum is conserved to rounding, and the
/// energy of a free body with the kinetic term of (3.13) never rises. The gain is `k/√(1 + y²)` with
/// `y = (h/2) k |B|² tr J⁻¹`: of second order where the step resolves the damping, and too little to reverse a spin
/// where it doesn't.
#[force(
    group = SO3,
    gradients,
    advected(b = field),
    work = {
        let y = 0.5 * h * k * b.norm_squared() * inverse(J).trace();
        let after = F.transpose() * b;
        let turn = vee(F);
        // Twice B × (turn × B) for the middle field B = (b + Fᵀb)/2, whose component along the turn is that of b.
        let across = turn * (b.norm_squared() + b.dot(&after)) - (b + after) * b.dot(&turn);
        -0.25 * k / (1.0 + y * y).sqrt() * across.dot(&(eta + eta_next))
    },
)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MagneticDamping<T = f64> {
    /// Gain, A m² s/T.
    pub k: T,
    /// Magnetic flux density, in space, T.
    pub field: Vector3<T>,
    /// Inertia of the scene, kg m²; as in [`Drag`](super::Drag).
    pub J: Inertia<T>,
}
