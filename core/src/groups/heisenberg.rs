//! The Heisenberg group.

use nalgebra::{Matrix3, RealField, SMatrix};

use super::generators::{Generators, matrix};
use super::matrix_group::MatrixGroup;

/// The Heisenberg group of upper triangular matrices with ones on the diagonal.
///
/// | object | representation |
/// |---|---|
/// | matrix form | 3 × 3, `[1, a, c; 0, 1, b; 0, 0, 1]` |
/// | tangent space | `(a', b', c')`; `E_1`, `E_2`, `E_3` have a one in the place of `a`, `b`, `c` |
/// | bracket | `[E_1, E_2] = E_3`, which commutes with all |
/// | action on a point | `x ↦ F x` |
/// | relation | the diagonal one, below it zero |
/// | units | `a`, `b` any; `c` their product |
///
/// # Examples
///
/// ```
/// use liestep::groups::{Heisenberg, LieGroup};
/// let (first, second) = (Heisenberg::new(1.0, 0.0, 0.0), Heisenberg::new(0.0, 1.0, 0.0));
/// assert_eq!(first.compose(&second), Heisenberg::new(1.0, 1.0, 1.0));
/// assert_eq!(second.compose(&first), Heisenberg::new(1.0, 1.0, 0.0));
/// ```
pub type Heisenberg<T = f64> = MatrixGroup<HeisenbergGenerators, T, 3, 3>;

/// The generators of [`Heisenberg`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[doc(hidden)]
pub struct HeisenbergGenerators;

impl Generators<3, 3> for HeisenbergGenerators {
    const GENERATORS: [[[f64; 3]; 3]; 3] = [matrix(&[(0, 1, 1.0)]), matrix(&[(1, 2, 1.0)]), matrix(&[(0, 2, 1.0)])];

    fn relation<T: RealField + Copy>(m: &SMatrix<T, 3, 3>) -> T {
        (m - unitriangular(m.m12, m.m23, m.m13)).norm()
    }

    fn inverse<T: RealField + Copy>(m: &SMatrix<T, 3, 3>) -> SMatrix<T, 3, 3> {
        unitriangular(-m.m12, -m.m23, m.m12 * m.m23 - m.m13)
    }
}

fn unitriangular<T: RealField + Copy>(a: T, b: T, c: T) -> Matrix3<T> {
    let (one, zero) = (T::one(), T::zero());
    Matrix3::new(one, a, c, zero, one, b, zero, zero, one)
}

impl<T: RealField + Copy> Heisenberg<T> {
    /// The matrix `[1, a, c; 0, 1, b; 0, 0, 1]`.
    #[must_use]
    pub fn new(a: T, b: T, c: T) -> Self {
        Self::from_matrix_unchecked(unitriangular(a, b, c))
    }
}
