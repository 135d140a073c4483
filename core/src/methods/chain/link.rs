//! A link of a chain.

use nalgebra::Vector3;

use crate::error::SetupError;
use crate::mechanics::NonstandardInertia;

/// A link of a [`Chain`](super::Chain), in its own axes, whose origin is the link's upper joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Link {
    /// The nonstandard inertia about the upper joint, kg m².
    pub J_d: NonstandardInertia,
    /// The mass, kg.
    pub m: f64,
    /// The centre of mass, m.
    pub c: Vector3<f64>,
    /// The lower joint, which carries the next link, m.
    pub rho: Vector3<f64>,
}

impl Link {
    /// Checks the parameters of link number `body`.
    pub(super) fn validate(&self, body: usize) -> Result<(), SetupError> {
        let refused = |field, cause| Err(SetupError::BodyParameter { body, field, cause });
        if !self.m.is_finite() || self.m < 0.0 {
            return refused("m", "is not a mass: neither negative, nor infinite, nor NaN");
        }
        for (field, vector) in [("c", self.c), ("rho", self.rho)] {
            if !vector.iter().all(|entry| entry.is_finite()) {
                return refused(field, "is not finite");
            }
        }
        let about_joint = *self.J_d.as_matrix();
        let central = about_joint - self.c * self.c.transpose() * self.m;
        // The tolerance admits the rounding error of a point mass at the end of a rod.
        let is_possible = central.symmetric_eigenvalues().min() >= -1e-12 * about_joint.trace();
        if !is_possible {
            return refused("J_d", "is less than the mass at the centre of mass has about the joint");
        }
        Ok(())
    }
}
