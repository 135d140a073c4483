//! Proved bounds on the solvability of a step.
//!
//! With the kinetic part of (3.13) and a physical body the momentum equation is `(F J_d − J_d Fᵀ)^∨ = h a`, where
//! `a = μ + kick_before(w)`. With the unit quaternion `q` of `F` and the moments `J_k` its left side has the length
//!
//! ```text
//! 2 √(Σ J_k² q_k² − (Σ J_k q_k²)²)       twice the standard deviation of {0, J_1, J_2, J_3} under the weights q²
//! ```
//!
//! so it never exceeds `J_max`: if `h|a| > J_max` there is no solution. At 90° it is at least `J_min`, and within 90°
//! the Jacobian's determinant is positive: the ball of angles below 90° covers that of radius `J_min` just once, so if
//! `h|a| < J_min` there is exactly one solution below 90°. Between these bounds it depends on the direction, and the
//! solver decides.

use alloc::vec::Vec;

use nalgebra::{Matrix3, SimdRealField as _, Vector3};

use crate::groups::LieGroup;
use crate::numbers::{Coordinates, Entries as _, real};

/// The solvability of a step, by bounds on its right-hand side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Solvability {
    /// There is exactly one solution that turns the body by less than 90°.
    Certain,
    /// There is no solution.
    Impossible,
    /// The bounds don't decide, or there are none for this Lagrangian.
    Open,
}

/// Bounds on the size of `h a` for the solvability of `U(F) = a`, on SO(3) in kg m². Between them it depends on the
/// direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TurningLimits {
    /// Bound below which there is exactly one solution under 90°.
    pub(crate) certain: f64,
    /// Bound above which there is none.
    pub(crate) impossible: f64,
}

impl TurningLimits {
    /// The solvability at this `|h a|`.
    #[must_use]
    pub fn decide(&self, size: f64) -> Solvability {
        // The bounds' uncertainty by the roundings of `a` and of the moments.
        let margin = 1e-12;
        if size < self.certain * (1.0 - margin) {
            Solvability::Certain
        } else if size > self.impossible * (1.0 + margin) {
            Solvability::Impossible
        } else {
            Solvability::Open
        }
    }
}

/// Rotations at which an unknown part is compared with that of (3.13): quaternions without symmetry, up to 157°.
const PROBES: [[f64; 4]; 4] =
    [[9.0, 1.0, -2.0, 3.0], [5.0, 4.0, 1.0, -3.0], [2.0, -3.0, 7.0, 1.0], [2.0, 5.0, 3.0, 8.0]];

/// The bounds of the theorem, if the group is that of rotations, `h U` is `(F J_d − J_d Fᵀ)^∨` to rounding and the body
/// is physical.
///
/// The momentum `U` is recognised by its values at some rotations, however it was declared or written.
#[must_use]
pub fn turning_limits<G: LieGroup>(
    unknown: &dyn Fn(&G) -> Option<G::Vector>,
    inertia: &Square<G>,
) -> Option<TurningLimits> {
    // Other groups return before anything is computed.
    G::from_rotation(Matrix3::identity())?;
    let columns = [0, 1, 2].map(|k| in_f64::<G>(&(*inertia * G::Vector::axis(k))));
    let [Some(first), Some(second), Some(third)] = columns else { return None };
    let inertia = Matrix3::from_columns(&[first, second, third]);
    let nonstandard = Matrix3::from_diagonal_element(0.5 * inertia.trace()) - inertia;
    let scale = inertia.norm();
    let tolerance = nalgebra::try_convert::<G::Scalar, f64>(G::Scalar::simd_default_epsilon())? * 64.0 * scale;
    for [w, x, y, z] in PROBES {
        let quaternion = nalgebra::UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(w, x, y, z));
        let f = quaternion.to_rotation_matrix().into_inner();
        let product = f * nonstandard;
        let twice_vee = product - product.transpose();
        let expected = Vector3::new(twice_vee.m32, twice_vee.m13, twice_vee.m21);
        let value = in_f64::<G>(&unknown(&G::from_rotation(f.map(real))?)?)?;
        let is_same = (value - expected).norm() <= tolerance;
        if !is_same {
            return None;
        }
    }
    let moments = inertia.symmetric_eigenvalues();
    let (smallest, largest) = (moments.min(), moments.max());
    // The largest moment exceeds the sum of the others if `J_d` has a negative eigenvalue.
    let is_body = smallest > 0.0 && 2.0 * largest <= moments.sum() + tolerance;
    is_body.then_some(TurningLimits { certain: smallest, impossible: largest })
}

/// Three components as `f64`, or none if lanes differ.
fn in_f64<G: LieGroup>(vector: &G::Vector) -> Option<Vector3<f64>> {
    let mut entries = Vec::new();
    vector.each(&mut |entry| entries.push(nalgebra::try_convert::<G::Scalar, f64>(entry).unwrap_or(f64::NAN)));
    (entries.len() == 3 && entries.iter().all(|entry| entry.is_finite())).then(|| Vector3::from_row_slice(&entries))
}

/// Linear maps of the components of a group's algebra.
type Square<G> = <<G as LieGroup>::Vector as Coordinates<<G as LieGroup>::Scalar>>::Square;
