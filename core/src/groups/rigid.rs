//! Rotations with columns beside them, `[R, X; 0, I]`: the common parts of SE(2), SE(3) and SE₂(3).

use nalgebra::{RealField, SMatrix};

/// The generators of the rotations of size `K`, then the unit columns beside them.
pub(super) const fn generators<const K: usize, const N: usize, const D: usize>() -> [[[f64; N]; N]; D] {
    let mut all = [[[0.0; N]; N]; D];
    let mut next = 0;
    // The one rotation of the plane, or in space the `ê_k` of SO(3).
    while next < K * (K - 1) / 2 {
        let (row, column) = if K == 2 { (1, 0) } else { ((next + 2) % K, (next + 1) % K) };
        all[next][row][column] = 1.0;
        all[next][column][row] = -1.0;
        next += 1;
    }
    let mut column = 0;
    while next < D {
        all[next][column % K][K + column / K] = 1.0;
        (next, column) = (next + 1, column + 1);
    }
    all
}

/// The square of the distance of the rows below the rotation, whose size is `K`, from those of the identity.
pub(super) fn rows_defect_squared<const K: usize, T: RealField + Copy, const N: usize>(m: &SMatrix<T, N, N>) -> T {
    (m - SMatrix::identity()).rows(K, N - K).norm_squared()
}

/// The inverse `[Rᵀ, −Rᵀx; 0, I]`, for a rotation of size `K`.
pub(super) fn inverse<const K: usize, T: RealField + Copy, const N: usize>(m: &SMatrix<T, N, N>) -> SMatrix<T, N, N> {
    SMatrix::from_fn(|i, j| match (i < K, j < K) {
        (true, true) => m[(j, i)],
        (true, false) => -(0..K).fold(T::zero(), |sum, k| sum + m[(k, i)] * m[(k, j)]),
        _ if i == j => T::one(),
        _ => T::zero(),
    })
}

/// Whether the rotation is below one radian, for any translation.
///
/// The momentum is linear in a translation, so that a translation can't lead to another branch.
pub(super) fn rotates_little<const K: usize, T: RealField + Copy, const N: usize>(algebra: &SMatrix<T, N, N>) -> bool {
    // A skew matrix has each component twice.
    algebra.columns(0, K).norm_squared() < T::one() + T::one()
}

/// Declares a group of rotations of size `K` with columns beside them, by its `Generators<N, D>`, with a constructor of
/// an element from its parts, and functions that return the parts.
macro_rules! rigid_group {
    (
        $Group:ident, $Generators:ident<$k:literal, $n:literal, $d:literal>, $Rotation:ident by $Matrix:ident, $Column:ident;
        $(#[$made:meta])* $make:ident($(#[$turned:meta])* $rotation:ident $(, $(#[$moved:meta])* $column:ident at $place:literal)+)
    ) => {
        #[doc = concat!("Declares [`", stringify!($Group), "`].")]
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[doc(hidden)]
        pub struct $Generators;

        impl Generators<$n, $d> for $Generators {
            const GENERATORS: [[[f64; $n]; $n]; $d] = rigid::generators::<$k, $n, $d>();

            fn relation<T: RealField + Copy>(m: &SMatrix<T, $n, $n>) -> T {
                let rotation = m.fixed_view::<$k, $k>(0, 0);
                let gram = rotation.transpose() * rotation - SMatrix::<T, $k, $k>::identity();
                let determinant = rotation.determinant() - T::one();
                let rows = rigid::rows_defect_squared::<$k, _, _>(m);
                (gram.norm_squared() + determinant * determinant + rows).sqrt()
            }

            fn inverse<T: RealField + Copy>(m: &SMatrix<T, $n, $n>) -> SMatrix<T, $n, $n> {
                rigid::inverse::<$k, _, _>(m)
            }

            fn is_near_identity<T: RealField + Copy>(algebra: &SMatrix<T, $n, $n>) -> bool {
                rigid::rotates_little::<$k, _, _>(algebra)
            }
        }

        impl<T: RealField + Copy> $Group<T> {
            $(#[$made])*
            #[must_use]
            pub fn $make($rotation: $Rotation<T> $(, $column: $Column<T>)+) -> Self {
                let mut matrix = SMatrix::<T, $n, $n>::identity();
                matrix.fixed_view_mut::<$k, $k>(0, 0).copy_from($rotation.to_rotation_matrix().matrix());
                $(matrix.fixed_view_mut::<$k, 1>(0, $place).copy_from(&$column);)+
                Self::from_matrix_unchecked(matrix)
            }

            $(#[$turned])*
            #[must_use]
            pub fn $rotation(&self) -> $Rotation<T> {
                let block = self.as_matrix().fixed_view::<$k, $k>(0, 0).into_owned();
                $Rotation::from_rotation_matrix(&$Matrix::from_matrix_unchecked(block))
            }

            $($(#[$moved])*
            #[must_use]
            pub fn $column(&self) -> $Column<T> {
                self.as_matrix().fixed_view::<$k, 1>(0, $place).into_owned()
            })+
        }
    };
}
pub(super) use rigid_group;
