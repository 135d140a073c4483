//! Bodies with rotation and translation, and the elements of an elastic rod between neighbours.

use liestep::groups::R3;
use liestep::{NonstandardInertia, SO3, lagrangian};
use nalgebra::Vector3;

/// A body without forces.
#[lagrangian(
    group(F = SO3, d = R3),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) + m * d.norm_squared() / (2.0 * h),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FloatingBody<T = f64> {
    /// Mass, kg.
    pub m: T,
    /// Nonstandard inertia about the centre of mass, kg m².
    pub J_d: NonstandardInertia<T>,
}

/// A body under uniform gravity.
#[lagrangian(
    group(F = SO3, d = R3),
    advected(x = d.seen_from(space)),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) + m * d.norm_squared() / (2.0 * h)
        - 0.5 * h * m * g * (x + x + d).dot(&up),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FallingBody<T = f64> {
    /// Mass, kg.
    pub m: T,
    /// Nonstandard inertia about the centre of mass, kg m².
    pub J_d: NonstandardInertia<T>,
    /// Gravitational acceleration, m/s².
    pub g: T,
    /// The vertical, in space.
    pub up: Vector3<T>,
}

/// A spring of zero length at rest between points of two bodies, by the mean of its potentials at both ends of a step.
#[lagrangian(
    group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
    advected(R_1 = F_1.seen_from(space), R_2 = F_2.seen_from(space), r = d_2.seen_from(d_1)),
    l_d = -0.25 * h * k * ((r + R_2 * b - R_1 * a).norm_squared()
        + (r + d_2 - d_1 + R_2 * F_2 * b - R_1 * F_1 * a).norm_squared()),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointSpring<T = f64> {
    /// Stiffness, N/m.
    pub k: T,
    /// The point of the first body, from its centre of mass, body frame, m.
    pub a: Vector3<T>,
    /// The point of the second body, from its centre of mass, body frame, m.
    pub b: Vector3<T>,
}

/// An element of an elastic rod between the end `a` of one body and the end `b` of the next, which resists shift and
/// bending. Strains are the means of those at both ends of a step.
#[lagrangian(
    group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
    advected(R = F_1.seen_from(space), Q = F_2.seen_from(F_1), r = d_2.seen_from(d_1)),
    l_d = {
        let shift = (R.transpose() * r + Q * b + F_1.transpose() * (R.transpose() * (r + d_2 - d_1) + Q * F_2 * b)) * 0.5 - a;
        let bend = (vee(Q) + vee(F_1.transpose() * Q * F_2)) * 0.5;
        -0.5 * h * (k * shift.norm_squared() + c * bend.norm_squared())
    },
)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RodElement<T = f64> {
    /// Stiffness against shifts, N/m.
    pub k: T,
    /// Stiffness against turns, N m.
    pub c: T,
    /// The end of the first body, from its centre of mass, body frame, m.
    pub a: Vector3<T>,
    /// The end of the next body, from its centre of mass, body frame, m.
    pub b: Vector3<T>,
}
