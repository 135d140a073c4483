//! The rigid motions of space.

use nalgebra::{Isometry3, Matrix3, RealField, Rotation3, SMatrix, UnitQuaternion, Vector3};

use super::generators::{Generators, matrix};
use super::matrix_group::MatrixGroup;
use super::se2::{rigid_inverse, rotates_little, rows_defect_squared};

/// The group SE(3) of rigid motions of space.
///
/// | | |
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

/// Declares [`SE3`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[doc(hidden)]
pub struct SE3Generators;

impl Generators<4, 6> for SE3Generators {
    const GENERATORS: [[[f64; 4]; 4]; 6] = [
        matrix(&[(2, 1, 1.0), (1, 2, -1.0)]),
        matrix(&[(0, 2, 1.0), (2, 0, -1.0)]),
        matrix(&[(1, 0, 1.0), (0, 1, -1.0)]),
        matrix(&[(0, 3, 1.0)]),
        matrix(&[(1, 3, 1.0)]),
        matrix(&[(2, 3, 1.0)]),
    ];

    fn relation<T: RealField + Copy>(m: &SMatrix<T, 4, 4>) -> T {
        rigid_defect(m)
    }

    fn inverse<T: RealField + Copy>(m: &SMatrix<T, 4, 4>) -> SMatrix<T, 4, 4> {
        rigid_inverse::<3, _, _>(m)
    }

    fn is_near_identity<T: RealField + Copy>(algebra: &SMatrix<T, 4, 4>) -> bool {
        rotates_little::<3, _, _>(algebra)
    }
}

/// How far a matrix is from `[R, X; 0, I]` with a rotation of space.
pub(super) fn rigid_defect<T: RealField + Copy, const N: usize>(m: &SMatrix<T, N, N>) -> T {
    let rotation = m.fixed_view::<3, 3>(0, 0);
    let gram = rotation.transpose() * rotation - Matrix3::identity();
    let determinant = rotation.determinant() - T::one();
    (gram.norm_squared() + determinant * determinant + rows_defect_squared::<3, _, _>(m)).sqrt()
}

impl<T: RealField + Copy> SE3<T> {
    /// `p ↦ R p + x`, from the rotation `R` and the translation `x`.
    #[must_use]
    pub fn from_rotation_and_translation(rotation: UnitQuaternion<T>, translation: Vector3<T>) -> Self {
        let mut matrix = rotation.to_homogeneous();
        matrix.fixed_view_mut::<3, 1>(0, 3).copy_from(&translation);
        Self::from_matrix_unchecked(matrix)
    }

    /// The rotation `R`.
    #[must_use]
    pub fn rotation(&self) -> UnitQuaternion<T> {
        let block = self.as_matrix().fixed_view::<3, 3>(0, 0).into_owned();
        UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(block))
    }

    /// The translation `x`.
    #[must_use]
    pub fn translation(&self) -> Vector3<T> {
        self.as_matrix().fixed_view::<3, 1>(0, 3).into_owned()
    }
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
