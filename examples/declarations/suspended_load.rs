//! A flyer with a load on a cable.

use liestep::groups::R3;
use liestep::{NonstandardInertia, SO3, lagrangian};
use nalgebra::Vector3;

/// A flyer, as a quadrotor, with a load on a cable that is always taut. The load is fixed to the cable and turns with
/// it; its spin about the cable is conserved if `K` is symmetric about it. Rotors are forces of
/// [`step_forced`](liestep::Stepper::step_forced).
#[lagrangian(
    group(F = SO3, d = R3, C = SO3),
    advected(x = d.seen_from(space), R = C.seen_from(space)),
    l_d = {
        let way = d + R * ((C - I) * cable);
        let place = x + R * cable;
        ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) + m * d.norm_squared() / (2.0 * h)
            + ((C - I) * K * (C - I).transpose()).trace() / (2.0 * h) + m_load * way.norm_squared() / (2.0 * h)
            - 0.5 * h * g * up.dot(&(m * (x + x + d) + m_load * (place + place + way)))
    },
)]
#[derive(Clone, Debug)]
pub struct SuspendedLoad {
    /// Nonstandard inertia of the flyer about its centre of mass, kg m².
    pub J_d: NonstandardInertia,
    /// Mass of the flyer, kg.
    pub m: f64,
    /// Nonstandard inertia of the load about its centre of mass, kg m²; not zero about the cable.
    pub K: NonstandardInertia,
    /// Mass of the load, kg.
    pub m_load: f64,
    /// Vector from the flyer's centre of mass to the load's, in the axes of the load, m.
    pub cable: Vector3<f64>,
    /// Gravitational acceleration, m/s².
    pub g: f64,
    /// The vertical, in space.
    pub up: Vector3<f64>,
}
