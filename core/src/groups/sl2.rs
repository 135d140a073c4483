//! The area-preserving linear maps of the plane.

use nalgebra::{Matrix2, RealField, SMatrix};

use super::generators::{Generators, matrix};
use super::matrix_group::MatrixGroup;

/// The special linear group SL(2) of the plane.
///
/// | object | representation |
/// |---|---|
/// | matrix form | 2 × 2 |
/// | tangent space | three components: stretch along the axes, stretch along the diagonals, rotation |
/// | basis | `E_1 = ½ [1, 0; 0, −1]`, `E_2 = ½ [0, 1; 1, 0]`, `E_3 = ½ [0, −1; 1, 0]` |
/// | bracket | `[E_1, E_2] = −E_3`, `[E_2, E_3] = E_1`, `[E_3, E_1] = E_2` |
/// | action on a point | `x ↦ F x` |
/// | relation | `det F = 1` |
/// | units | none |
///
/// Neither retraction reaches the whole group: the exponential misses matrices with eigenvalues `−λ`, `−1/λ`, the
/// Cayley map those with the eigenvalue −1.
///
/// # Examples
///
/// ```
/// use liestep::groups::{NotInGroup, SL2};
/// use nalgebra::Matrix2;
/// assert!(SL2::try_from(Matrix2::new(2.0, 1.0, 1.0, 1.0)).is_ok());
/// assert_eq!(SL2::try_from(Matrix2::new(2.0, 0.0, 0.0, 1.0)), Err(NotInGroup { defect: 1.0 }));
/// ```
pub type SL2<T = f64> = MatrixGroup<SL2Generators, T, 2, 3>;

/// The generators of [`SL2`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[doc(hidden)]
pub struct SL2Generators;

impl Generators<2, 3> for SL2Generators {
    const GENERATORS: [[[f64; 2]; 2]; 3] = [
        matrix(&[(0, 0, 0.5), (1, 1, -0.5)]),
        matrix(&[(0, 1, 0.5), (1, 0, 0.5)]),
        matrix(&[(0, 1, -0.5), (1, 0, 0.5)]),
    ];

    fn relation<T: RealField + Copy>(m: &SMatrix<T, 2, 2>) -> T {
        (m.determinant() - T::one()).abs()
    }

    fn inverse<T: RealField + Copy>(m: &SMatrix<T, 2, 2>) -> SMatrix<T, 2, 2> {
        Matrix2::new(m.m22, -m.m12, -m.m21, m.m11)
    }
}
