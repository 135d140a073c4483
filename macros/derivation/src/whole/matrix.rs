//! Matrices of values, and their inverses in the order of operations of nalgebra.

use super::values::{Value, Words};

/// A matrix of values, row by row.
#[derive(Clone, Debug)]
pub(super) struct Matrix {
    pub(super) rows: usize,
    pub(super) columns: usize,
    pub(super) entries: Vec<Value>,
}

impl Matrix {
    pub(super) fn of(rows: usize, columns: usize, mut entry: impl FnMut(usize, usize) -> Value) -> Self {
        let entries = (0..rows * columns).map(|at| entry(at / columns, at % columns)).collect();
        Self { rows, columns, entries }
    }

    pub(super) fn identity(size: usize) -> Self {
        Self::of(size, size, |i, j| Value::one_if(i == j))
    }

    pub(super) fn column_of(entries: Vec<Value>) -> Self {
        Self { rows: entries.len(), columns: 1, entries }
    }

    /// The constant matrix of these numbers, with this many rows.
    pub(super) fn known(size: usize, numbers: &[f64]) -> Self {
        Self { rows: size, columns: size, entries: numbers.iter().map(|&number| Value::of(number)).collect() }
    }

    pub(super) fn at(&self, i: usize, j: usize) -> Value {
        self.entries[i * self.columns + j]
    }

    pub(super) fn row(&self, i: usize) -> &[Value] {
        &self.entries[i * self.columns..(i + 1) * self.columns]
    }

    pub(super) fn column(&self, j: usize) -> Vec<Value> {
        (0..self.rows).map(|i| self.at(i, j)).collect()
    }

    pub(super) fn transpose(&self) -> Self {
        Self::of(self.columns, self.rows, |i, j| self.at(j, i))
    }

    pub(super) fn times(&self, words: &mut Words, other: &Self) -> Self {
        Self::of(self.rows, other.columns, |i, j| words.dot(self.row(i), &other.column(j)))
    }

    pub(super) fn plus(&self, words: &mut Words, other: &Self) -> Self {
        Self { entries: words.added(&self.entries, &other.entries), ..*self }
    }

    pub(super) fn minus(&self, words: &mut Words, other: &Self) -> Self {
        Self { entries: words.subtracted(&self.entries, &other.entries), ..*self }
    }

    pub(super) fn negated(&self, words: &mut Words) -> Self {
        Self { entries: self.entries.iter().map(|&entry| words.negate(entry)).collect(), ..*self }
    }

    pub(super) fn scaled(&self, words: &mut Words, by: Value) -> Self {
        Self { entries: self.entries.iter().map(|&entry| words.multiply(entry, by)).collect(), ..*self }
    }

    /// The determinant by Laplace's expansion: the minors of each set of columns with as many of the first rows. It has no
    /// quotients.
    pub(super) fn determinant(&self, words: &mut Words) -> Value {
        let mut minors = vec![Value::ONE];
        for set in 1_usize..1 << self.rows {
            let row = set.count_ones() as usize - 1;
            let columns = (0..self.rows).filter(|column| set >> column & 1 == 1);
            let sum = columns.fold(Value::ZERO, |sum, column| {
                let product = words.multiply(self.at(row, column), minors[set ^ 1 << column]);
                let is_even = (set >> column).count_ones() % 2 == 1;
                if is_even { words.add(sum, product) } else { words.subtract(sum, product) }
            });
            minors.push(sum);
        }
        minors.last().copied().unwrap_or(Value::ONE)
    }

    /// `A⁻¹`. From five rows on it is that by LU without the search for pivots, which near the identity are on the
    /// diagonal.
    pub(super) fn inverse(&self, words: &mut Words) -> Self {
        match self.rows {
            1 => Self { entries: vec![words.divide(Value::ONE, self.at(0, 0))], ..*self },
            2 => self.inverse_of_two(words),
            3 => self.inverse_of_three(words),
            4 => self.inverse_of_four(words),
            _ => self.inverse_by_elimination(words),
        }
    }

