//! Functions of a rotating body whose zeros are events: Poincaré sections, the passage of the vertical, the end of a
//! tumble.
//!
//! [`Run::event`](crate::recording::Run::event) takes them. With `Ω` the body velocity, each page bounds the second derivative,
//! for [`Event::curvature`](crate::recording::Event::curvature).

use nalgebra::Vector3;

use crate::groups::SO3;
use crate::motion::{Integrator, Moment, ScalarIn};
use crate::numbers::Real;

/// `n·R b`: a body axis `b` passes the plane with the normal `n` in space, through the pivot.
///
/// Its second derivative is at most `|n||b| (|Ω|² + |Ω̇|)`.
pub fn plane<I, T>(axis: Vector3<T>, normal: Vector3<T>) -> impl Fn(&Moment<'_, I>) -> ScalarIn<I>
where
    T: Real,
    I: Integrator<Group = SO3<T>>,
{
    move |now| normal.dot(&(now.attitude().as_matrix() * axis))
}

/// `u·R b − c`: a body axis `b` passes the cone about the direction `u` in space whose angle has the cosine `c`; both are
/// unit vectors.
///
/// Its second derivative is at most `|Ω|² + |Ω̇|`.
pub fn cone<I, T>(axis: Vector3<T>, direction: Vector3<T>, cosine: T) -> impl Fn(&Moment<'_, I>) -> ScalarIn<I>
where
    T: Real,
    I: Integrator<Group = SO3<T>>,
{
    move |now| direction.dot(&(now.attitude().as_matrix() * axis)) - cosine
}

/// `d/dt (u·R b) = u·R (Ω × b)`: where it falls through zero a body axis `b` passes the direction `u` in space as near as it
/// comes, with `u` upwards the vertical; where it rises it is farthest away.
///
/// Its second derivative is at most `|u||b| (|Ω|³ + 3 |Ω||Ω̇| + |Ω̈|)`.
pub fn passage<I, T>(axis: Vector3<T>, direction: Vector3<T>) -> impl Fn(&Moment<'_, I>) -> ScalarIn<I>
where
    T: Real,
    I: Integrator<Group = SO3<T>>,
{
    move |now| direction.dot(&(now.attitude().as_matrix() * now.velocity().cross(&axis)))
}

/// `|Ω|² − v²`, rad²/s²: where it falls through zero a body is detumbled, for the limit `v`.
///
/// Its second derivative is at most `2 (|Ω̇|² + |Ω||Ω̈|)`.
pub fn speed<I, T>(limit: T) -> impl Fn(&Moment<'_, I>) -> ScalarIn<I>
where
    T: Real,
    I: Integrator<Group = SO3<T>>,
{
    move |now| now.velocity().norm_squared() - limit * limit
}
