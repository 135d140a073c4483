//! Linear systems of a few unknowns on slices, in the order of operations of the library's solves.

/// The solution of `A x = b` for a matrix by rows, by Cramer's rule up to three unknowns and by elimination beyond; NaN or
/// infinite if the matrix is singular.
pub(super) fn solution(matrix: &[f64], right: &[f64]) -> Vec<f64> {
    let n = right.len();
    let at = |i: usize, j: usize| matrix[i * n + j];
    let dot = |row: [f64; 3]| row.iter().zip(right).skip(1).fold(row[0] * right[0], |sum, (a, b)| sum + a * b);
    match n {
        1 => vec![right[0] / at(0, 0)],
        2 => {
            let inverse = 1.0 / (at(0, 0) * at(1, 1) - at(0, 1) * at(1, 0));
            [[at(1, 1), -at(0, 1), 0.0], [-at(1, 0), at(0, 0), 0.0]].map(|row| dot(row) * inverse).into()
        }
        3 => {
            let next = |i: usize| ((i + 1) % 3, (i + 2) % 3);
            let cofactor = |i: usize, j: usize| {
                let ((a, b), (c, d)) = (next(j), next(i));
                at(a, c) * at(b, d) - at(a, d) * at(b, c)
            };
            let adjugate = [0, 1, 2].map(|i| [0, 1, 2].map(|j| cofactor(i, j)));
            let first = adjugate[0];
            let inverse = 1.0 / (at(0, 0) * first[0] + at(1, 0) * first[1] + at(2, 0) * first[2]);
            adjugate.map(|row| dot(row) * inverse).into()
        }
        _ => {
            let (a, mut z) = (triangles(matrix, n), right.to_vec());
            for (k, i) in (0..n).flat_map(|k| (k + 1..n).map(move |i| (k, i))) {
                z[i] -= a[i * n + k] * z[k];
            }
            for k in (0..n).rev() {
                for j in k + 1..n {
                    z[k] -= a[k * n + j] * z[j];
                }
                z[k] /= a[k * n + k];
            }
            z
        }
    }
}

/// Both triangles of an elimination without pivoting.
fn triangles(matrix: &[f64], n: usize) -> Vec<f64> {
    let mut a = matrix.to_vec();
    for (k, i) in (0..n).flat_map(|k| (k + 1..n).map(move |i| (k, i))) {
        let factor = a[i * n + k] / a[k * n + k];
        a[i * n + k] = factor;
        for j in k + 1..n {
            a[i * n + j] -= factor * a[k * n + j];
        }
    }
    a
}

/// The pivots of a symmetric matrix in the order of the basis.
pub(super) struct Pivots {
    /// The smallest pivot relative to its entry of the diagonal, and its component. Pivots after the first that isn't
    /// positive are ignored.
    pub(super) least: (f64, usize),
    /// The product of all.
    pub(super) determinant: f64,
    /// Whether a solution by the factors is finite.
    pub(super) is_finite: bool,
}

impl Pivots {
    pub(super) fn of(matrix: &[f64], n: usize) -> Self {
        let a = triangles(matrix, n);
        let relative = |k: usize| (a[k * n + k] / matrix[k * n + k].abs(), k);
        let least = (1..n).map(relative).fold(relative(0), |least, next| {
            // NaN, the quotient of two zeros, is less than any number.
            if least.0 > 0.0 && (next.0.is_nan() || next.0 < least.0) {
                (next.0, if next.0 > 0.0 { least.1 } else { next.1 })
            } else {
                least
            }
        });
        let determinant: f64 = (0..n).fold(1.0, |product, k| product * a[k * n + k]);
        Self { least, determinant, is_finite: determinant.is_finite() && a.iter().all(|entry| entry.is_finite()) }
    }
}

/// `a · b`.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let products = a.iter().zip(b).map(|(a, b)| a * b);
    products.reduce(|sum, product| sum + product).unwrap_or(0.0)
}

/// Whether all numbers are finite.
pub(super) fn are_finite(numbers: &[f64]) -> bool {
    numbers.iter().all(|number| number.is_finite())
}
