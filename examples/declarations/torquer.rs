//! Coils that a satellite's computer switches, in the field of the Earth.

use liestep::{SO3, lagrangian};
use nalgebra::Vector3;

/// A magnetic moment that is prescribed for each step, in a field that may be prescribed, too: the potential is `−m·B`.
#[lagrangian(group = SO3, advected(b = field), given(m = moment), l_d = 0.5 * h * m.dot(&(b + F.transpose() * b)))]
#[derive(Clone, Copy, Debug)]
pub struct Torquer {
    /// Magnetic moment, body frame, A m².
    pub moment: Vector3<f64>,
    /// Magnetic flux density, in space, T.
    pub field: Vector3<f64>,
}
