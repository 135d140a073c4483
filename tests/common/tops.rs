//! The tops and free bodies that the tests integrate.

// The letters of the field.
#![allow(non_snake_case)]

use liestep::{DiagonalNonstandardInertia, Inertia, NonstandardInertia};
use nalgebra::Vector3;

use crate::declarations::Top;
pub use crate::declarations::{FreeBody, FullTop, HeavyTop};

impl HeavyTop {
    /// The thesis' body: `J_d = diag(2, 2, 1)`, one metre below its centre of mass, reading A.
    pub fn thesis() -> Self {
        Self::symmetric(Vector3::new(2.0, 2.0, 1.0))
    }

    /// A body of 1 kg with `ρ = e₃`.
    pub fn symmetric(nonstandard: Vector3<f64>) -> Self {
        let J_d = DiagonalNonstandardInertia::new(nonstandard).unwrap();
        Self { J_d, m: 1.0, g: 9.81, rho: Vector3::z(), up: Vector3::z() }
    }

    /// No symmetry: three moments and a centre of mass off the axes.
    pub fn asymmetric() -> Self {
        let J_d = DiagonalNonstandardInertia::from_principal_moments(Vector3::new(2.0, 3.0, 4.5)).unwrap();
        Self { J_d, m: 1.0, g: 9.81, rho: Vector3::new(0.3, 0.2, 0.4), up: Vector3::z() }
    }
}

impl HeavyTop {
    /// The same body under the same gravity, declared as another top.
    pub fn declared_as<L: Top>(&self) -> L {
        L::new(inertia(self), self.m * self.g, self.rho, self.up)
    }
}

impl FullTop {
    /// The body of `top` described in axes turned by `axes`, and mirrored if its determinant is negative.
    pub fn in_axes(top: &HeavyTop, axes: &nalgebra::Matrix3<f64>) -> Self {
        let J_d = NonstandardInertia::new(axes * top.J_d.to_matrix() * axes.transpose()).unwrap();
        Self { J_d, m: top.m, g: top.g, rho: axes * top.rho, up: top.up }
    }
}

impl FreeBody {
    /// From the principal moments of the ordinary inertia.
    pub fn with_moments(moments: [f64; 3]) -> Self {
        Self { J_d: NonstandardInertia::from_principal_moments(moments.into()).unwrap() }
    }
}

/// The principal moments of the ordinary inertia.
pub fn moments(top: &HeavyTop) -> Vector3<f64> {
    let d = top.J_d.diagonal();
    Vector3::new(d.y + d.z, d.z + d.x, d.x + d.y)
}

/// The ordinary inertia, which all declarations but (3.13) take.
pub fn inertia(top: &HeavyTop) -> Inertia {
    Inertia::from_principal_moments(moments(top)).unwrap()
}
