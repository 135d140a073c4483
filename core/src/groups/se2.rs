//! The rigid motions of the plane.

use nalgebra::{Isometry2, RealField, Rotation2, SMatrix, UnitComplex, Vector2};

use super::generators::Generators;
use super::matrix_group::MatrixGroup;
use super::rigid::{self, rigid_group};

/// The group SE(2) of rigid motions of the plane.
///
/// | object | representation |
/// |---|---|
/// | matrix form | 3 × 3, `[R, x; 0, 1]` |
/// | tangent space | `(ω, v_1, v_2)`: angular velocity, then velocity, both in the body frame |
/// | basis | `E_1` the rotation `[0, −1; 1, 0]` in the upper left, `E_2`, `E_3` the unit columns in place of `x` |
/// | bracket | `[(ω, v), (ω', v')] = (0, ω × v' − ω' × v)` |
/// | action on a point | `(p, 1) ↦ F (p, 1)`, `p ↦ R p + x` |
/// | relation | `R` a rotation, the last row `(0, 0, 1)` |
/// | units | `R` none, `x` m; coordinates rad and m; covectors kg m²/s and kg m/s |
///
/// # Examples
///
/// ```
/// use liestep::groups::{LieGroup, SE2};
/// use nalgebra::{UnitComplex, Vector2};
/// let motion = SE2::from_rotation_and_translation(UnitComplex::new(0.8), Vector2::new(1.0, 2.0));
/// assert_eq!(motion.translation(), Vector2::new(1.0, 2.0));
/// assert!(motion.defect() < 1e-15);
/// ```
pub type SE2<T = f64> = MatrixGroup<SE2Generators, T, 3, 3>;

rigid_group! {
    SE2, SE2Generators<2, 3, 3>, UnitComplex by Rotation2, Vector2;
    /// The motion `p ↦ R p + x`, from the rotation `R` and the translation `x`.
    from_rotation_and_translation(
        /// The rotation `R`.
        rotation,
        /// The translation `x`.
        translation at 2
    )
}

impl<T: RealField + Copy> From<Isometry2<T>> for SE2<T> {
    fn from(motion: Isometry2<T>) -> Self {
        Self::from_rotation_and_translation(motion.rotation, motion.translation.vector)
    }
}

impl<T: RealField + Copy> From<SE2<T>> for Isometry2<T> {
    fn from(motion: SE2<T>) -> Self {
        Self::from_parts(motion.translation().into(), motion.rotation())
    }
}