    /// `M_ij M_kl − M_pq M_rs`, with rows and columns from one.
    fn minor(&self, words: &mut Words, [a, b]: [(usize, usize); 2], [c, d]: [(usize, usize); 2]) -> Value {
        let at = |(i, j): (usize, usize)| self.at(i - 1, j - 1);
        let (p, q) = (words.multiply(at(a), at(b)), words.multiply(at(c), at(d)));
        words.subtract(p, q)
    }

    fn inverse_of_two(&self, words: &mut Words) -> Self {
        let det = self.minor(words, [(1, 1), (2, 2)], [(2, 1), (1, 2)]);
        let adjugate = [self.at(1, 1), words.negate(self.at(0, 1)), words.negate(self.at(1, 0)), self.at(0, 0)];
        Self { entries: adjugate.map(|entry| words.divide(entry, det)).to_vec(), ..*self }
    }

    fn inverse_of_three(&self, words: &mut Words) -> Self {
        let mut minor = |a, b| self.minor(words, a, b);
        let first = minor([(2, 2), (3, 3)], [(3, 2), (2, 3)]);
        let second = minor([(2, 1), (3, 3)], [(3, 1), (2, 3)]);
        let third = minor([(2, 1), (3, 2)], [(3, 1), (2, 2)]);
        let others = [
            minor([(1, 3), (3, 2)], [(3, 3), (1, 2)]),
            minor([(1, 2), (2, 3)], [(2, 2), (1, 3)]),
            minor([(1, 1), (3, 3)], [(3, 1), (1, 3)]),
            minor([(1, 3), (2, 1)], [(2, 3), (1, 1)]),
            minor([(1, 2), (3, 1)], [(3, 2), (1, 1)]),
            minor([(1, 1), (2, 2)], [(2, 1), (1, 2)]),
        ];
        let p = words.multiply(self.at(0, 0), first);
        let q = words.multiply(self.at(0, 1), second);
        let r = words.multiply(self.at(0, 2), third);
        let difference = words.subtract(p, q);
        let det = words.add(difference, r);
        let second = words.negate(second);
        let [a, b, c, d, e, f] = others;
        let adjugate = [first, a, b, second, c, d, third, e, f];
        Self { entries: adjugate.map(|entry| words.divide(entry, det)).to_vec(), ..*self }
    }

    /// The cofactors are sums of six products of three entries, which [`COFACTORS`] lists.
    fn inverse_of_four(&self, words: &mut Words) -> Self {
        let by_columns = self.transpose().entries;
        let cofactor = |words: &mut Words, terms: &[(bool, usize, usize, usize); 6]| {
            terms.iter().fold(Value::ZERO, |sum, &(is_added, a, b, c)| {
                let pair = words.multiply(by_columns[a], by_columns[b]);
                let product = words.multiply(pair, by_columns[c]);
                if is_added { words.add(sum, product) } else { words.subtract(sum, product) }
            })
        };
        let cofactors: Vec<Value> = COFACTORS.iter().map(|terms| cofactor(words, terms)).collect();
        let det = words.dot(&by_columns[..4], &cofactors[..4]);
        let inverse = words.divide(Value::ONE, det);
        Self { entries: cofactors.iter().map(|&entry| words.multiply(entry, inverse)).collect(), ..*self }
    }

    fn inverse_by_elimination(&self, words: &mut Words) -> Self {
        let n = self.rows;
        let mut lu = self.clone();
        for k in 0..n {
            let pivot = words.divide(Value::ONE, lu.at(k, k));
            for i in k + 1..n {
                lu.entries[i * n + k] = words.multiply(lu.at(i, k), pivot);
            }
            for (i, j) in (k + 1..n).flat_map(|i| (k + 1..n).map(move |j| (i, j))) {
                lu.entries[i * n + j] = words.less(lu.at(i, j), lu.at(i, k), lu.at(k, j));
            }
        }
        let mut inverse = Self::identity(n);
        for column in 0..n {
            let mut x = inverse.column(column);
            for k in 0..n {
                for i in k + 1..n {
                    x[i] = words.less(x[i], lu.at(i, k), x[k]);
                }
            }
            for k in (0..n).rev() {
                x[k] = words.divide(x[k], lu.at(k, k));
                for i in 0..k {
                    x[i] = words.less(x[i], lu.at(i, k), x[k]);
                }
            }
            for (i, entry) in x.into_iter().enumerate() {
                inverse.entries[i * n + column] = entry;
            }
        }
        inverse
    }
}

