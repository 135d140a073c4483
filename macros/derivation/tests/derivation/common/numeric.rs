//! Expressions evaluated on matrices of numbers, term by term, without the rewrites and the scalarisation of the
//! library.

use std::collections::BTreeMap;

use liestep_derivation::mathematics::symbolic::{Atom, Expression, Factor, Monomial, Rational, SymbolId, Symbols};

/// A matrix, row by row.
#[derive(Clone, Debug)]
pub(crate) struct Matrix {
    pub(crate) rows: usize,
    pub(crate) columns: usize,
    pub(crate) entries: Vec<f64>,
}

impl Matrix {
    pub(crate) fn new(rows: usize, columns: usize, mut entry: impl FnMut(usize, usize) -> f64) -> Self {
        let entries = (0..rows * columns).map(|at| entry(at / columns, at % columns)).collect();
        Self { rows, columns, entries }
    }

    pub(crate) fn scalar(value: f64) -> Self {
        Self::new(1, 1, |_, _| value)
    }

    pub(crate) fn identity(size: usize) -> Self {
        Self::new(size, size, |row, column| f64::from(u8::from(row == column)))
    }

    pub(crate) fn unit(index: usize, size: usize) -> Self {
        Self::new(size, 1, |row, _| f64::from(u8::from(row == index)))
    }

    pub(crate) fn at(&self, row: usize, column: usize) -> f64 {
        self.entries[row * self.columns + column]
    }

    pub(crate) fn scaled(&self, factor: f64) -> Self {
        Self::new(self.rows, self.columns, |row, column| factor * self.at(row, column))
    }

    pub(crate) fn plus(&self, other: &Self) -> Self {
        assert_eq!((self.rows, self.columns), (other.rows, other.columns));
        Self::new(self.rows, self.columns, |row, column| self.at(row, column) + other.at(row, column))
    }

    pub(crate) fn minus(&self, other: &Self) -> Self {
        self.plus(&other.scaled(-1.0))
    }

    pub(crate) fn times(&self, other: &Self) -> Self {
        if (self.rows, self.columns) == (1, 1) {
            return other.scaled(self.at(0, 0));
        }
        if (other.rows, other.columns) == (1, 1) {
            return self.scaled(other.at(0, 0));
        }
        assert_eq!(self.columns, other.rows);
        Self::new(self.rows, other.columns, |row, column| {
            (0..self.columns).map(|k| self.at(row, k) * other.at(k, column)).sum()
        })
    }

    pub(crate) fn transpose(&self) -> Self {
        Self::new(self.columns, self.rows, |row, column| self.at(column, row))
    }

    pub(crate) fn trace(&self) -> f64 {
        (0..self.rows).map(|i| self.at(i, i)).sum()
    }

    pub(crate) fn hat(&self) -> Self {
        let [x, y, z] = [self.at(0, 0), self.at(1, 0), self.at(2, 0)];
        Self { rows: 3, columns: 3, entries: vec![0.0, -z, y, z, 0.0, -x, -y, x, 0.0] }
    }

    pub(crate) fn vee(&self) -> Self {
        let half = |i, j| 0.5 * (self.at(i, j) - self.at(j, i));
        Self { rows: 3, columns: 1, entries: vec![half(2, 1), half(0, 2), half(1, 0)] }
    }

    pub(crate) fn diagonal(&self) -> Self {
        Self::new(self.rows, self.rows, |row, column| if row == column { self.at(row, 0) } else { 0.0 })
    }

    pub(crate) fn size(&self) -> f64 {
        self.entries.iter().fold(0.0, |size, entry| size + entry.abs())
    }

    /// Whether two values agree to a tolerance, relative to their size.
    pub(crate) fn agrees(&self, other: &Self, tolerance: f64) -> bool {
        self.minus(other).size() <= tolerance * (1.0 + self.size() + other.size())
    }
}

/// Values of symbols.
pub(crate) type Values = BTreeMap<SymbolId, Matrix>;

/// The value of an expression.
pub(crate) fn value(expression: &Expression, symbols: &Symbols, values: &Values) -> Matrix {
    let (rows, columns) = expression.shape();
    let of_term = |(monomial, coefficient): (&Monomial, Rational)| {
        let scalars = monomial.scalars.iter();
        let factors = scalars.map(|(atom, exponent)| atom_value(atom, symbols, values).powi(*exponent));
        let word = if monomial.word.is_empty() { Matrix::identity(rows) } else { product(&monomial.word, values) };
        word.scaled(coefficient.to_f64() * factors.product::<f64>())
    };
    expression.terms().map(of_term).fold(Matrix::new(rows, columns, |_, _| 0.0), |sum, term| sum.plus(&term))
}

fn atom_value(atom: &Atom, symbols: &Symbols, values: &Values) -> f64 {
    match atom {
        Atom::Symbol(id) => values[id].at(0, 0),
        Atom::Trace(word) => product(word, values).trace(),
        Atom::Function(function, inner) => function.apply(value(inner, symbols, values).at(0, 0)),
        Atom::Sum(inner) => value(inner, symbols, values).at(0, 0),
    }
}

fn product(word: &[Factor], values: &Values) -> Matrix {
    let factors = word.iter().map(|factor| factor_value(factor, values));
    factors.reduce(|product, factor| product.times(&factor)).expect("a factor")
}

fn factor_value(factor: &Factor, values: &Values) -> Matrix {
    let turned = |matrix: Matrix, transposed: bool| if transposed { matrix.transpose() } else { matrix };
    match factor {
        Factor::Symbol { id, transposed } => turned(values[id].clone(), *transposed),
        Factor::Inverse { .. } => {
            unreachable!("only off the orthogonal groups, where tests/long/random_lagrangians looks")
        }
        Factor::Unit { index, size, transposed } => turned(Matrix::unit(*index, *size), *transposed),
        Factor::Hat(word) => product(word, values).hat(),
        Factor::Diagonal(word) => product(word, values).diagonal(),
        Factor::Vee { word, transposed } => turned(product(word, values).vee(), *transposed),
    }
}
