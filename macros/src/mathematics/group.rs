//! The groups that a declaration can name: matrix size and generators, in the order of the run-time half.
//!
//! The run-time half declares the same generators; every expansion makes the compiler compare the two.

use crate::mathematics::symbolic::Rational;

/// A matrix Lie group by its generators.
#[derive(Clone, Debug)]
pub(crate) struct Group {
    /// Rows of the matrices.
    pub(crate) size: usize,
    /// `E_k`, row by row.
    pub(crate) generators: Vec<Vec<Rational>>,
    /// `FᵀF = I` holds.
    pub(crate) orthogonal: bool,
    /// Whether it is the group of rotations of space, with its own Cayley form and cross products.
    pub(crate) is_so3: bool,
}

impl Group {
    pub(crate) fn dimension(&self) -> usize {
        self.generators.len()
    }

    /// Linear forms that are the components of `Σ x_k E_k`, each a sum of terms `(k, row, column, factor)` in its entries.
    ///
    /// Elimination picks entries that the generators differ in, so that a component has few terms.
    pub(crate) fn dual(&self) -> Vec<(usize, usize, usize, Rational)> {
        let dimension = self.dimension();
        // Each row is a combination of the generators, and which one it is.
        let mut rows: Vec<(Vec<Rational>, Vec<Rational>)> =
            (0..dimension).filter_map(|k| Some((self.generators.get(k)?.clone(), unit(k, dimension)))).collect();
        let mut pivots = Vec::new();
        for k in 0..rows.len() {
            let Some((entries, factors)) = rows.get(k) else { break };
            let Some(pivot) = entries.iter().position(|entry| !entry.is_zero()) else { break };
            let inverse = entries[pivot].inverse();
            let scaled = |row: &[Rational]| row.iter().map(|&entry| entry * inverse).collect::<Vec<_>>();
            let (entries, factors) = (scaled(entries), scaled(factors));
            for (_, row) in rows.iter_mut().enumerate().filter(|(other, _)| *other != k) {
                let factor = row.0[pivot];
                let eliminate = |from: &mut [Rational], what: &[Rational]| {
                    from.iter_mut().zip(what).for_each(|(a, &b)| *a = *a + -(factor * b));
                };
                eliminate(&mut row.0, &entries);
                eliminate(&mut row.1, &factors);
            }
            rows[k] = (entries, factors);
            pivots.push(pivot);
        }
        // Σ x_k E_k has the pivots p_j = Σ x_k (T⁻¹)_kj, where the rows are T E.
        let terms = rows.iter().zip(pivots).flat_map(|((_, factors), pivot)| {
            let place = move |(k, &factor): (usize, &Rational)| (k, pivot / self.size, pivot % self.size, factor);
            factors.iter().enumerate().filter(|(_, factor)| !factor.is_zero()).map(place)
        });
        terms.collect()
    }

    /// Whether its elements are affine maps in homogeneous coordinates: their last row is that of the identity.
    pub(crate) fn is_affine(&self) -> bool {
        let last_row = self.size * self.size.saturating_sub(1);
        self.generators.iter().all(|generator| generator.iter().skip(last_row).all(|entry| entry.is_zero()))
    }

    /// A group that a user declares.
    pub(crate) fn declared(size: usize, generators: Vec<Vec<Rational>>) -> Self {
        let skew = |generator: &Vec<Rational>| {
            (0..size * size).all(|at| {
                let (row, column) = (at / size, at % size);
                let mirrored = generator.get(column * size + row).copied().unwrap_or(Rational::ZERO);
                generator.get(at).copied() == Some(-mirrored)
            })
        };
        let orthogonal = generators.iter().all(skew);
        Self { size, generators, orthogonal, is_so3: false }
    }
}

/// Row `k` of the identity.
fn unit(k: usize, dimension: usize) -> Vec<Rational> {
    (0..dimension).map(|j| if j == k { Rational::ONE } else { Rational::ZERO }).collect()
}

/// Entries that aren't zero: row, column, numerator, denominator.
type Sparse<'a> = &'a [(usize, usize, i128, i128)];

/// The names that [`built_in`] knows.
pub(crate) const NAMES: [&str; 10] = ["SO2", "SE2", "SO3", "SE3", "SU2", "SL2", "Heisenberg", "R1", "R2", "R3"];

/// The group of that name.
pub(crate) fn built_in(name: &str) -> Option<Group> {
    let (size, generators): (usize, &[Sparse]) = match name {
        "SO2" => (2, &[&[(0, 1, -1, 1), (1, 0, 1, 1)]]),
        "SE2" => (3, &[&[(0, 1, -1, 1), (1, 0, 1, 1)], &[(0, 2, 1, 1)], &[(1, 2, 1, 1)]]),
        "SO3" => (3, &ROTATIONS),
        "SE3" => (4, &[ROTATIONS[0], ROTATIONS[1], ROTATIONS[2], &[(0, 3, 1, 1)], &[(1, 3, 1, 1)], &[(2, 3, 1, 1)]]),
        // Half the left multiplications by i, j and k, on (1, i, j, k).
        "SU2" => (
            4,
            &[
                &[(0, 1, -1, 2), (1, 0, 1, 2), (2, 3, -1, 2), (3, 2, 1, 2)],
                &[(0, 2, -1, 2), (1, 3, 1, 2), (2, 0, 1, 2), (3, 1, -1, 2)],
                &[(0, 3, -1, 2), (1, 2, -1, 2), (2, 1, 1, 2), (3, 0, 1, 2)],
            ],
        ),
        "SL2" => (2, &[&[(0, 0, 1, 2), (1, 1, -1, 2)], &[(0, 1, 1, 2), (1, 0, 1, 2)], &[(0, 1, -1, 2), (1, 0, 1, 2)]]),
        "Heisenberg" => (3, &[&[(0, 1, 1, 1)], &[(1, 2, 1, 1)], &[(0, 2, 1, 1)]]),
        "R1" => (2, &[&[(0, 1, 1, 1)]]),
        "R2" => (3, &[&[(0, 2, 1, 1)], &[(1, 2, 1, 1)]]),
        "R3" => (4, &[&[(0, 3, 1, 1)], &[(1, 3, 1, 1)], &[(2, 3, 1, 1)]]),
        _ => return None,
    };
    let full = |sparse: &Sparse| {
        let mut entries = vec![Rational::ZERO; size * size];
        for &(row, column, numerator, denominator) in *sparse {
            if let Some(entry) = entries.get_mut(row * size + column) {
                *entry = Rational::new(numerator, denominator);
            }
        }
        entries
    };
    let is_so3 = name == "SO3";
    Some(Group { is_so3, ..Group::declared(size, generators.iter().map(full).collect()) })
}

const ROTATIONS: [Sparse; 3] =
    [&[(1, 2, -1, 1), (2, 1, 1, 1)], &[(0, 2, 1, 1), (2, 0, -1, 1)], &[(0, 1, -1, 1), (1, 0, 1, 1)]];
