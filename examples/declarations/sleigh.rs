//! Chaplygin's sleigh.

use liestep::groups::SE2;
use liestep::{lagrangian, nonholonomic};

/// A plate that slides on a plane; the body's frame is at a point of it.
#[lagrangian(
    group = SE2,
    velocity = xi,
    l = 0.5 * m * ((xi[1]).powi(2) + (xi[2] + a * xi[0]).powi(2)) + 0.5 * J * (xi[0]).powi(2),
    discretise = trapezoid(Cayley),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plate {
    /// Mass, kg.
    pub m: f64,
    /// Moment of inertia about the centre of mass, kg m².
    pub J: f64,
    /// Distance of the centre of mass from the frame's origin, along its first axis, m.
    pub a: f64,
}

/// A blade at the origin of the body's frame, along its first axis: it doesn't slide sidewards, as a skate.
#[nonholonomic(group = SE2, velocity = xi, zero = sideways * xi[2])]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blade {
    /// The scale of the constraint, one: any other number has the same motion.
    pub sideways: f64,
}
