//! A rotor inside the body.

use nalgebra::Vector3;

use crate::groups::SO3;
use liestep_macros::lagrangian;

/// A balanced rotor on an axis fixed in the body, with a constant momentum about it: the Lagrangian `s·Ω`.
///
/// The body's inertia includes the rotor's, except for the moment about the rotor's axis. The momentum of the state is
/// that of the whole system, `JΩ + s`.
#[lagrangian(group = SO3, gradients, l_d = spin.dot(&vee(F)))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rotor<T = f64> {
    /// The rotor's momentum about its axis, body frame, kg m²/s.
    pub spin: Vector3<T>,
}
