//! The heavy top (3.13) in any axes of the body.

use liestep::{NonstandardInertia, SO3, lagrangian};
use nalgebra::{Matrix3, Vector3};
use workbench::heavy_top::declaration::HeavyTop;

/// The heavy top (3.13) with a full inertia tensor.
#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)
        - 0.5 * h * m * g * w.dot(&(rho + F * rho)),
)]
#[derive(Clone, Debug)]
pub struct FullTop {
    /// Nonstandard inertia about the pivot, kg m².
    pub J_d: NonstandardInertia,
    /// Mass, kg.
    pub m: f64,
    /// Gravitational acceleration, m/s².
    pub g: f64,
    /// Centre of mass from the pivot, body frame, m.
    pub rho: Vector3<f64>,
    /// The vertical, in space.
    pub up: Vector3<f64>,
}

impl FullTop {
    /// The body of `top` described in axes turned by `axes`, and mirrored if its determinant is negative.
    pub fn in_axes(top: &HeavyTop, axes: &Matrix3<f64>) -> Self {
        let J_d = NonstandardInertia::new(axes * top.J_d.to_matrix() * axes.transpose()).unwrap();
        Self { J_d, m: top.m, g: top.g, rho: axes * top.rho, up: top.up }
    }
}
