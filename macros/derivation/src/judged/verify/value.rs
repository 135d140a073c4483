//! Small matrices of numbers.

use super::number::Number;
use crate::mathematics::symbolic::Rational;

/// A matrix, by rows.
#[derive(Clone, Debug)]
pub struct Value<T = f64> {
    pub rows: usize,
    pub columns: usize,
    pub entries: Vec<T>,
}

impl<T: Number> Value<T> {
    pub fn new(rows: usize, columns: usize, mut entry: impl FnMut(usize, usize) -> T) -> Self {
        let entries = (0..rows * columns).map(|at| entry(at / columns, at % columns)).collect();
        Self { rows, columns, entries }
    }

    pub fn scalar(value: T) -> Self {
        Self { rows: 1, columns: 1, entries: vec![value] }
    }

    pub fn column(entries: &[T]) -> Self {
        Self { rows: entries.len(), columns: 1, entries: entries.to_vec() }
    }

    /// The matrix, converted to another kind of number.
    pub fn over<U>(&self, of: impl Fn(T) -> U) -> Value<U> {
        Value { rows: self.rows, columns: self.columns, entries: self.entries.iter().map(|&entry| of(entry)).collect() }
    }

    /// A matrix of rational entries.
    pub fn square(size: usize, entries: &[Rational]) -> Self {
        Self { rows: size, columns: size, entries: entries.iter().map(|&entry| T::of(entry)).collect() }
    }

    /// `Σ v_k E_k`, with the entries of each `E_k` row by row.
    pub fn combination(size: usize, generators: &[Vec<Rational>], v: &[T]) -> Self {
        let zero = Self::new(size, size, |_, _| T::ZERO);
        generators.iter().zip(v).fold(zero, |sum, (entries, &component)| {
            sum.plus(&Self::square(size, entries).map(|entry| entry * component))
        })
    }

    pub fn at(&self, row: usize, column: usize) -> T {
        self.entries.get(row * self.columns + column).copied().unwrap_or(T::UNDEFINED)
    }

    pub fn first(&self) -> T {
        self.at(0, 0)
    }

    pub fn map(&self, f: impl Fn(T) -> T) -> Self {
        Self { entries: self.entries.iter().map(|&x| f(x)).collect(), ..*self }
    }

    pub fn zip(&self, other: &Self, f: impl Fn(T, T) -> T) -> Self {
        Self { entries: self.entries.iter().zip(&other.entries).map(|(&x, &y)| f(x, y)).collect(), ..*self }
    }

    pub fn plus(&self, other: &Self) -> Self {
        self.zip(other, |x, y| x + y)
    }

    pub fn transpose(&self) -> Self {
        Self::new(self.columns, self.rows, |row, column| self.at(column, row))
    }

    pub fn times(&self, other: &Self) -> Self {
        Self::new(self.rows, other.columns, |row, column| {
            (0..self.columns).map(|k| self.at(row, k) * other.at(k, column)).fold(T::ZERO, |sum, term| sum + term)
        })
    }

    /// The inverse by Cramer's rule.
    pub fn inverse(&self) -> Self {
        let reciprocal = T::ONE / self.determinant();
        Self::new(self.rows, self.rows, |row, column| {
            alternating(row + column, self.without(column, row).determinant()) * reciprocal
        })
    }

    pub fn trace(&self) -> T {
        (0..self.rows).fold(T::ZERO, |sum, i| sum + self.at(i, i))
    }

    /// The determinant by Laplace's expansion: the minors of each set of columns with as many of the first rows.
    fn determinant(&self) -> T {
        let mut minors = vec![T::ONE];
        for set in 1_usize..1 << self.rows {
            let row = set.count_ones() as usize - 1;
            let columns = (0..self.rows).filter(|column| set >> column & 1 == 1);
            let terms = columns.map(|column| {
                let behind = (set >> column).count_ones() as usize - 1;
                alternating(behind, self.at(row, column) * minors[set ^ 1 << column])
            });
            minors.push(terms.fold(T::ZERO, |sum, term| sum + term));
        }
        minors.last().copied().unwrap_or(T::ONE)
    }

    fn without(&self, row: usize, column: usize) -> Self {
        let size = self.rows - 1;
        Self::new(size, size, |i, j| self.at(i + usize::from(i >= row), j + usize::from(j >= column)))
    }

    pub fn hat(v: &Self) -> Self {
        let [x, y, z] = [v.at(0, 0), v.at(1, 0), v.at(2, 0)];
        let entries = vec![T::ZERO, -z, y, z, T::ZERO, -x, -y, x, T::ZERO];
        Self { rows: 3, columns: 3, entries }
    }

    /// The vector of the skew part.
    pub fn vee(&self) -> Self {
        let half = T::of(Rational::new(1, 2));
        Self::new(3, 1, |row, _| {
            let (i, j) = ((row + 2) % 3, (row + 1) % 3);
            half * (self.at(i, j) - self.at(j, i))
        })
    }

    pub fn identity(size: usize) -> Self {
        Self::diagonal(size, |_| T::ONE)
    }

    pub fn diagonal(size: usize, entry: impl Fn(usize) -> T) -> Self {
        Self::new(size, size, |row, column| if row == column { entry(row) } else { T::ZERO })
    }
}

/// The value times `(−1)ⁿ`.
fn alternating<T: Number>(n: usize, value: T) -> T {
    if n.is_multiple_of(2) { value } else { -value }
}
