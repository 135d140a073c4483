//! The declaration that the integrator is made from, and some bodies.

use liestep::prelude::*;
use nalgebra::Vector3;

/// A heavy top: the reduced discrete Lagrangian \[RDAE, (3.13)\].
#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)
        - 0.5 * h * m * g * w.dot(&(rho + F * rho)),
)]
#[derive(Clone, Debug)]
pub struct HeavyTop {
    /// Nonstandard inertia about the pivot, kg m².
    pub J_d: DiagonalNonstandardInertia,
    /// Mass, kg.
    pub m: f64,
    /// Gravitational acceleration, m/s².
    pub g: f64,
    /// Centre of mass from the pivot, body frame, m.
    pub rho: Vector3<f64>,
    /// The vertical, in the inertial frame; `w` is the same vector seen from the body.
    pub up: Vector3<f64>,
}

impl HeavyTop {
    /// The thesis' body: `J_d = diag(2, 2, 1)`, one metre below its centre of mass, reading A.
    pub fn thesis() -> Self {
        Self::symmetric(Vector3::new(2.0, 2.0, 1.0))
    }

    /// A body of 1 kg with `ρ = e₃`.
    pub fn symmetric(nonstandard: Vector3<f64>) -> Self {
        let J_d = DiagonalNonstandardInertia::from_diagonal(nonstandard).unwrap();
        Self { J_d, m: 1.0, g: 9.81, rho: Vector3::z(), up: Vector3::z() }
    }

    /// No symmetry: three moments and a centre of mass off the axes.
    pub fn asymmetric() -> Self {
        let J_d = DiagonalNonstandardInertia::from_principal_moments(Vector3::new(2.0, 3.0, 4.5)).unwrap();
        Self { J_d, m: 1.0, g: 9.81, rho: Vector3::new(0.3, 0.2, 0.4), up: Vector3::z() }
    }

    /// The principal moments of the ordinary inertia.
    pub fn moments(&self) -> Vector3<f64> {
        let d = self.J_d.diagonal();
        Vector3::new(d.y + d.z, d.z + d.x, d.x + d.y)
    }

    /// The ordinary inertia, which all declarations but (3.13) take.
    pub fn ordinary_inertia(&self) -> Inertia {
        Inertia::from_principal_moments(self.moments()).unwrap()
    }
}
