//! The rigid motions of space.

use nalgebra::{Isometry3, RealField, Rotation3, SMatrix, UnitQuaternion, Vector3};

use super::generators::Generators;
use super::matrix_group::MatrixGroup;
use super::rigid::{self, rigid_group};

/// The group SE(3) of rigid motions of space.
///
/// | object | representation |
/// |---|---|
/// | matrix form | 4 × 4, `[R, x; 0, 1]` |
/// | tangent space | `(ω, v)`: angular velocity, then velocity, both in the body frame |
/// | basis | `E_1`, `E_2`, `E_3` the `ê_k` of SO(3) in the upper left, `E_4`, `E_5`, `E_6` the unit columns in place of `x` |
/// | bracket | `[(ω, v), (ω', v')] = (ω × ω', ω × v' − ω' × v)` |
/// | action on a point | `(p, 1) ↦ F (p, 1)`, `p ↦ R p + x` |
/// | relation | `RᵀR = I`, `det R = 1`, the last row `(0, 0, 0, 1)` |
/// | units | `R` none, `x` m; coordinates rad and m; covectors kg m²/s and kg m/s |
///
/// Covector components are the angular momentum about the body's origin, then the momentum, both in the body frame.
///
/// # Examples
///
/// ```
/// use liestep::groups::{LieGroup, SE3};
/// use nalgebra::{UnitQuaternion, Vector3};
/// let turn = UnitQuaternion::from_scaled_axis(Vector3::new(0.8, 0.0, 0.0));
/// let motion = SE3::from_rotation_and_translation(turn, Vector3::new(1.0, 2.0, 3.0));
/// assert_eq!(motion.translation(), Vector3::new(1.0, 2.0, 3.0));
/// assert!(motion.defect() < 1e-15);
/// ```
pub type SE3<T = f64> = MatrixGroup<SE3Generators, T, 4, 6>;

rigid_group! {
    SE3, SE3Generators<3, 4, 6>, UnitQuaternion by Rotation3, Vector3;
    /// The motion `p ↦ R p + x`, from the rotation `R` and the translation `x`.
    from_rotation_and_translation(
        /// The rotation `R`.
        rotation,
        /// The translation `x`.
        translation at 3
    )
}

impl<T: RealField + Copy> From<Isometry3<T>> for SE3<T> {
    fn from(motion: Isometry3<T>) -> Self {
        Self::from_rotation_and_translation(motion.rotation, motion.translation.vector)
    }
}

impl<T: RealField + Copy> From<SE3<T>> for Isometry3<T> {
    fn from(motion: SE3<T>) -> Self {
        Self::from_parts(motion.translation().into(), motion.rotation())
    }
}