impl Words {
    /// `a − b c`.
    pub(super) fn less(&mut self, a: Value, b: Value, c: Value) -> Value {
        let product = self.multiply(b, c);
        self.subtract(a, product)
    }
}

/// The entries of the adjugate of four rows, row by row: whether a product is added, and its factors as places column by
/// column.
#[rustfmt::skip]
const COFACTORS: [[(bool, usize, usize, usize); 6]; 16] = {
    const P: bool = true;
    const M: bool = false;
    [
        [(P, 5, 10, 15), (M, 5, 11, 14), (M, 9, 6, 15), (P, 9, 7, 14), (P, 13, 6, 11), (M, 13, 7, 10)],
        [(M, 4, 10, 15), (P, 4, 11, 14), (P, 8, 6, 15), (M, 8, 7, 14), (M, 12, 6, 11), (P, 12, 7, 10)],
        [(P, 4, 9, 15), (M, 4, 11, 13), (M, 8, 5, 15), (P, 8, 7, 13), (P, 12, 5, 11), (M, 12, 7, 9)],
        [(M, 4, 9, 14), (P, 4, 10, 13), (P, 8, 5, 14), (M, 8, 6, 13), (M, 12, 5, 10), (P, 12, 6, 9)],
        [(M, 1, 10, 15), (P, 1, 11, 14), (P, 9, 2, 15), (M, 9, 3, 14), (M, 13, 2, 11), (P, 13, 3, 10)],
        [(P, 0, 10, 15), (M, 0, 11, 14), (M, 8, 2, 15), (P, 8, 3, 14), (P, 12, 2, 11), (M, 12, 3, 10)],
        [(M, 0, 9, 15), (P, 0, 11, 13), (P, 8, 1, 15), (M, 8, 3, 13), (M, 12, 1, 11), (P, 12, 3, 9)],
        [(P, 0, 9, 14), (M, 0, 10, 13), (M, 8, 1, 14), (P, 8, 2, 13), (P, 12, 1, 10), (M, 12, 2, 9)],
        [(P, 1, 6, 15), (M, 1, 7, 14), (M, 5, 2, 15), (P, 5, 3, 14), (P, 13, 2, 7), (M, 13, 3, 6)],
        [(M, 0, 6, 15), (P, 0, 7, 14), (P, 4, 2, 15), (M, 4, 3, 14), (M, 12, 2, 7), (P, 12, 3, 6)],
        [(P, 0, 5, 15), (M, 0, 7, 13), (M, 4, 1, 15), (P, 4, 3, 13), (P, 12, 1, 7), (M, 12, 3, 5)],
        [(M, 0, 5, 14), (P, 0, 6, 13), (P, 4, 1, 14), (M, 4, 2, 13), (M, 12, 1, 6), (P, 12, 2, 5)],
        [(M, 1, 6, 11), (P, 1, 7, 10), (P, 5, 2, 11), (M, 5, 3, 10), (M, 9, 2, 7), (P, 9, 3, 6)],
        [(P, 0, 6, 11), (M, 0, 7, 10), (M, 4, 2, 11), (P, 4, 3, 10), (P, 8, 2, 7), (M, 8, 3, 6)],
        [(M, 0, 5, 11), (P, 0, 7, 9), (P, 4, 1, 11), (M, 4, 3, 9), (M, 8, 1, 7), (P, 8, 3, 5)],
        [(P, 0, 5, 10), (M, 0, 6, 9), (M, 4, 1, 10), (P, 4, 2, 9), (P, 8, 1, 6), (M, 8, 2, 5)],
    ]
};
