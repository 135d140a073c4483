//! Kirchhoff's body in a fluid.

use liestep::groups::SE3;
use liestep::lagrangian;
use nalgebra::{Matrix4, Point3, Vector4};

/// A rigid body in an ideal fluid at rest, after Kirchhoff, with weight and buoyancy.
///
/// The added mass of the fluid depends on the direction. A displacement has different components in the frames before
/// and after the step, and either alone would lead to a scheme of first order; half of each is self-adjoint.
///
/// Matrices and points are homogeneous, with the fourth row and column for the position. The advected parameter is the
/// height as a function of the position, `(n, c)` for `n·x + c`, an element of `V*`.
#[lagrangian(
    group = SE3,
    advected(w = height),
    l_d = {
        let d = F - I;
        let before = d * origin;
        let after = inverse(F) * before;
        let rotation = (d * J * d.transpose()).trace() / (2.0 * h);
        let translation = (before.dot(&(M * before)) + after.dot(&(M * after))) / (4.0 * h);
        rotation + translation - 0.5 * h * w.dot(&(weight + F * weight))
    },
)]
#[derive(Clone, Debug)]
pub struct UnderwaterBody {
    /// Nonstandard inertia of body and fluid in the upper left block, kg m²; zero elsewhere.
    pub J: Matrix4<f64>,
    /// Mass of body and added mass in the upper left block, kg; zero elsewhere.
    pub M: Matrix4<f64>,
    /// The centre of both tensors, body frame.
    pub origin: Point3<f64>,
    /// Weight times its position minus buoyancy times its position, N m, and below it weight minus buoyancy, N.
    pub weight: Vector4<f64>,
    /// The height, in space: `(0, 0, 1, 0)`.
    pub height: Vector4<f64>,
}
