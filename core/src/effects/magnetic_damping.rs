//! Damping by a uniform magnetic field.

use nalgebra::Vector3;

use crate::{SO3, force};

/// The torque `m × B` of a magnetic moment `m = −k dB/dt` against the change of the field that the body sees, `−Ω × B`.
///
/// It is what magnetorquers do to detumble a satellite (the B-dot law), and what eddy currents do in a sphere. The power
/// is `−k |B × Ω|²`, so a turn about the field isn't damped, and the momentum along it is conserved.
#[force(
    group = SO3,
    advected(b = field),
    work = {
        let after = F.transpose() * b;
        -0.5 * k * (b.cross(&vee(F)).dot(&b.cross(&eta)) + after.cross(&vee(F)).dot(&after.cross(&eta_next)))
    },
)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MagneticDamping<T = f64> {
    /// Gain, A m² s/T.
    pub k: T,
    /// Magnetic flux density, in space, T.
    pub field: Vector3<T>,
}
