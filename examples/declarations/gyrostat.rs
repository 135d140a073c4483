//! A spacecraft with reaction wheels.

use liestep::groups::R1;
use liestep::{NonstandardInertia, SO3, lagrangian};
use nalgebra::Vector3;

/// A spacecraft with three reaction wheels: the angles of the wheels are relative to the body, about the wheels' axes.
#[lagrangian(
    group(F = SO3, t_1 = R1, t_2 = R1, t_3 = R1),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)
        + J_w * ((t_1 + a_1.dot(&vee(F))).powi(2) + (t_2 + a_2.dot(&vee(F))).powi(2) + (t_3 + a_3.dot(&vee(F))).powi(2))
            / (2.0 * h),
)]
#[derive(Clone, Debug)]
pub struct Gyrostat {
    /// Nonstandard inertia of the body with its wheels, without the wheels' moments about their axes, kg m².
    pub J_d: NonstandardInertia,
    /// A wheel's moment about its axis, kg m².
    pub J_w: f64,
    /// The first wheel's axis, a unit vector in the body.
    pub a_1: Vector3<f64>,
    /// The second wheel's axis, a unit vector in the body.
    pub a_2: Vector3<f64>,
    /// The third wheel's axis, a unit vector in the body.
    pub a_3: Vector3<f64>,
}
