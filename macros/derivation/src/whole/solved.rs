//! Linear systems of a step, written out in the order of operations of the library's solves.

use super::matrix::Matrix;
use super::values::{Value, Words};

/// The blocks of a system.
#[derive(Clone, Debug)]
pub(super) struct Pattern {
    pub(super) dimension: usize,
    /// The components at which factors begin, but the first; empty if there is one factor.
    pub(super) factors: Vec<usize>,
    /// The components at which blocks of the system end that aren't coupled to each other.
    pub(super) apart: Vec<usize>,
}

/// A matrix in factors.
pub(super) struct Factorisation {
    /// The factors, row by row, in the place of the matrix.
    pub(super) factors: Vec<Value>,
    /// The determinant of each block, and the product of its diagonal; one where that isn't needed.
    pub(super) determinants: Vec<[Value; 2]>,
}

impl Pattern {
    /// A system of one block.
    pub(super) fn whole(dimension: usize) -> Self {
        Self { dimension, factors: Vec::new(), apart: Vec::new() }
    }

    /// Begins and ends of the blocks.
    fn blocks(&self) -> Vec<(usize, usize)> {
        let ends = self.apart.iter().copied().filter(|&end| 0 < end && end < self.dimension);
        let mut ends: Vec<usize> = ends.chain([self.dimension]).collect();
        ends.sort_unstable();
        ends.dedup();
        ends.iter().scan(0, |start, &end| Some((std::mem::replace(start, end), end))).collect()
    }

    /// The number of determinants of a factorisation.
    pub(super) fn determinants(&self) -> usize {
        if self.factors.is_empty() {
            return 1;
        }
        let ends = self.blocks().into_iter().map(|(_, end)| end);
        let mut ends: Vec<usize> = ends.chain(self.factors.iter().copied()).collect();
        ends.sort_unstable();
        ends.dedup();
        ends.len()
    }

    /// Whether a block is one factor with a closed form.
    fn is_small(&self, (start, end): (usize, usize)) -> bool {
        end - start <= 3 && !self.factors.iter().any(|&at| start < at && at < end)
    }

    /// The factors of a matrix.
    pub(super) fn factorise(&self, words: &mut Words, matrix: &Matrix) -> Factorisation {
        if self.factors.is_empty() {
            let (factors, determinant) = factorise_whole(words, matrix);
            return Factorisation { factors, determinants: vec![[determinant, Value::ONE]] };
        }
        let (mut a, mut determinants) = (matrix.clone(), Vec::new());
        for (start, end) in self.blocks() {
            if !self.is_small((start, end)) {
                self.eliminate(words, &mut a, (start, end), &mut determinants);
                continue;
            }
            let size = end - start;
            let block = Matrix::of(size, size, |i, j| matrix.at(start + i, start + j));
            let diagonal = (0..size).fold(Value::ONE, |product, i| words.multiply(product, block.at(i, i)));
            let (adjugate, determinant) = adjugate(words, &block);
            determinants.push([determinant, diagonal]);
            let inverse = words.divide(Value::ONE, determinant);
            for (at, &value) in adjugate.iter().enumerate() {
                let place = (start + at / size) * self.dimension + start + at % size;
                a.entries[place] = words.multiply(value, inverse);
            }
        }
        Factorisation { factors: a.entries, determinants }
    }

    /// Eliminates in a block of several factors, with reciprocal pivots.
    fn eliminate(
        &self,
        words: &mut Words,
        a: &mut Matrix,
        (start, end): (usize, usize),
        determinants: &mut Vec<[Value; 2]>,
    ) {
        let (n, before) = (self.dimension, a.clone());
        let [mut determinant, mut diagonal] = [Value::ONE; 2];
        for k in start..end {
            determinant = words.multiply(determinant, a.at(k, k));
            diagonal = words.multiply(diagonal, before.at(k, k));
            if k + 1 == end || self.factors.contains(&(k + 1)) {
                determinants.push([determinant, diagonal]);
                [determinant, diagonal] = [Value::ONE; 2];
            }
            let inverse = words.divide(Value::ONE, a.at(k, k));
            for i in k + 1..end {
                let factor = words.multiply(a.at(i, k), inverse);
                a.entries[i * n + k] = factor;
                for j in k + 1..end {
                    a.entries[i * n + j] = words.less(a.at(i, j), factor, a.at(k, j));
                }
            }
            a.entries[k * n + k] = inverse;
        }
    }

