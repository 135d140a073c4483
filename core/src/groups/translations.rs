//! The translations of the line, the plane and space.

use nalgebra::{RealField, SMatrix, SVector};

use super::generators::{Generators, matrix};
use super::matrix_group::MatrixGroup;
use crate::numbers::Real;

/// The translations of the line; see [`R3`].
pub type R1<T = f64> = MatrixGroup<TranslationGenerators, T, 2, 1>;

/// The translations of the plane; see [`R3`].
pub type R2<T = f64> = MatrixGroup<TranslationGenerators, T, 3, 2>;

/// The translations of space.
///
/// | object | representation |
/// |---|---|
/// | matrix form | 4 × 4 (for `Rⁿ` of size `n + 1`), `[I, x; 0, 1]` |
/// | tangent space | the velocity; `E_k` has the `k`-th unit column in place of `x` |
/// | bracket | zero |
/// | action on a point | `(p, 1) ↦ F (p, 1)`, `p ↦ p + x` |
/// | relation | all but `x` as in the identity |
/// | units | `x` and coordinates m; covectors kg m/s |
///
/// A reduced discrete Lagrangian on translations is that of a particle.
///
/// # Examples
///
/// ```
/// use liestep::groups::{LieGroup, R1, R3};
/// use nalgebra::Vector3;
/// let shift = R3::from(Vector3::new(1.0, 2.0, 3.0));
/// assert_eq!(shift.compose(&shift).translation(), Vector3::new(2.0, 4.0, 6.0));
/// assert_eq!(R1::from(0.2).value(), 0.2);
/// ```
pub type R3<T = f64> = MatrixGroup<TranslationGenerators, T, 4, 3>;

/// The generators of [`R1`], [`R2`] and [`R3`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[doc(hidden)]
pub struct TranslationGenerators;

macro_rules! translations {
    ($size:literal, $dimension:literal, [$($row:literal),+]) => {
        impl Generators<$size, $dimension> for TranslationGenerators {
            const GENERATORS: [[[f64; $size]; $size]; $dimension] = [$(matrix(&[($row, $dimension, 1.0)])),+];

            const COORDINATES: &'static [&'static str] = &[$(["x", "y", "z"][$row]),+];

            fn relation<T: RealField + Copy>(m: &SMatrix<T, $size, $size>) -> T {
                let x = m.fixed_view::<$dimension, 1>(0, $dimension).into_owned();
                (m - translation(&x)).norm()
            }

            fn inverse<T: RealField + Copy>(m: &SMatrix<T, $size, $size>) -> SMatrix<T, $size, $size> {
                translation(&-m.fixed_view::<$dimension, 1>(0, $dimension))
            }

            /// The momentum is linear in a translation, so that there is one solution.
            fn is_near_identity<T: RealField + Copy>(_: &SMatrix<T, $size, $size>) -> bool {
                true
            }
        }

        impl<T: Real> From<SVector<T, $dimension>> for MatrixGroup<TranslationGenerators, T, $size, $dimension> {
            fn from(x: SVector<T, $dimension>) -> Self {
                Self::from_matrix_unchecked(translation(&x))
            }
        }

        impl<T: Real> MatrixGroup<TranslationGenerators, T, $size, $dimension> {
            /// The translation `x`.
            #[must_use]
            pub fn translation(&self) -> SVector<T, $dimension> {
                self.as_matrix().fixed_view::<$dimension, 1>(0, $dimension).into_owned()
            }
        }
    };
}

impl<T: Real> From<T> for R1<T> {
    fn from(x: T) -> Self {
        Self::from(SVector::<T, 1>::new(x))
    }
}

impl<T: Real> R1<T> {
    /// The translation as a number.
    #[must_use]
    pub fn value(&self) -> T {
        self.as_matrix()[(0, 1)]
    }
}

translations!(2, 1, [0]);
translations!(3, 2, [0, 1]);
translations!(4, 3, [0, 1, 2]);

/// The matrix `[I, x; 0, 1]`.
fn translation<T: Real, const N: usize, const D: usize>(x: &SVector<T, D>) -> SMatrix<T, N, N> {
    let mut matrix = SMatrix::identity();
    for k in 0..D {
        matrix[(k, D)] = x[k];
    }
    matrix
}
