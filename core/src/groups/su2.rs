//! The unit quaternions.

use nalgebra::{Quaternion, RealField, SMatrix, UnitQuaternion, Vector4};

use super::generators::{Generators, matrix};
use super::matrix_group::MatrixGroup;

/// The group SU(2) of unit quaternions, as 4 × 4 matrices of left multiplication.
///
/// | object | representation |
/// |---|---|
/// | matrix form | 4 × 4, `L(q) p = q p` on the components `(w, x, y, z)`; its first column is `q` |
/// | tangent space | three components, the body's angular velocity where `q` turns body to space |
/// | basis | `E_k` half of `L(i)`, `L(j)`, `L(k)` |
/// | bracket | `[ξ, η] = ξ × η`, as on SO(3) |
/// | action on a point | `p ↦ q p`, on quaternions as columns `(w, x, y, z)` |
/// | relation | `F = L(q)` for its first column `q`, `‖q‖ = 1` |
/// | units | the entries have none; coordinates in rad |
///
/// The group covers SO(3) twice: `q` and `−q` are one rotation. Covector components are those of the same body on
/// SO(3).
///
/// # Examples
///
/// ```
/// use liestep::groups::{LieGroup, SU2};
/// use nalgebra::{UnitQuaternion, Vector3};
/// let turn = UnitQuaternion::from_scaled_axis(Vector3::new(0.8, 0.0, 0.0));
/// let element = SU2::from(turn);
/// assert!(element.defect() < 1e-15 && element.to_quaternion().angle_to(&turn) < 1e-15);
/// ```
pub type SU2<T = f64> = MatrixGroup<SU2Generators, T, 4, 3>;

/// The generators of [`SU2`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[doc(hidden)]
pub struct SU2Generators;

impl Generators<4, 3> for SU2Generators {
    const GENERATORS: [[[f64; 4]; 4]; 3] = [
        matrix(&[(1, 0, 0.5), (0, 1, -0.5), (3, 2, 0.5), (2, 3, -0.5)]),
        matrix(&[(2, 0, 0.5), (0, 2, -0.5), (1, 3, 0.5), (3, 1, -0.5)]),
        matrix(&[(3, 0, 0.5), (0, 3, -0.5), (2, 1, 0.5), (1, 2, -0.5)]),
    ];

    fn relation<T: RealField + Copy>(m: &SMatrix<T, 4, 4>) -> T {
        let q = m.column(0).into_owned();
        let excess = q.norm_squared() - T::one();
        ((m - left_multiplication(&q)).norm_squared() + excess * excess).sqrt()
    }

    fn inverse<T: RealField + Copy>(m: &SMatrix<T, 4, 4>) -> SMatrix<T, 4, 4> {
        m.transpose()
    }
}

/// The matrix `L(q)` for the components `(w, x, y, z)`.
fn left_multiplication<T: RealField + Copy>(q: &Vector4<T>) -> SMatrix<T, 4, 4> {
    let (w, x, y, z) = (q[0], q[1], q[2], q[3]);
    SMatrix::from_columns(&[
        Vector4::new(w, x, y, z),
        Vector4::new(-x, w, z, -y),
        Vector4::new(-y, -z, w, x),
        Vector4::new(-z, y, -x, w),
    ])
}

impl<T: RealField + Copy> SU2<T> {
    /// The unit quaternion `q`.
    #[must_use]
    pub fn to_quaternion(&self) -> UnitQuaternion<T> {
        let q = self.as_matrix().column(0);
        UnitQuaternion::new_normalize(Quaternion::new(q[0], q[1], q[2], q[3]))
    }
}

impl<T: RealField + Copy> From<UnitQuaternion<T>> for SU2<T> {
    fn from(q: UnitQuaternion<T>) -> Self {
        Self::from_matrix_unchecked(left_multiplication(&Vector4::new(q.w, q.i, q.j, q.k)))
    }
}
