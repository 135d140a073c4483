//! A disk that rolls on a plane.

use liestep::groups::SE3;
use liestep::{lagrangian, nonholonomic};
use nalgebra::{Matrix3, Vector3, Vector4};

/// A rigid body in space, with its frame at its centre of mass, and its weight.
#[lagrangian(
    group = SE3,
    advected(w = height),
    velocity(Omega, v),
    l = 0.5 * Omega.dot(&(J * Omega)) + 0.5 * m * v.norm_squared() - m * g * w[3],
    discretise = trapezoid(Cayley),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FallingDisk {
    /// Inertia about the centre of mass, body frame, kg m².
    pub J: Matrix3<f64>,
    /// Mass, kg.
    pub m: f64,
    /// Gravitational acceleration, m/s².
    pub g: f64,
    /// The height as a function of the position, in space: `(0, 0, 1, 0)`.
    pub height: Vector4<f64>,
}

/// One component, along `e`, of rolling: the disk's point that touches the plane doesn't move. The contact is as far from the
/// centre as the radius, in the disk's plane, below.
#[nonholonomic(
    group = SE3,
    advected(w = height),
    velocity(Omega, v),
    zero = {
        let across = Vector3::new(w[0], w[1], 0.0);
        let contact = across * (-radius / across.norm());
        e.dot(&(v + Omega.cross(&contact)))
    },
)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rolling {
    /// The direction, body frame; three of them hold the contact.
    pub e: Vector3<f64>,
    /// The disk's radius, m; its axis is the third of the body.
    pub radius: f64,
    /// The height as a function of the position, in space: `(0, 0, 1, 0)`.
    pub height: Vector4<f64>,
}
