//! The declaration of a matrix group, and its constants, computed when the user's crate is compiled.

use core::fmt::Debug;

use nalgebra::{RealField, SMatrix};

use crate::numbers::{Real, real};

/// The declaration of a matrix group: the basis `E_k` of its Lie algebra, and the relation its elements satisfy.
///
/// `N` is the size of the matrices and `D` the dimension of the group. Implement it for an empty marker type; the group
/// is then [`MatrixGroup`](crate::groups::MatrixGroup) of that marker, best under an alias.
///
/// The basis must be independent and span a Lie algebra. Both are checked when the user's crate is compiled. That the
/// elements satisfy the relation is a law to be tested:
/// [`lie_group_laws`](crate::laws::lie_group_laws).
///
/// # Examples
///
/// The affine maps `x ↦ a x + b` of the line, `a > 0`:
///
/// ```
/// use liestep::groups::matrix;
/// use liestep::groups::{CayleyRetraction, Generators, LieGroup, MatrixGroup, Retraction};
/// use nalgebra::{Matrix2, RealField, SMatrix, Vector2};
///
/// #[derive(Clone, Copy, Debug, PartialEq)]
/// struct AffineGenerators;
///
/// impl Generators<2, 2> for AffineGenerators {
///     const GENERATORS: [[[f64; 2]; 2]; 2] = [matrix(&[(0, 0, 1.0)]), matrix(&[(0, 1, 1.0)])];
///
///     fn relation<T: RealField + Copy>(m: &SMatrix<T, 2, 2>) -> T {
///         m[(1, 0)].abs() + (m[(1, 1)] - T::one()).abs()
///     }
/// }
///
/// type Affine<T = f64> = MatrixGroup<AffineGenerators, T, 2, 2>;
///
/// let map: Affine = CayleyRetraction::retract(&Vector2::new(1.0, 1.0));
/// assert_eq!(map.matrix(), Matrix2::new(3.0, 2.0, 0.0, 1.0));
/// ```
///
/// Generators that depend on each other don't compile, nor do those of a group that the Cayley map leaves if the cube of one
/// isn't a multiple of it ([`CayleyRetraction`](crate::groups::CayleyRetraction)). Here the cube of `diag(1, 2)` isn't:
///
/// ```compile_fail,E0080
/// # use liestep::groups::matrix;
/// # use liestep::groups::{CayleyRetraction, Generators, MatrixGroup, Retraction};
/// # use nalgebra::{RealField, SMatrix, Vector1};
/// # #[derive(Clone, Copy, Debug, PartialEq)]
/// # struct Stretch;
/// impl Generators<2, 1> for Stretch {
///     const GENERATORS: [[[f64; 2]; 2]; 1] = [matrix(&[(0, 0, 1.0), (1, 1, 2.0)])];
/// #     fn relation<T: RealField + Copy>(m: &SMatrix<T, 2, 2>) -> T {
/// #         (m.m11 * m.m11 - m.m22).abs()
/// #     }
/// }
///
/// let map: MatrixGroup<Stretch, f64, 2, 1> = CayleyRetraction::retract(&Vector1::new(0.1));
/// ```
pub trait Generators<const N: usize, const D: usize>: Copy + Debug + PartialEq + 'static {
    /// The basis `E_k`, each matrix by rows; [`matrix`] writes one by its entries.
    const GENERATORS: [[[f64; N]; N]; D];

    /// The names of a translation's coordinates, in the last column; empty for other groups.
    #[doc(hidden)]
    const COORDINATES: &'static [&'static str] = &[];

    /// The residual of the group's relation; zero for elements of the group only.
    fn relation<T: RealField + Copy>(matrix: &SMatrix<T, N, N>) -> T;

    /// The inverse of an element; not finite if there is none.
    ///
    /// Override it if the relation yields the inverse in closed form.
    #[must_use]
    fn inverse<T: RealField + Copy>(matrix: &SMatrix<T, N, N>) -> SMatrix<T, N, N> {
        inverse(matrix)
    }

    /// Whether an increment with the coordinates `ξ̂` is so small that a solution there is surely on the branch of the
    /// identity.
    ///
    /// The default is `‖ξ̂‖ < 1` in the Frobenius norm. No theorem like that of SO(3) supports it, so it errs on the
    /// side of another check of the solution, which costs only time.
    #[must_use]
    fn is_near_identity<T: RealField + Copy>(algebra: &SMatrix<T, N, N>) -> bool {
        algebra.norm_squared() < T::one()
    }
}

