//! Rotations with columns beside them, `[R, X; 0, I]`: the common parts of SE(2), SE(3) and SE₂(3).

use nalgebra::{RealField, SMatrix, SVector};

use crate::numbers::Real;

/// The place `(row, column)` of the entry 1 of a rotation's generator, whose other entry is −1 at `(column, row)`: of the one
/// rotation of the plane, or of the `ê_k` of SO(3).
const fn turned(size: usize, k: usize) -> (usize, usize) {
    if size == 2 { (1, 0) } else { ((k + 2) % 3, (k + 1) % 3) }
}

/// The number of rotations of space, or of the plane.
pub(super) const fn turns(size: usize) -> usize {
    size * (size - 1) / 2
}

/// The generators of the rotations of size `K`, then the unit columns beside them.
pub(super) const fn generators<const K: usize, const N: usize, const D: usize>() -> [[[f64; N]; N]; D] {
    of_size(K)
}

const fn of_size<const N: usize, const D: usize>(size: usize) -> [[[f64; N]; N]; D] {
    let mut all = [[[0.0; N]; N]; D];
    let mut next = 0;
    while next < turns(size) {
        let (row, column) = turned(size, next);
        all[next][row][column] = 1.0;
        all[next][column][row] = -1.0;
        next += 1;
    }
    let mut column = 0;
    while next < D {
        all[next][column % size][size + column / size] = 1.0;
        (next, column) = (next + 1, column + 1);
    }
    all
}

/// The size of the rotations of a group with these generators; none if it isn't one of rigid motions.
pub(super) const fn size_of<const N: usize, const D: usize>(basis: &[[[f64; N]; N]; D]) -> Option<usize> {
    let mut size = 2;
    while size <= 3 && size < N {
        if D == turns(size) + size * (N - size) {
            let (rigid, mut place) = (of_size::<N, D>(size), 0);
            while place < D * N * N {
                let (k, row, column) = (place / (N * N), place / N % N, place % N);
                if rigid[k][row][column] - basis[k][row][column] != 0.0 {
                    return None;
                }
                place += 1;
            }
            return Some(size);
        }
        size += 1;
    }
    None
}

/// The first component of a column beside the rotations.
pub(super) const fn place(size: usize, column: usize) -> usize {
    turns(size) + (column - size) * size
}

/// The increment `[Sᵀ, −(t + Sᵀt); 0, 0]` of the inverse.
#[hot]
pub(super) fn inverse_increment<T: Real, const N: usize>(
    size: usize,
    increment: &SMatrix<T, N, N>,
) -> SMatrix<T, N, N> {
    let mut inverse = SMatrix::zeros();
    for i in 0..size {
        for j in 0..size {
            inverse[(i, j)] = increment[(j, i)];
        }
        for column in size..N {
            let mut sum = increment[(0, i)] * increment[(0, column)];
            for k in 1..size {
                sum += increment[(k, i)] * increment[(k, column)];
            }
            inverse[(i, column)] = -(increment[(i, column)] + sum);
        }
    }
    inverse
}

/// The change `(Sᵀ(m − Σ t × f) − Σ t × f, Sᵀf)` of the moment and of the force of each column by `Ad*_F`.
#[hot]
pub(super) fn adjoint_transpose_increment<T: Real, const N: usize, const D: usize>(
    size: usize,
    increment: &SMatrix<T, N, N>,
    momentum: &SVector<T, D>,
) -> SVector<T, D> {
    let (mut change, mut arms) = (SVector::<T, D>::zeros(), SVector::<T, 3>::zeros());
    for column in size..N {
        let (first, t) = (place(size, column), |i: usize| increment[(i, column)]);
        let f = |i: usize| momentum[first + i];
        for k in 0..turns(size) {
            let (p, q) = if size == 2 { (0, 1) } else { ((k + 1) % 3, (k + 2) % 3) };
            let arm = t(p) * f(q) - t(q) * f(p);
            arms[k] = if column == size { arm } else { arms[k] + arm };
        }
        for i in 0..size {
            let mut sum = increment[(0, i)] * f(0);
            for k in 1..size {
                sum += increment[(k, i)] * f(k);
            }
            change[first + i] = sum;
        }
    }
    if size == 2 {
        change[0] = -arms[0];
        return change;
    }
    for i in 0..3 {
        let rest = |k: usize| momentum[k] - arms[k];
        let sum = increment[(0, i)] * rest(0) + increment[(1, i)] * rest(1) + increment[(2, i)] * rest(2);
        change[i] = sum - arms[i];
    }
    change
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
