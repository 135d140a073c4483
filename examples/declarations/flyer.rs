//! A body with a thruster in a fluid: its kinetic part, and two forces on SE(3).

use liestep::groups::SE3;
use liestep::{force, lagrangian};
use nalgebra::{Matrix4, Point3, Vector4};

/// A free rigid body with its position: `F` is the change of attitude and position in a step.
#[lagrangian(group = SE3, l_d = ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h))]
#[derive(Clone, Copy, Debug)]
pub struct Flyer {
    /// `∫ X Xᵀ dm` in homogeneous coordinates: second moments in kg m², first in kg m, mass in kg.
    pub J: Matrix4<f64>,
}

/// A follower force: its direction is fixed in the body, and its value is prescribed for each step.
///
/// `hat(eta)` is the displacement of the body's points, so `hat(eta) * at` is that of the nozzle.
#[force(
    group = SE3,
    given(f = thrust),
    work = 0.5 * h * f.dot(&(hat(eta + eta_next) * at)),
)]
#[derive(Clone, Copy, Debug)]
pub struct Thruster {
    /// The nozzle, body frame, m.
    pub at: Point3<f64>,
    /// The force, body frame, N; the fourth component is zero.
    pub thrust: Vector4<f64>,
}

/// Drag against the velocities of the body's points, as of a density of dampers: the dissipation is `½ tr(ξ̂ C ξ̂ᵀ)`,
/// of the form of a kinetic energy.
///
/// The velocity of a step is `(F − I)/h` in the frame at its beginning and `(I − F⁻¹)/h` in that at its end.
#[force(
    group = SE3,
    work = -0.5 * (((F - I) * C * hat(eta).transpose()).trace()
        + ((I - inverse(F)) * C * hat(eta_next).transpose()).trace()),
)]
#[derive(Clone, Copy, Debug)]
pub struct FluidDrag {
    /// `∫ X Xᵀ dc` of the dampers in homogeneous coordinates, N s/m with the units of `X`.
    pub C: Matrix4<f64>,
}
