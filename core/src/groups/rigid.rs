//! Rotations with columns beside them, `[R, X; 0, I]`: the common parts of SE(2), SE(3) and SE₂(3).

use nalgebra::{RealField, SMatrix, SVector};

use crate::numbers::Real;

/// The place `(row, column)` of the entry 1 of a rotation's generator, whose other entry is −1 at `(column, row)`: of the one
/// rotation of the plane, or of the `ê_k` of SO(3).
const fn turned(size: usize, k: usize) -> (usize, usize) {
    if size == 2 { (1, 0) } else { ((k + 2) % 3, (k + 1) % 3) }
}

/// The number of rotations of space, or of the plane.
const fn turns(size: usize) -> usize {
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

/// `I + ŷ` for half the coordinates `y` of an increment, or `I − ŷ` for those of its inverse.
#[hot]
pub(super) fn factor<T: Real, const N: usize, const D: usize>(size: usize, half: &SVector<T, D>) -> SMatrix<T, N, N> {
    let mut matrix = SMatrix::identity();
    for k in 0..turns(size) {
        let (row, column) = turned(size, k);
        matrix[(row, column)] = half[k];
        matrix[(column, row)] = -half[k];
    }
    for column in 0..N - size {
        for row in 0..size {
            matrix[(row, size + column)] = half[turns(size) + column * size + row];
        }
    }
    matrix
}

/// The tangent of the Cayley map by half the coordinates, with the columns `2 (A E_j B)^∨` for `A = (I − ŷ)⁻¹` and
/// `B = (I + ŷ)⁻¹`.
#[hot]
pub(super) fn tangent_of_half<T: Real, const N: usize, const D: usize>(
    size: usize,
    a: &SMatrix<T, N, N>,
    b: &SMatrix<T, N, N>,
) -> SMatrix<T, D, D> {
    let (turns, mut columns) = (turns(size), SMatrix::zeros());
    let twice = *a + *a;
    for j in 0..turns {
        let (row, column) = turned(size, j);
        let moved =
            |a: &SMatrix<T, N, N>, p: usize, q: usize| a[(p, row)] * b[(column, q)] - a[(p, column)] * b[(row, q)];
        for k in 0..turns {
            // A rotation's generator has the squared length 2.
            let (p, q) = turned(size, k);
            columns[(k, j)] = moved(a, p, q) - moved(a, q, p);
        }
        for beside in 0..N - size {
            for p in 0..size {
                columns[(turns + beside * size + p, j)] = moved(&twice, p, size + beside);
            }
        }
    }
    for beside in 0..N - size {
        for j in 0..size {
            for p in 0..size {
                let first = turns + beside * size;
                columns[(first + p, first + j)] = twice[(p, j)] * b[(size + beside, size + beside)];
            }
        }
    }
    columns
}

/// The product `A T` for a [tangent](tangent_of_half) `T`: a translation changes nothing but itself.
#[hot]
pub(super) fn times_tangent<T: Real, const N: usize, const D: usize>(
    size: usize,
    a: &SMatrix<T, D, D>,
    tangent: &SMatrix<T, D, D>,
) -> SMatrix<T, D, D> {
    let (turns, mut product) = (turns(size), SMatrix::zeros());
    for i in 0..D {
        for j in 0..turns {
            let mut sum = a[(i, 0)] * tangent[(0, j)];
            for k in 1..D {
                sum += a[(i, k)] * tangent[(k, j)];
            }
            product[(i, j)] = sum;
        }
        for beside in 0..N - size {
            let first = turns + beside * size;
            for j in first..first + size {
                let mut sum = a[(i, first)] * tangent[(first, j)];
                for k in first + 1..first + size {
                    sum += a[(i, k)] * tangent[(k, j)];
                }
                product[(i, j)] = sum;
            }
        }
    }
    product
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