    /// The solution by the factors and, where the system is one block, its determinant.
    pub(super) fn solve(
        &self,
        words: &mut Words,
        factors: &[Value],
        determinant: Value,
        right: &[Value],
    ) -> Vec<Value> {
        let n = self.dimension;
        let factors = Matrix { rows: n, columns: n, entries: factors.to_vec() };
        let mut z = right.to_vec();
        if self.factors.is_empty() {
            solve_whole(words, &factors, determinant, &mut z);
            return z;
        }
        for (start, end) in self.blocks() {
            if self.is_small((start, end)) {
                for (i, z) in z.iter_mut().enumerate().take(end).skip(start) {
                    *z = words.dot(&factors.row(i)[start..end], &right[start..end]);
                }
                continue;
            }
            for (k, i) in (start..end).flat_map(|k| (k + 1..end).map(move |i| (k, i))) {
                z[i] = words.less(z[i], factors.at(i, k), z[k]);
            }
            for k in (start..end).rev() {
                for j in k + 1..end {
                    z[k] = words.less(z[k], factors.at(k, j), z[j]);
                }
                z[k] = words.multiply(z[k], factors.at(k, k));
            }
        }
        z
    }
}

/// The factors of a system of one factor, and its determinant: the adjugate of up to three rows, else triangles.
fn factorise_whole(words: &mut Words, matrix: &Matrix) -> (Vec<Value>, Value) {
    let n = matrix.rows;
    if n <= 3 {
        return adjugate(words, matrix);
    }
    let (mut a, mut determinant) = (matrix.clone(), Value::ONE);
    for k in 0..n {
        determinant = words.multiply(determinant, a.at(k, k));
        for i in k + 1..n {
            let factor = words.divide(a.at(i, k), a.at(k, k));
            a.entries[i * n + k] = factor;
            for j in k + 1..n {
                a.entries[i * n + j] = words.less(a.at(i, j), factor, a.at(k, j));
            }
        }
    }
    (a.entries, determinant)
}

fn solve_whole(words: &mut Words, factors: &Matrix, determinant: Value, z: &mut [Value]) {
    let n = factors.rows;
    match n {
        1 => z[0] = words.divide(z[0], determinant),
        2 | 3 => {
            let inverse = words.divide(Value::ONE, determinant);
            let right = z.to_vec();
            for (i, z) in z.iter_mut().enumerate() {
                let sum = words.dot(factors.row(i), &right);
                *z = words.multiply(sum, inverse);
            }
        }
        _ => {
            for (k, i) in (0..n).flat_map(|k| (k + 1..n).map(move |i| (k, i))) {
                z[i] = words.less(z[i], factors.at(i, k), z[k]);
            }
            for k in (0..n).rev() {
                for j in k + 1..n {
                    z[k] = words.less(z[k], factors.at(k, j), z[j]);
                }
                z[k] = words.divide(z[k], factors.at(k, k));
            }
        }
    }
}

/// The adjugate and the determinant, by the first column, of a matrix of one to three rows.
fn adjugate(words: &mut Words, m: &Matrix) -> (Vec<Value>, Value) {
    match m.rows {
        1 => (vec![Value::ONE], m.at(0, 0)),
        2 => {
            let (p, q) = (words.multiply(m.at(0, 0), m.at(1, 1)), words.multiply(m.at(0, 1), m.at(1, 0)));
            let determinant = words.subtract(p, q);
            (vec![m.at(1, 1), words.negate(m.at(0, 1)), words.negate(m.at(1, 0)), m.at(0, 0)], determinant)
        }
        _ => {
            let next = |i: usize| ((i + 1) % 3, (i + 2) % 3);
            // The cofactor of the entry (j, i), in cyclic order.
            let cofactors = Matrix::of(3, 3, |i, j| {
                let ((a, b), (c, d)) = (next(j), next(i));
                let (p, q) = (words.multiply(m.at(a, c), m.at(b, d)), words.multiply(m.at(a, d), m.at(b, c)));
                words.subtract(p, q)
            });
            let determinant = words.dot(&m.column(0), cofactors.row(0));
            (cofactors.entries, determinant)
        }
    }
}
