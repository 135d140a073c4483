//! The rigid motions of the plane.

use nalgebra::{Isometry2, RealField, Rotation2, SMatrix, UnitComplex, Vector2};

use super::generators::{Generators, matrix};
use super::matrix_group::MatrixGroup;
use super::so2::rotation_defect_squared;

/// The group SE(2) of rigid motions of the plane.
///
/// | | |
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

/// Declares [`SE2`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[doc(hidden)]
pub struct SE2Generators;

impl Generators<3, 3> for SE2Generators {
    const GENERATORS: [[[f64; 3]; 3]; 3] =
        [matrix(&[(1, 0, 1.0), (0, 1, -1.0)]), matrix(&[(0, 2, 1.0)]), matrix(&[(1, 2, 1.0)])];

    fn relation<T: RealField + Copy>(m: &SMatrix<T, 3, 3>) -> T {
        let rotation = rotation_defect_squared(m[(0, 0)], m[(0, 1)], m[(1, 0)], m[(1, 1)]);
        (rotation + rows_defect_squared::<2, _, _>(m)).sqrt()
    }

    fn inverse<T: RealField + Copy>(m: &SMatrix<T, 3, 3>) -> SMatrix<T, 3, 3> {
        rigid_inverse::<2, _, _>(m)
    }

    fn is_near_identity<T: RealField + Copy>(algebra: &SMatrix<T, 3, 3>) -> bool {
        rotates_little::<2, _, _>(algebra)
    }
}

/// The square of the distance of the rows below the rotation, whose size is `K`, from those of the identity.
pub(super) fn rows_defect_squared<const K: usize, T: RealField + Copy, const N: usize>(m: &SMatrix<T, N, N>) -> T {
    (m - SMatrix::identity()).rows(K, N - K).norm_squared()
}

/// `[Rᵀ, −Rᵀx; 0, I]`, of a rotation of size `K`.
pub(super) fn rigid_inverse<const K: usize, T: RealField + Copy, const N: usize>(
    m: &SMatrix<T, N, N>,
) -> SMatrix<T, N, N> {
    SMatrix::from_fn(|i, j| match (i < K, j < K) {
        (true, true) => m[(j, i)],
        (true, false) => -(0..K).fold(T::zero(), |sum, k| sum + m[(k, i)] * m[(k, j)]),
        _ if i == j => T::one(),
        _ => T::zero(),
    })
}

/// Whether the rotation part is below one radian, whatever the translations are.
///
/// The momentum of a translation is linear in it, so that it can't lead to another branch.
pub(super) fn rotates_little<const K: usize, T: RealField + Copy, const N: usize>(algebra: &SMatrix<T, N, N>) -> bool {
    // In a skew matrix each component stands twice.
    algebra.columns(0, K).norm_squared() < T::one() + T::one()
}

impl<T: RealField + Copy> SE2<T> {
    /// `p ↦ R p + x`, from the rotation `R` and the translation `x`.
    #[must_use]
    pub fn from_rotation_and_translation(rotation: UnitComplex<T>, translation: Vector2<T>) -> Self {
        let mut matrix = rotation.to_homogeneous();
        matrix.fixed_view_mut::<2, 1>(0, 2).copy_from(&translation);
        Self::from_matrix_unchecked(matrix)
    }

    /// The rotation `R`.
    #[must_use]
    pub fn rotation(&self) -> UnitComplex<T> {
        let block = self.as_matrix().fixed_view::<2, 2>(0, 0).into_owned();
        UnitComplex::from_rotation_matrix(&Rotation2::from_matrix_unchecked(block))
    }

    /// The translation `x`.
    #[must_use]
    pub fn translation(&self) -> Vector2<T> {
        self.as_matrix().fixed_view::<2, 1>(0, 2).into_owned()
    }
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
