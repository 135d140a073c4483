//! The Cayley map of rigid motions, `[R, X; 0, I]`, in closed form.

use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

use super::{CayleyRetraction, Retraction};
use crate::groups::SO3;
use crate::groups::rigid::{place, turns};
use crate::numbers::{Real, real};

/// The increment `S` of a rotation with half the coordinates `y` in its first rows and columns, and `2/(1 + |y|²)`.
#[hot]
fn rotation<T: Real, const D: usize>(size: usize, half: &SVector<T, D>) -> (Matrix3<T>, T) {
    let two = real::<T>(2.0);
    if size == 2 {
        let scale = two / (T::one() + half[0] * half[0]);
        let (turned, zero) = (scale * half[0], T::zero());
        let shorter = -(turned * half[0]);
        return (Matrix3::new(shorter, -turned, zero, turned, shorter, zero, zero, zero, zero), scale);
    }
    let y = Vector3::new(half[0], half[1], half[2]);
    let scale = two / (T::one() + (y.x * y.x + y.y * y.y + y.z * y.z));
    (<CayleyRetraction as Retraction<SO3<T>>>::increment_of_half(&y), scale)
}

/// The increment `[S, 2x + Sx; 0, 0]` of the Cayley map, as `(I − ŷ)⁻¹ = I + S/2` for the rotation.
#[hot]
pub(super) fn increment_of_half<T: Real, const N: usize, const D: usize>(
    size: usize,
    half: &SVector<T, D>,
) -> SMatrix<T, N, N> {
    let (turned, _) = rotation(size, half);
    let mut increment = SMatrix::zeros();
    for i in 0..size {
        for j in 0..size {
            increment[(i, j)] = turned[(i, j)];
        }
        for column in size..N {
            let x = |k: usize| half[place(size, column) + k];
            let mut sum = turned[(i, 0)] * x(0);
            for k in 1..size {
                sum += turned[(i, k)] * x(k);
            }
            increment[(i, column)] = x(i) + x(i) + sum;
        }
    }
    increment
}

/// The tangent `[t, 0; x × t, 2I + S]` of the Cayley map by half the coordinates, for the tangent `t = (I + ŷ) 2/(1 + |y|²)` of
/// the rotation.
///
/// With the matrix `[ω̂, τ; 0, 0]` of a column for the direction `(e, d)`, `(I − ŷ)(ω̂x + τ) = 2d`.
#[hot]
pub(super) fn tangent_of_half<T: Real, const N: usize, const D: usize>(
    size: usize,
    half: &SVector<T, D>,
) -> SMatrix<T, D, D> {
    let (turned, scale) = rotation(size, half);
    let mut columns = SMatrix::zeros();
    for j in 0..turns(size) {
        columns[(j, j)] = scale;
        if size == 3 {
            // The cross product of `y` with the direction.
            let (next, last) = ((j + 1) % 3, (j + 2) % 3);
            columns[(next, j)] = scale * half[last];
            columns[(last, j)] = -(scale * half[next]);
        }
        for column in size..N {
            let first = place(size, column);
            if size == 2 {
                columns[(first, j)] = half[first + 1] * scale;
                columns[(first + 1, j)] = -(half[first] * scale);
                continue;
            }
            for i in 0..3 {
                let (p, q) = ((i + 1) % 3, (i + 2) % 3);
                columns[(first + i, j)] = half[first + p] * columns[(q, j)] - half[first + q] * columns[(p, j)];
            }
        }
    }
    for column in size..N {
        let first = place(size, column);
        for j in 0..size {
            for i in 0..size {
                columns[(first + i, first + j)] = if i == j { turned[(i, j)] + real(2.0) } else { turned[(i, j)] };
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
