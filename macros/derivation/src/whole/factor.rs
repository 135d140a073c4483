//! A factor of the group by its generators alone: increments, tangents, inverses and the coadjoint action as values.
//!
//! The order of operations is that of the library's groups.

use super::StepRefusal;
use super::basis::{Basis, Form};
use super::matrix::Matrix;
use super::relations::{Relations, restored};
use super::rigid::{self, rotation, tangent_of_rotation};
use super::values::{Value, Words};
use crate::mathematics::chart::{Chart, cube, times};
use crate::staged::{Array, Source};

/// A factor of the group, and its place among all.
#[derive(Clone, Debug)]
pub struct MatrixFactor {
    /// Name of the factor.
    pub name: String,
    /// The generators.
    pub basis: Basis,
    /// The form of the group, by which inverses are written.
    pub form: Form,
    /// The coordinates of increments.
    pub chart: Chart,
    /// The number of rows of the rotations in a group of [all rigid motions](Basis::rigid_motions).
    motions: Option<usize>,
    relations: Relations,
    /// The place of its first entry in an attitude.
    pub entry: usize,
    /// The place of its first component in a velocity or a momentum.
    pub component: usize,
}

impl MatrixFactor {
    pub(super) fn of(name: &str, generators: &[Vec<f64>], [entry, component]: [usize; 2]) -> Result<Self, StepRefusal> {
        let basis = Basis::of(generators)?;
        let (form, chart, motions) = (basis.form(), basis.chart()?, basis.rigid_motions());
        let relations = Relations::of(&basis);
        Ok(Self { name: name.to_owned(), basis, form, chart, motions, relations, entry, component })
    }

    /// The number of rows of its matrices.
    #[must_use]
    pub fn size(&self) -> usize {
        self.basis.size
    }