/// The matrix with the entries `(row, column, value)`, counted from zero, and zeros elsewhere.
#[must_use]
pub const fn matrix<const N: usize>(entries: &[(usize, usize, f64)]) -> [[f64; N]; N] {
    let mut matrix = [[0.0; N]; N];
    let mut next = 0;
    while next < entries.len() {
        let (row, column, value) = entries[next];
        matrix[row][column] = value;
        next += 1;
    }
    matrix
}

/// The inverse `A⁻¹`, or infinities.
pub(crate) fn inverse<T: RealField + Copy, const N: usize>(matrix: &SMatrix<T, N, N>) -> SMatrix<T, N, N> {
    matrix.try_inverse().unwrap_or_else(|| SMatrix::repeat(T::one() / T::zero()))
}

/// The matrix `A` with entries of the scalar type.
pub(crate) fn dynamic<T: Real, const N: usize>(matrix: &[[f64; N]; N]) -> SMatrix<T, N, N> {
    SMatrix::from_fn(|row, column| real(matrix[row][column]))
}

/// Square of the rounding in products of written-out generators.
const ROUNDING_SQUARED: f64 = 1e-24;

/// The pairing `tr(AᵀB)`.
const fn pairing<const N: usize>(a: &[[f64; N]; N], b: &[[f64; N]; N]) -> f64 {
    let (mut sum, mut i) = (0.0, 0);
    while i < N {
        let mut j = 0;
        while j < N {
            sum += a[i][j] * b[i][j];
            j += 1;
        }
        i += 1;
    }
    sum
}

/// The sum `C + s A B`.
const fn add_product<const N: usize>(c: &[[f64; N]; N], s: f64, a: &[[f64; N]; N], b: &[[f64; N]; N]) -> [[f64; N]; N] {
    let (mut result, mut i) = (*c, 0);
    while i < N {
        let mut j = 0;
        while j < N {
            let mut k = 0;
            while k < N {
                result[i][j] += s * a[i][k] * b[k][j];
                k += 1;
            }
            j += 1;
        }
        i += 1;
    }
    result
}

/// The squared lengths `tr(E_kᵀ E_k)` of the basis.
pub(super) const fn squared_lengths<const N: usize, const D: usize>(basis: &[[[f64; N]; N]; D]) -> [f64; D] {
    let (mut lengths, mut i) = ([0.0; D], 0);
    while i < D {
        lengths[i] = pairing(&basis[i], &basis[i]);
        assert!(lengths[i] > 0.0, "a generator is zero");
        i += 1;
    }
    lengths
}

/// Whether `tr(E_jᵀ E_k) = 0` for any two of the basis.
pub(super) const fn is_orthogonal<const N: usize, const D: usize>(basis: &[[[f64; N]; N]; D]) -> bool {
    let (lengths, mut place) = (squared_lengths(basis), 0);
    while place < D * D {
        let (i, j) = (place / D, place % D);
        let product = pairing(&basis[i], &basis[j]);
        if i != j && product * product > ROUNDING_SQUARED * lengths[i] * lengths[j] {
            return false;
        }
        place += 1;
    }
    true
}

