//! Chains of rigid links on ball joints, in the minimal form on SO(3)ᴺ, each step in time proportional to `N`.
//!
//! The links' attitudes are the only unknowns, so joints don't open. All velocities feel each other,
//!
//! ```text
//! l_d = Σ tr((F_a − I) K_a (F_a − I)ᵀ)/2h + Σ_a m_a |u_a + (F_a − I) c_a|²/2h − (h/2) g Σ w_a·(s_a + F_a s_a)
//! ```
//!
//! where `K_a` is the nonstandard inertia about the centre of mass, `J_a − m_a c_a c_aᵀ`, `u_a` the way of the upper joint
//! in the step, which the links above have made, and `s_a = m_a c_a + M_a ρ_a` with the mass `M_a` of all that hangs below.
//! The Newton matrix is full, but what a link feels of all that hangs on it is a mass at its lower joint; so it is
//! eliminated from the end of the chain to the pivot, as in the articulated-body algorithm.

mod elimination;
mod stepper;
#[cfg(test)]
mod tests;

use nalgebra::Vector3;

pub use stepper::{ChainMemory, ChainStepper};

use crate::error::SetupError;
use crate::mechanics::NonstandardInertia;

/// How far from one what should be of length one may be: what a unit quaternion or a matrix printed to a dozen digits leaves.
const ROUNDED: f64 = f64::EPSILON * 1e4;

/// A link of a [`Chain`], in its own axes, with the joint it hangs on as the origin.
// The letters of the field.
#[allow(non_snake_case)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Link {
    /// Nonstandard inertia about the joint, kg m².
    pub J_d: NonstandardInertia,
    /// Mass, kg.
    pub m: f64,
    /// Centre of mass, m.
    pub c: Vector3<f64>,
    /// The joint of the next link, m.
    pub rho: Vector3<f64>,
}

/// Links on ball joints, the first on a fixed pivot, under uniform gravity.
///
/// It is stepped by a [`ChainStepper`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chain<const N: usize> {
    /// From the pivot on.
    pub links: [Link; N],
    /// Gravitational acceleration, m/s².
    pub g: f64,
    /// The vertical, in space; of length one.
    pub up: Vector3<f64>,
}

impl<const N: usize> Chain<N> {
    /// Checks the parameters.
    ///
    /// # Errors
    ///
    /// [`SetupError::Parameter`] and [`SetupError::BodyParameter`], which names the link.
    fn validate(&self) -> Result<(), SetupError> {
        if !self.g.is_finite() {
            return Err(SetupError::Parameter { field: "g", cause: "is not finite" });
        }
        if !self.up.iter().all(|entry| entry.is_finite()) {
            return Err(SetupError::Parameter { field: "up", cause: "is not finite" });
        }
        if (self.up.norm_squared() - 1.0).abs() > ROUNDED {
            return Err(SetupError::Parameter { field: "up", cause: "is not of length one" });
        }
        for (body, link) in self.links.iter().enumerate() {
            let refused = |field, cause| Err(SetupError::BodyParameter { body, field, cause });
            if !link.m.is_finite() || link.m < 0.0 {
                return refused("m", "is not a mass: neither negative, nor infinite, nor NaN");
            }
            for (field, vector) in [("c", link.c), ("rho", link.rho)] {
                if !vector.iter().all(|entry| entry.is_finite()) {
                    return refused(field, "is not finite");
                }
            }
            let about_joint = *link.J_d.as_matrix();
            let central = about_joint - link.c * link.c.transpose() * link.m;
            // What rounding leaves of a point at the end of a rod.
            let is_possible = central.symmetric_eigenvalues().min() >= -1e-12 * about_joint.trace();
            if !is_possible {
                return refused("J_d", "is less than the mass at the centre of mass has about the joint");
            }
        }
        Ok(())
    }

    /// `g s_a`, N m.
    fn weights(&self) -> [Vector3<f64>; N] {
        let (mut beyond, mut weights) = (0.0, [Vector3::zeros(); N]);
        for (weight, link) in weights.iter_mut().zip(&self.links).rev() {
            *weight = (link.c * link.m + link.rho * beyond) * self.g;
            beyond += link.m;
        }
        weights
    }
}