    /// The number of components.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.basis.dimension()
    }

    /// Whether rounding's distance from the group is taken back, by [`Programs::restored`](super::Programs::restored). Groups
    /// that aren't orthogonal have elements of any size, whose roundings are no measure of a distance.
    #[must_use]
    pub const fn is_restored(&self) -> bool {
        matches!(self.form, Form::Rotation | Form::Orthogonal)
    }

    /// The distance of a matrix from the group; none of its entries is known.
    pub(super) fn defect(&self, words: &mut Words, g: &Matrix) -> Value {
        self.relations.defect(words, self.form, g)
    }

    /// The distance of a matrix from the group and a nearer matrix, where that is restored.
    pub(super) fn restored(&self, words: &mut Words, g: &Matrix) -> Option<Vec<Value>> {
        self.is_restored().then(|| restored(words, g))
    }

    /// The factor's part of the components of all factors.
    pub(super) fn own<'a>(&self, all: &'a [Value]) -> &'a [Value] {
        &all[self.component..self.component + self.dimension()]
    }

    /// The matrix `Σ x_k E_k` of the Lie algebra with these components.
    pub(super) fn hat(&self, words: &mut Words, x: &[Value]) -> Matrix {
        let n = self.size();
        let mut matrix = Matrix::of(n, n, |_, _| Value::ZERO);
        for (e, &x) in self.basis.generators.iter().zip(x) {
            for (at, &entry) in e.iter().enumerate().filter(|(_, entry)| **entry != 0.0) {
                let product = words.multiply(x, Value::of(entry));
                matrix.entries[at] = words.add(matrix.entries[at], product);
            }
        }
        matrix
    }

    /// The components of an element of the algebra.
    pub(super) fn vee(&self, words: &mut Words, matrix: &Matrix) -> Vec<Value> {
        if self.basis.is_orthogonal {
            let pairings = self.pairings(words, matrix);
            return self.by_lengths(words, &pairings);
        }
        let mut components = vec![Value::ZERO; self.dimension()];
        for &(k, place, factor) in &self.basis.dual {
            let product = words.multiply(matrix.entries[place], Value::of(factor));
            components[k] = words.add(components[k], product);
        }
        components
    }

    fn by_lengths(&self, words: &mut Words, x: &[Value]) -> Vec<Value> {
        x.iter().zip(&self.basis.lengths).map(|(&x, length)| words.multiply(x, Value::of(1.0 / length))).collect()
    }

    /// `tr(E_kᵀ M)`.
    pub(super) fn pairings(&self, words: &mut Words, matrix: &Matrix) -> Vec<Value> {
        let mut paired = |e: &Vec<f64>| {
            let entries = e.iter().zip(&matrix.entries).filter(|(entry, _)| **entry != 0.0);
            entries.fold(Value::ZERO, |sum, (&entry, &value)| {
                let product = words.multiply(value, Value::of(entry));
                words.add(sum, product)
            })
        };
        self.basis.generators.iter().map(&mut paired).collect()
    }

    /// A covector as a matrix, whose pairing with `E_k` is `μ_k`.
    pub(super) fn dual_hat(&self, words: &mut Words, mu: &[Value]) -> Matrix {
        if self.basis.is_orthogonal {
            let scaled = self.by_lengths(words, mu);
            return self.hat(words, &scaled);
        }
        let mut matrix = Matrix::of(self.size(), self.size(), |_, _| Value::ZERO);
        for &(k, place, factor) in &self.basis.dual {
            let product = words.multiply(mu[k], Value::of(factor));
            matrix.entries[place] = words.add(matrix.entries[place], product);
        }
        matrix
    }

    /// `D = F − I` of half the coordinates.
    pub(super) fn increment(&self, words: &mut Words, half: &[Value]) -> Matrix {
        if self.form == Form::Rotation {
            return rotation(words, half);
        }
        if let Some(rows) = self.motions {
            return rigid::increment(words, [rows, self.size()], half);
        }
        if self.chart == Chart::Product {
            return self.product(words, half).1;
        }
        let doubled = words.added(half, half);
        let hat = self.hat(words, &doubled);
        if self.form == Form::Translation {
            return hat;
        }
        let inverse = self.halves(words, &hat).0.inverse(words);
        inverse.times(words, &hat)
    }

    /// `I − ξ̂/2` and `I + ξ̂/2`.
    fn halves(&self, words: &mut Words, hat: &Matrix) -> (Matrix, Matrix) {
        let (half, one) = (hat.scaled(words, Value::of(0.5)), Matrix::identity(self.size()));
        (one.minus(words, &half), one.plus(words, &half))
    }

    /// The right-trivialised tangent, column by column, and `F − I`, of the product of Cayley maps.
    ///
    /// Where `E³ = c E`, `cay(2y E) = I + (2y E + 2y² E²)/(1 − c y²)`, and its logarithmic derivative by `y` is
    /// `2E/(1 − c y²)`.
    fn product(&self, words: &mut Words, half: &[Value]) -> (Vec<Vec<Value>>, Matrix) {
        let n = self.size();
        let one = Matrix::identity(n);
        let (mut increment, mut inverse) = (Matrix::of(n, n, |_, _| Value::ZERO), one.clone());
        let mut columns = Vec::new();
        for (e, &y) in self.basis.generators.iter().zip(half) {
            let before = increment.plus(words, &one);
            let c = cube(e).unwrap_or(0.0);
            let squared = words.multiply(y, y);
            let fraction = words.multiply(Value::of(c), squared);
            let below = words.subtract(Value::ONE, fraction);
            let two = words.divide(Value::of(2.0), below);
            let moved = before.times(words, &Matrix::known(n, e)).times(words, &inverse).scaled(words, two);
            columns.push(self.vee(words, &moved));
            let (first, second) = (words.multiply(two, y), words.multiply(two, squared));
            let linear = Matrix::known(n, e).scaled(words, first);
            let square = Matrix::known(n, &times(e, e)).scaled(words, second);
            let [plus, minus] = [square.plus(words, &linear), square.minus(words, &linear)];
            let change = before.times(words, &plus);
            increment = increment.plus(words, &change);
            inverse = one.plus(words, &minus).times(words, &inverse);
        }
        (columns, increment)
    }

    /// The tangent by half the coordinates, column by column.
    pub(super) fn tangent(&self, words: &mut Words, half: &[Value]) -> Vec<Vec<Value>> {
        if self.chart == Chart::Product {
            return self.product(words, half).0;
        }
        if self.form == Form::Rotation {
            return tangent_of_rotation(words, half);
        }
        if let Some(rows) = self.motions {
            return rigid::tangent(words, rows, half);
        }
        let (n, count, two) = (self.size(), self.dimension(), Value::of(2.0));
        if self.form == Form::Translation {
            return (0..count).map(|k| (0..count).map(|i| if i == k { two } else { Value::ZERO }).collect()).collect();
        }
        let doubled = words.added(half, half);
        let hat = self.hat(words, &doubled);
        let (minus, plus) = self.halves(words, &hat);
        let (minus, plus) = (minus.inverse(words), plus.inverse(words));
        let mut column = |e: &Vec<f64>| {
            let moved = minus.times(words, &Matrix::known(n, e)).times(words, &plus);
            let components = self.vee(words, &moved);
            components.into_iter().map(|x| words.multiply(x, two)).collect()
        };
        self.basis.generators.iter().map(&mut column).collect()
    }

    /// `F⁻¹`.
    pub(super) fn inverse(&self, words: &mut Words, m: &Matrix) -> Matrix {
        let n = self.size();
        match self.form {
            Form::Rotation | Form::Orthogonal => m.transpose(),
            Form::Rigid(k) => Matrix::of(n, n, |i, j| match (i < k, j < k) {
                (true, true) => m.at(j, i),
                (true, false) => {
                    let sum = words.dot(&m.column(i)[..k], &m.column(j)[..k]);
                    words.negate(sum)
                }
                _ => Value::one_if(i == j),
            }),
            Form::Translation => {
                let one = Matrix::identity(n);
                let beside = m.minus(words, &one);
                one.minus(words, &beside)
            }
            Form::Unimodular => {
                let entries = vec![m.at(1, 1), words.negate(m.at(0, 1)), words.negate(m.at(1, 0)), m.at(0, 0)];
                Matrix { entries, ..*m }
            }
            Form::General => m.inverse(words),
        }
    }

    /// `F` of `F − I`.
    pub(super) fn element(&self, words: &mut Words, d: &Matrix) -> Matrix {
        let one = Matrix::identity(self.size());
        self.constant_rows(d.plus(words, &one))
    }

    /// The matrix with the entries that all elements share.
    fn constant_rows(&self, mut m: Matrix) -> Matrix {
        for at in (0..m.entries.len()).filter(|&at| self.is_constant(at)) {
            m.entries[at] = Value::one_if(at / m.rows == at % m.rows);
        }
        m
    }

    /// Whether an entry is that of the identity in all elements, by the form of the group.
    fn is_constant(&self, at: usize) -> bool {
        match self.form {
            Form::Rigid(k) => at / self.size() >= k,
            Form::Translation => self.basis.generators.iter().all(|e| e[at] == 0.0),
            _ => false,
        }
    }

    /// `F⁻¹ − I`.
    pub(super) fn inverse_increment(&self, words: &mut Words, d: &Matrix) -> Matrix {
        if let Some(rows) = self.motions {
            return rigid::inverse_increment(words, rows, d);
        }
        match self.form {
            Form::Rotation => d.transpose(),
            Form::Translation => d.negated(words),
            _ => {
                let inverse = self.inverse_of_increment(words, d);
                inverse.times(words, d).negated(words)
            }
        }
    }

    /// `F⁻¹` of `F − I`.
    pub(super) fn inverse_of_increment(&self, words: &mut Words, d: &Matrix) -> Matrix {
        let element = self.element(words, d);
        self.inverse(words, &element)
    }

    /// `Ad*_F μ − μ`.
    pub(super) fn coadjoint_change(&self, words: &mut Words, d: &Matrix, mu: &[Value]) -> Vec<Value> {
        if let Some(rows) = self.motions {
            return rigid::coadjoint_change(words, rows, d, mu);
        }
        match self.form {
            Form::Rotation => (0..3).map(|i| words.dot(&d.column(i), mu)).collect(),
            Form::Translation => vec![Value::ZERO; mu.len()],
            _ => {
                let inverse = self.inverse_increment(words, d);
                let covector = self.dual_hat(words, mu);
                let moved = d.transpose().times(words, &covector);
                let other = covector.plus(words, &moved).times(words, &inverse.transpose());
                let change = moved.plus(words, &other);
                self.pairings(words, &change)
            }
        }
    }

    /// `Ad*_{g⁻¹} μ`, the momentum in space.
    pub(super) fn in_space(&self, words: &mut Words, g: &Matrix, mu: &[Value]) -> Vec<Value> {
        let inverse = self.inverse(words, g);
        if self.form == Form::Rotation {
            return (0..3).map(|i| words.dot(&inverse.column(i), mu)).collect();
        }
        let covector = self.dual_hat(words, mu);
        let moved = inverse.transpose().times(words, &covector).times(words, &g.transpose());
        self.pairings(words, &moved)
    }

    /// `g F = g + g D`.
    pub(super) fn advanced(&self, words: &mut Words, g: &Matrix, d: &Matrix) -> Matrix {
        let change = self.change(words, g, d);
        g.plus(words, &change)
    }

    /// `g F − g = g D`.
    pub(super) fn change(&self, words: &mut Words, g: &Matrix, d: &Matrix) -> Matrix {
        if self.form == Form::Translation { d.clone() } else { g.times(words, d) }
    }

    /// A number whose product with the square of `s` is below one if `s` times half the coordinates is near the identity;
    /// none for translations, which are near everywhere.
    pub(super) fn nearness(&self, words: &mut Words, half: &[Value]) -> Option<Value> {
        let (square, factor) = match self.form {
            Form::Translation => return None,
            Form::Rotation => (words.dot(half, half), 0.25),
            Form::Rigid(k) => {
                let hat = self.hat(words, half);
                let left: Vec<Value> = (0..k).flat_map(|j| hat.column(j)).collect();
                (words.dot(&left, &left), 0.5)
            }
            _ => {
                let hat = self.hat(words, half);
                (words.dot(&hat.entries, &hat.entries), 1.0)
            }
        };
        Some(words.multiply(square, Value::of(factor)))
    }

    /// The factor's matrix in an array with the entries of all factors; entries that all elements share are known.
    pub(super) fn read(&self, array: Array) -> Matrix {
        self.constant_rows(self.read_all(array))
    }

    /// The factor's matrix in an array with the entries of all factors, constant ones included.
    pub(super) fn read_all(&self, array: Array) -> Matrix {
        let n = self.size();
        Matrix::of(n, n, |i, j| Value::Input(Source::new(array, self.entry + i * n + j)))
    }
}
