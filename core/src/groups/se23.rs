//! The extended poses of inertial navigation.

use nalgebra::{RealField, Rotation3, SMatrix, UnitQuaternion, Vector3};

use super::generators::{Generators, matrix};
use super::matrix_group::MatrixGroup;
use super::se2::{rigid_inverse, rotates_little};
use super::se3::rigid_defect;

/// The group SE₂(3) of extended poses: an attitude, a velocity and a place.
///
/// | | |
/// |---|---|
/// | matrix form | 5 × 5, `[R, v, x; 0, I]` |
/// | tangent space | `(ω, a, u)`: the rates of `R`, of `v` and of `x`, all in the body frame |
/// | basis | `E_1`, `E_2`, `E_3` the `ê_k` of SO(3) in the upper left, `E_4` to `E_6` the unit columns in place of `v`, `E_7` to `E_9` those in place of `x` |
/// | bracket | `[(ω, a, u), (ω', a', u')] = (ω × ω', ω × a' − ω' × a, ω × u' − ω' × u)` |
/// | action | `(p, s, t) ↦ (R p + s v + t x, s, t)` |
/// | relation | `RᵀR = I`, `det R = 1`, the last two rows those of the identity |
/// | units | `R` none, `v` m/s, `x` m |
///
/// # Source
///
/// Barrau and Bonnabel 2017, The invariant extended Kalman filter as a stable observer, section IV.
///
/// # Examples
///
/// ```
/// use liestep::groups::{LieGroup, SE23};
/// use nalgebra::{UnitQuaternion, Vector3};
/// let turn = UnitQuaternion::from_scaled_axis(Vector3::new(0.8, 0.0, 0.0));
/// let pose = SE23::from_parts(turn, Vector3::x(), Vector3::new(1.0, 2.0, 3.0));
/// assert_eq!(pose.place(), Vector3::new(1.0, 2.0, 3.0));
/// assert!(pose.compose(&pose.inverse()).defect() < 1e-15);
/// ```
pub type SE23<T = f64> = MatrixGroup<SE23Generators, T, 5, 9>;

/// Declares [`SE23`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[doc(hidden)]
pub struct SE23Generators;

impl Generators<5, 9> for SE23Generators {
    const GENERATORS: [[[f64; 5]; 5]; 9] = [
        matrix(&[(2, 1, 1.0), (1, 2, -1.0)]),
        matrix(&[(0, 2, 1.0), (2, 0, -1.0)]),
        matrix(&[(1, 0, 1.0), (0, 1, -1.0)]),
        matrix(&[(0, 3, 1.0)]),
        matrix(&[(1, 3, 1.0)]),
        matrix(&[(2, 3, 1.0)]),
        matrix(&[(0, 4, 1.0)]),
        matrix(&[(1, 4, 1.0)]),
        matrix(&[(2, 4, 1.0)]),
    ];

    fn relation<T: RealField + Copy>(m: &SMatrix<T, 5, 5>) -> T {
        rigid_defect(m)
    }

    fn inverse<T: RealField + Copy>(m: &SMatrix<T, 5, 5>) -> SMatrix<T, 5, 5> {
        rigid_inverse::<3, _, _>(m)
    }

    fn is_near_identity<T: RealField + Copy>(algebra: &SMatrix<T, 5, 5>) -> bool {
        rotates_little::<3, _, _>(algebra)
    }
}

impl<T: RealField + Copy> SE23<T> {
    /// From the attitude `R`, the velocity `v` and the place `x`.
    #[must_use]
    pub fn from_parts(attitude: UnitQuaternion<T>, velocity: Vector3<T>, place: Vector3<T>) -> Self {
        let mut matrix = SMatrix::<T, 5, 5>::identity();
        matrix.fixed_view_mut::<3, 3>(0, 0).copy_from(attitude.to_rotation_matrix().matrix());
        matrix.fixed_view_mut::<3, 1>(0, 3).copy_from(&velocity);
        matrix.fixed_view_mut::<3, 1>(0, 4).copy_from(&place);
        Self::from_matrix_unchecked(matrix)
    }

    /// The attitude `R`.
    #[must_use]
    pub fn attitude(&self) -> UnitQuaternion<T> {
        let block = self.as_matrix().fixed_view::<3, 3>(0, 0).into_owned();
        UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(block))
    }

    /// The velocity `v`.
    #[must_use]
    pub fn velocity(&self) -> Vector3<T> {
        self.as_matrix().fixed_view::<3, 1>(0, 3).into_owned()
    }

    /// The place `x`.
    #[must_use]
    pub fn place(&self) -> Vector3<T> {
        self.as_matrix().fixed_view::<3, 1>(0, 4).into_owned()
    }
}
