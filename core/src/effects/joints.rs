//! Springs, friction and motors in the joints of a [`Multibody`](crate::methods::Multibody) system: terms
//! [between](crate::methods::Multibody::between) two bodies, or between space and a body.
//!
//! | turns | shifts in a slider | |
//! |---|---|---|
//! | [`JointSpring`] | [`SliderSpring`] | energies `½ k θ²`, `½ k (s − l)² − f (s − l)` |
//! | [`JointDamping`] | [`SliderDamping`] | viscous friction, `−c ω` and `−c v` |
//! | [`DryFriction`] | [`SliderFriction`] | dry friction, `−τ ω/√(|ω|² + v²)` and `−f v/√(v² + u²)` |
//! | [`JointTorque`] | | a motor's constant torque |
//! | [`Armature`] | [`SliderArmature`] | inertia of a motor's rotor, energies `½ a ω²` and `½ a v²` |
//!
//! Friction and rotors couple the steps of their bodies, so that no coefficient is too large for a step; springs and motors are
//! kicks.

use nalgebra::{Matrix3, Vector3};

use crate::groups::{R3, SO3};
use liestep_macros::{force, lagrangian};

roots!();

/// A spring of turning in a joint: the energy `½ k θ²` of the angle `θ` of `R_1ᵀ R_2 Q₀ᵀ` with the attitude `Q₀` at rest, half of
/// its impulse at either end of a step. It is for a pin, a universal joint, a ball joint and a cylinder; at half a turn from rest
/// its torque has no direction.
#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(Q = F_2.seen_from(F_1)),
    l_d = -0.25 * h * k * (log(Q * rest.transpose()).norm_squared()
        + log(F_1.transpose() * Q * F_2 * rest.transpose()).norm_squared()),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointSpring {
    /// Stiffness, N m/rad.
    pub k: f64,
    /// The attitude `R_1ᵀ R_2` at rest, a rotation.
    pub rest: Matrix3<f64>,
}

/// Viscous friction of turning in a joint: the torque `−c ω` against the angular velocity of the second body relative to the first,
/// by the turn in a step, half of its impulse at either end. Its work is negative at any strength.
#[force(
    group(F_1 = SO3, F_2 = SO3),
    advected(Q = F_2.seen_from(F_1)),
    displacement(eta_1, eta_2),
    work = {
        let turn = Q * log(F_2) - log(F_1);
        -0.5 * c * (turn.dot(&(Q * eta_2 - eta_1)) + turn.dot(&(Q * (F_2 * eta_2_next) - F_1 * eta_1_next)))
    },
)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointDamping {
    /// Coefficient, N m s.
    pub c: f64,
}

/// Dry friction of turning in a joint, regularised: the torque `−τ ω / √(|ω|² + v²)` against the relative angular velocity. Faster
/// than the rate `v` it is nearly `τ`; slower than that it is viscous, so that a joint creeps where it would stick.
#[force(
    group(F_1 = SO3, F_2 = SO3),
    advected(Q = F_2.seen_from(F_1)),
    displacement(eta_1, eta_2),
    work = {
        let turn = Q * vee(F_2) - vee(F_1);
        let share = 0.5 * torque / (turn.norm_squared() / (h * h) + rate * rate).sqrt();
        -share * (turn.dot(&(Q * eta_2 - eta_1)) + turn.dot(&(Q * (F_2 * eta_2_next) - F_1 * eta_1_next)))
    },
)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DryFriction {
    /// The torque `τ` of sliding, N m.
    pub torque: f64,
    /// The rate `v` below which friction is viscous, rad/s, above zero.
    pub rate: f64,
}

/// A constant torque of a motor in a joint, on the second body about its axis and on the first one against it, half of its impulse
/// at either end of a step.
#[force(
    group(F_1 = SO3, F_2 = SO3),
    displacement(eta_1, eta_2),
    work = 0.5 * h * torque * (axis_2.dot(&(eta_2 + eta_2_next)) - axis_1.dot(&(eta_1 + eta_1_next))),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointTorque {
    /// Torque, N m.
    pub torque: f64,
    /// The unit vector of the joint's axis in the axes of each body.
    pub axis_1: Vector3<f64>,
    /// The unit vector in the axes of the second body.
    pub axis_2: Vector3<f64>,
}

/// A spring and a constant force in a slider: the energy `½ k (s − l)² − f (s − l)` of the shift `s` of a point of the second body
/// from the origin of the first, along an axis of the first; half of its impulse at either end of a step.
#[lagrangian(
    group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
    advected(R_1 = F_1.seen_from(space), R_2 = F_2.seen_from(space), r = d_2.seen_from(d_1)),
    l_d = {
        let before = (R_1 * axis).dot(&(r + R_2 * at_2)) - rest;
        let after = (R_1 * F_1 * axis).dot(&(r + d_2 - d_1 + R_2 * F_2 * at_2)) - rest;
        -0.25 * h * k * (before * before + after * after) + 0.5 * h * force * (before + after)
    },
)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SliderSpring {
    /// Stiffness, N/m.
    pub k: f64,
    /// The shift `l` at rest, m.
    pub rest: f64,
    /// The force `f` on the second body, N.
    pub force: f64,
    /// The unit vector of the axis, in the axes of the first body.
    pub axis: Vector3<f64>,
    /// The point of the second body, in its axes, m.
    pub at_2: Vector3<f64>,
}

