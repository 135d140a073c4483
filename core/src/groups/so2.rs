//! The rotations of the plane.

use nalgebra::{RealField, Rotation2, SMatrix, UnitComplex};

use super::generators::{Generators, matrix};
use super::matrix_group::MatrixGroup;

/// The rotation group SO(2) of the plane.
///
/// | object | representation |
/// |---|---|
/// | matrix form | 2 × 2, `[cos θ, −sin θ; sin θ, cos θ]` |
/// | tangent space | one component, the angular velocity; `E_1 = [0, −1; 1, 0]` |
/// | bracket | zero |
/// | action on a point | `x ↦ F x` |
/// | relation | `F_11 = F_22`, `F_12 = −F_21`, `det F = 1` |
/// | units | the entries have none; coordinates in rad |
///
/// # Examples
///
/// ```
/// use liestep::groups::{LieGroup, SO2};
/// use nalgebra::UnitComplex;
/// let turn = SO2::from(UnitComplex::new(0.8));
/// assert!(turn.defect() < 1e-15 && (turn.angle() - 0.8_f64).abs() < 1e-15);
/// ```
pub type SO2<T = f64> = MatrixGroup<SO2Generators, T, 2, 1>;

/// The generators of [`SO2`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[doc(hidden)]
pub struct SO2Generators;

impl Generators<2, 1> for SO2Generators {
    const GENERATORS: [[[f64; 2]; 2]; 1] = [matrix(&[(1, 0, 1.0), (0, 1, -1.0)])];

    fn relation<T: RealField + Copy>(m: &SMatrix<T, 2, 2>) -> T {
        rotation_defect_squared(m[(0, 0)], m[(0, 1)], m[(1, 0)], m[(1, 1)]).sqrt()
    }

    fn inverse<T: RealField + Copy>(m: &SMatrix<T, 2, 2>) -> SMatrix<T, 2, 2> {
        m.transpose()
    }
}

/// The square of the distance of `[a, b; c, d]` from the relation of SO(2).
fn rotation_defect_squared<T: RealField + Copy>(a: T, b: T, c: T, d: T) -> T {
    let determinant = a * d - b * c - T::one();
    (a - d) * (a - d) + (b + c) * (b + c) + determinant * determinant
}

impl<T: RealField + Copy> SO2<T> {
    /// The angle, in `(−π, π]`.
    #[must_use]
    pub fn angle(&self) -> T {
        let m = self.as_matrix();
        m[(1, 0)].atan2(m[(0, 0)])
    }
}

impl<T: RealField + Copy> From<UnitComplex<T>> for SO2<T> {
    fn from(rotation: UnitComplex<T>) -> Self {
        Self::from(rotation.to_rotation_matrix())
    }
}

impl<T: RealField + Copy> From<Rotation2<T>> for SO2<T> {
    fn from(rotation: Rotation2<T>) -> Self {
        Self::from_matrix_unchecked(rotation.into_inner())
    }
}
