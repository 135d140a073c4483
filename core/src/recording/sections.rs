//! Functions of a rotating body whose zeros are events: Poincaré sections, the passage of the vertical, the end of a
//! tumble.
//!
//! [`Run::event`](crate::recording::Run::event) takes them. Each has a bound of its second derivative, for
//! [`Event::curvature`](crate::recording::Event::curvature); `Ω` is the body velocity.

use nalgebra::Vector3;

use crate::groups::{Advected, SO3};
use crate::motion::{Integrator, Moment, Motion};
use crate::numbers::Real;

/// The section `n·R b`: a body axis `b` passes the plane with the normal `n` in space, through the pivot.
///
/// Its second derivative is at most `|n||b| (|Ω|² + |Ω̇|)`.
pub fn plane<I, A, T>(axis: Vector3<T>, normal: Vector3<T>) -> impl Fn(&Moment<'_, I>) -> I::Scalar
where
    T: Real,
    A: Advected<SO3<T>>,
    I: Integrator<Scalar = T, Motion = Motion<SO3<T>, A>, Velocity = Vector3<T>>,
{
    move |now| normal.dot(&(now.attitude().as_matrix() * axis))
}

/// The section `u·R b − c`: a body axis `b` passes the cone about the direction `u` in space whose angle has the cosine
/// `c`; both are unit vectors.
///
/// Its second derivative is at most `|Ω|² + |Ω̇|`.
pub fn cone<I, A, T>(axis: Vector3<T>, direction: Vector3<T>, cosine: T) -> impl Fn(&Moment<'_, I>) -> I::Scalar
where
    T: Real,
    A: Advected<SO3<T>>,
    I: Integrator<Scalar = T, Motion = Motion<SO3<T>, A>, Velocity = Vector3<T>>,
{
    move |now| direction.dot(&(now.attitude().as_matrix() * axis)) - cosine
}

/// The section `d/dt (u·R b) = u·R (Ω × b)`: when it falls through zero a body axis `b` is nearest to the direction `u`
/// in space, with `u` upwards the vertical; when it rises it is farthest away.
///
/// Its second derivative is at most `|u||b| (|Ω|³ + 3 |Ω||Ω̇| + |Ω̈|)`.
pub fn passage<I, A, T>(axis: Vector3<T>, direction: Vector3<T>) -> impl Fn(&Moment<'_, I>) -> I::Scalar
where
    T: Real,
    A: Advected<SO3<T>>,
    I: Integrator<Scalar = T, Motion = Motion<SO3<T>, A>, Velocity = Vector3<T>>,
{
    move |now| direction.dot(&(now.attitude().as_matrix() * now.velocity().cross(&axis)))
}

/// The section `|Ω|² − v²`, rad²/s²: when it falls through zero a body is detumbled, for the limit `v`.
///
/// Its second derivative is at most `2 (|Ω̇|² + |Ω||Ω̈|)`.
pub fn speed<I, A, T>(limit: T) -> impl Fn(&Moment<'_, I>) -> I::Scalar
where
    T: Real,
    A: Advected<SO3<T>>,
    I: Integrator<Scalar = T, Motion = Motion<SO3<T>, A>, Velocity = Vector3<T>>,
{
    move |now| now.velocity().norm_squared() - limit * limit
}