/// The dual basis `E^k` in the span of the basis, `tr((E^k)ᵀ E_j) = 1` for `j = k` and else zero.
pub(super) const fn dual<const N: usize, const D: usize>(basis: &[[[f64; N]; N]; D]) -> [[[f64; N]; N]; D] {
    let lengths = squared_lengths(basis);
    // The inverse of the pairings of the basis by elimination; pivots of a positive definite matrix are on the diagonal.
    let (mut gram, mut inverse, mut place) = ([[0.0; D]; D], [[0.0; D]; D], 0);
    while place < D * D {
        let (i, j) = (place / D, place % D);
        gram[i][j] = pairing(&basis[i], &basis[j]);
        inverse[i][j] = if i == j { 1.0 } else { 0.0 };
        place += 1;
    }
    let mut k = 0;
    while k < D {
        let pivot = gram[k][k];
        assert!(pivot > 1e-9 * lengths[k], "a generator is a combination of those before it");
        let mut j = 0;
        while j < D {
            gram[k][j] /= pivot;
            inverse[k][j] /= pivot;
            j += 1;
        }
        let mut place = 0;
        while place < D * D {
            let (i, j) = (place / D, (place + k + 1) % D);
            // The column of the pivot comes last, as it is the factor of its row.
            if i != k {
                let factor = gram[i][k];
                inverse[i][j] -= factor * inverse[k][j];
                gram[i][j] -= factor * gram[k][j];
            }
            place += 1;
        }
        k += 1;
    }
    let (mut all, mut place) = ([[[0.0; N]; N]; D], 0);
    while place < D * D {
        all[place / D] = add_scaled(&all[place / D], inverse[place / D][place % D], &basis[place % D]);
        place += 1;
    }
    all
}

/// The sum `C + s A`; what is left of entries that cancel is zero.
const fn add_scaled<const N: usize>(c: &[[f64; N]; N], s: f64, a: &[[f64; N]; N]) -> [[f64; N]; N] {
    let (mut result, mut place) = (*c, 0);
    while place < N * N {
        let (i, j) = (place / N, place % N);
        let product = s * a[i][j];
        result[i][j] += product;
        if result[i][j].abs() <= 1e-14 * product.abs() {
            result[i][j] = 0.0;
        }
        place += 1;
    }
    result
}

/// The components of `A` in the basis, and whether `A` is in its span, by a residual relative to `scale`.
const fn components<const N: usize, const D: usize>(
    [basis, dual]: [&[[[f64; N]; N]; D]; 2],
    a: &[[f64; N]; N],
    scale: f64,
) -> ([f64; D], bool) {
    let (mut result, mut rest, mut k) = ([0.0; D], *a, 0);
    while k < D {
        result[k] = pairing(a, &dual[k]);
        rest = add_scaled(&rest, -result[k], &basis[k]);
        k += 1;
    }
    (result, pairing(&rest, &rest) <= 1e-12 * scale)
}

/// The number `c` with `E³ = c E`, of each generator; none if the cube of one isn't a multiple of it.
pub(crate) const fn cubes<const N: usize, const D: usize>(basis: &[[[f64; N]; N]; D]) -> Option<[f64; D]> {
    let (lengths, zero) = (squared_lengths(basis), [[0.0; N]; N]);
    let (mut all, mut k) = ([0.0; D], 0);
    while k < D {
        let square = add_product(&zero, 1.0, &basis[k], &basis[k]);
        let cube = add_product(&zero, 1.0, &square, &basis[k]);
        all[k] = pairing(&cube, &basis[k]) / lengths[k];
        let rest = add_scaled(&cube, -all[k], &basis[k]);
        if pairing(&rest, &rest) > 1e-12 * lengths[k] * lengths[k] * lengths[k] {
            return None;
        }
        k += 1;
    }
    Some(all)
}

/// The squares `E_k²`.
pub(crate) const fn squares<const N: usize, const D: usize>(basis: &[[[f64; N]; N]; D]) -> [[[f64; N]; N]; D] {
    let (mut all, mut k) = ([[[0.0; N]; N]; D], 0);
    while k < D {
        all[k] = add_product(&[[0.0; N]; N], 1.0, &basis[k], &basis[k]);
        k += 1;
    }
    all
}

/// The structure constants `c[i][j][k]` with `[E_i, E_j] = Σ c[i][j][k] E_k`, after a check that the span is an
/// algebra.
pub(super) const fn structure_constants<const N: usize, const D: usize>(
    basis: &[[[f64; N]; N]; D],
) -> [[[f64; D]; D]; D] {
    let (lengths, dual) = (squared_lengths(basis), dual(basis));
    let (mut constants, mut i) = ([[[0.0; D]; D]; D], 0);
    while i < D {
        let mut j = 0;
        while j < D {
            let product = add_product(&[[0.0; N]; N], 1.0, &basis[i], &basis[j]);
            let commutator = add_product(&product, -1.0, &basis[j], &basis[i]);
            let (bracket, closed) = components([basis, &dual], &commutator, lengths[i] * lengths[j]);
            assert!(closed, "the generators don't span a Lie algebra: a commutator leaves their span");
            constants[i][j] = bracket;
            j += 1;
        }
        i += 1;
    }
    constants
}