/// Viscous friction in a slider: the force `−c v` against the velocity `v` of the shift of [`SliderSpring`], at its point; `v` is the
/// shift in a step over the step. Its work is negative at any strength.
#[force(
    group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
    advected(R_1 = F_1.seen_from(space), R_2 = F_2.seen_from(space), r = d_2.seen_from(d_1)),
    displacement(eta_1, xi_1, eta_2, xi_2),
    work = {
        let A = R_1 * F_1;
        let B = R_2 * F_2;
        let y = R_1.transpose() * (r + R_2 * at_2);
        let z = A.transpose() * (r + d_2 - d_1 + B * at_2);
        let before = R_1.transpose() * (xi_2 + R_2 * eta_2.cross(&at_2) - xi_1) - eta_1.cross(&y);
        let after = A.transpose() * (xi_2_next + B * eta_2_next.cross(&at_2) - xi_1_next) - eta_1_next.cross(&z);
        -0.5 * c * axis.dot(&(z - y)) * axis.dot(&(before + after))
    },
)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SliderDamping {
    /// Coefficient, N s/m.
    pub c: f64,
    /// The unit vector of the axis, in the axes of the first body.
    pub axis: Vector3<f64>,
    /// The point of the second body where friction acts, in its axes, m.
    pub at_2: Vector3<f64>,
}

/// Dry friction in a slider, regularised: the force `−f v/√(v² + u²)` against the velocity `v` of [`SliderDamping`]. Faster than the
/// speed `u` it is nearly `f`; slower than that it is viscous, so that a slider creeps where it would stick.
///
/// An impulse of half a step, `h f/2`, that is larger than the momentum turns the velocity round at nearly its size: places then stay, and
/// shorter steps or a larger `u` have a velocity that falls to zero.
#[force(
    group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
    advected(R_1 = F_1.seen_from(space), R_2 = F_2.seen_from(space), r = d_2.seen_from(d_1)),
    displacement(eta_1, xi_1, eta_2, xi_2),
    work = {
        let A = R_1 * F_1;
        let B = R_2 * F_2;
        let y = R_1.transpose() * (r + R_2 * at_2);
        let z = A.transpose() * (r + d_2 - d_1 + B * at_2);
        let before = R_1.transpose() * (xi_2 + R_2 * eta_2.cross(&at_2) - xi_1) - eta_1.cross(&y);
        let after = A.transpose() * (xi_2_next + B * eta_2_next.cross(&at_2) - xi_1_next) - eta_1_next.cross(&z);
        let shift = axis.dot(&(z - y));
        -0.5 * force * shift / (shift * shift / (h * h) + speed * speed).sqrt() * axis.dot(&(before + after))
    },
)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SliderFriction {
    /// The force `f` of sliding, N.
    pub force: f64,
    /// The speed `u` below which friction is viscous, m/s, above zero.
    pub speed: f64,
    /// The unit vector of the axis, in the axes of the first body.
    pub axis: Vector3<f64>,
    /// The point of the second body where friction acts, in its axes, m.
    pub at_2: Vector3<f64>,
}

/// The inertia of a motor's rotor in a joint that turns, as the joint feels it behind its gear: the kinetic energy `½ a ω²` of the
/// angular velocity `ω` of the second body relative to the first, by the turn in a step. It is added to the kinetic energies of
/// both bodies.
#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(Q = F_2.seen_from(F_1)),
    l_d = a * log(Q.transpose() * F_1.transpose() * Q * F_2).norm_squared() / (2.0 * h),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Armature {
    /// Inertia `a`, kg m²: that of the rotor times the square of the gear's ratio.
    pub a: f64,
}

/// The inertia of a motor's rotor in a slider, as the slider feels it: the kinetic energy `½ a v²` of the velocity `v` of the shift of
/// [`SliderSpring`].
#[lagrangian(
    group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
    advected(R_1 = F_1.seen_from(space), R_2 = F_2.seen_from(space), r = d_2.seen_from(d_1)),
    l_d = {
        let before = (R_1 * axis).dot(&(r + R_2 * at_2));
        let after = (R_1 * F_1 * axis).dot(&(r + d_2 - d_1 + R_2 * F_2 * at_2));
        let shift = after - before;
        a * shift * shift / (2.0 * h)
    },
)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SliderArmature {
    /// Inertia `a`, kg.
    pub a: f64,
    /// The unit vector of the axis, in the axes of the first body.
    pub axis: Vector3<f64>,
    /// The point of the second body, in its axes, m.
    pub at_2: Vector3<f64>,
}