/// The nonzero entries of a matrix, each with its row and column, and their count; the array is padded behind them. The
/// compiler unrolls a loop over so few, but not one that tests all entries.
pub(crate) type NonZero<const N: usize> = ([[(usize, usize, f64); N]; N], usize);

/// The nonzero entries of all generators, row by row.
pub(crate) const fn nonzero_entries<const N: usize, const D: usize>(basis: &[[[f64; N]; N]; D]) -> [NonZero<N>; D] {
    let mut all = [([[(0, 0, 0.0); N]; N], 0); D];
    let mut k = 0;
    while k < D {
        let (mut place, mut count) = (0, 0);
        while place < N * N {
            let (row, column) = (place / N, place % N);
            if basis[k][row][column] != 0.0 {
                all[k].0[count / N][count % N] = (row, column, basis[k][row][column]);
                count += 1;
            }
            place += 1;
        }
        all[k].1 = count;
        k += 1;
    }
    all
}

/// Whether the product of any two generators vanishes, as for translations: then `(I + X)(I + Y) = I + X + Y`.
pub(crate) const fn products_vanish<const N: usize, const D: usize>(basis: &[[[f64; N]; N]; D]) -> bool {
    let mut place = 0;
    while place < D * D {
        let product = add_product(&[[0.0; N]; N], 1.0, &basis[place / D], &basis[place % D]);
        let mut entry = 0;
        while entry < N * N {
            if product[entry / N][entry % N] != 0.0 {
                return false;
            }
            entry += 1;
        }
        place += 1;
    }
    true
}

/// The number of rows down to the last in which a generator has an entry; the rows below are those of the identity in all
/// elements of the group.
pub(crate) const fn changed_rows<const N: usize, const D: usize>(basis: &[[[f64; N]; N]; D]) -> usize {
    let (mut rows, mut place) = (0, 0);
    while place < D * N * N {
        let row = place / N % N;
        if row >= rows && basis[place / (N * N)][row][place % N] != 0.0 {
            rows = row + 1;
        }
        place += 1;
    }
    rows
}

/// Whether the symmetrised products of any three generators lie in their span.
///
/// If they do, so do all odd powers of `ξ̂`, and then `(d/dt cay(tξ)) cay(tξ)⁻¹ = ξ̂ (I − t²ξ̂²/4)⁻¹`, so that the
/// Cayley map stays in the group.
pub(crate) const fn is_closed_under_cayley<const N: usize, const D: usize>(basis: &[[[f64; N]; N]; D]) -> bool {
    let (lengths, dual) = (squared_lengths(basis), dual(basis));
    let zero = [[0.0; N]; N];
    let mut i = 0;
    while i < D {
        let mut j = i;
        while j < D {
            let anticommutator = add_product(&add_product(&zero, 1.0, &basis[i], &basis[j]), 1.0, &basis[j], &basis[i]);
            let mut k = j;
            while k < D {
                let of_ik = add_product(&add_product(&zero, 1.0, &basis[i], &basis[k]), 1.0, &basis[k], &basis[i]);
                let of_jk = add_product(&add_product(&zero, 1.0, &basis[j], &basis[k]), 1.0, &basis[k], &basis[j]);
                let sum = add_product(&zero, 1.0, &basis[k], &anticommutator);
                let sum = add_product(&sum, 1.0, &basis[j], &of_ik);
                let sum = add_product(&sum, 1.0, &basis[i], &of_jk);
                if !components([basis, &dual], &sum, lengths[i] * lengths[j] * lengths[k]).1 {
                    return false;
                }
                k += 1;
            }
            j += 1;
        }
        i += 1;
    }
    true
}
