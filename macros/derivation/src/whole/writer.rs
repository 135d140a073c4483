//! The parts of a step that the Lagrangian decides, with the increments that they read.

use super::StepRefusal;
use super::factor::MatrixFactor;
use super::matrix::Matrix;
use super::solved::Pattern;
use super::values::{Value, Words};
use crate::staged::{Array, Carried, Program, Source, StagedDeclaration};

/// A declaration with the factors of its group.
pub(super) struct Writer<'a> {
    pub(super) staged: &'a StagedDeclaration,
    pub(super) factors: Vec<MatrixFactor>,
    pub(super) pattern: Pattern,
    /// The number of entries of an attitude.
    pub(super) entries: usize,
    /// The number of advected and given numbers.
    pub(super) carried: usize,
}

impl<'a> Writer<'a> {
    pub(super) fn of(staged: &'a StagedDeclaration) -> Result<Self, StepRefusal> {
        let (mut factors, mut entries, mut dimension) = (Vec::new(), 0, 0);
        for one in &staged.factors {
            let factor = MatrixFactor::of(&one.name, &one.generators, [entries, dimension])?;
            entries += factor.size() * factor.size();
            dimension += factor.dimension();
            factors.push(factor);
        }
        let begins = factors.iter().skip(1).map(|factor| factor.component).collect();
        let pattern = Pattern { dimension, factors: begins, apart: staged.blocks.clone() };
        let carried = staged.carried.iter().map(|w| w.shape.0 * w.shape.1).sum();
        Ok(Self { staged, factors, pattern, entries, carried })
    }

    /// The number of components.
    pub(super) fn dimension(&self) -> usize {
        self.pattern.dimension
    }

    /// The advected parameters in an array, each as a matrix.
    pub(super) fn advected(&self, array: Array) -> Vec<Matrix> {
        let mut all = Value::inputs(array, self.carried).into_iter();
        let shapes = self.staged.carried.iter().map(|w| w.shape);
        shapes
            .map(|(rows, columns)| Matrix { rows, columns, entries: all.by_ref().take(rows * columns).collect() })
            .collect()
    }

    /// The value in space of the advected parameter with this number.
    pub(super) fn in_space(&self, at: usize) -> Matrix {
        let Carried { field, shape: (rows, columns), .. } = self.staged.carried[at];
        let Some(field) = field else { return Matrix::identity(rows) };
        let first: usize = self.staged.parameters[..field].iter().map(|p| p.kind.len()).sum();
        Matrix::of(rows, columns, |i, j| Value::Input(Source::new(Array::Parameters, first + i * columns + j)))
    }

    /// `F − I` of all factors.
    pub(super) fn increments(&self, words: &mut Words, half: &[Value]) -> Vec<Matrix> {
        self.factors.iter().map(|factor| factor.increment(words, factor.own(half))).collect()
    }

    /// The outputs of a program that may read the increments `F − I`.
    pub(super) fn with_increments(
        &self,
        words: &mut Words,
        program: &Program,
        d: &[Matrix],
        other: &dyn Fn(Source) -> Value,
    ) -> Vec<Value> {
        let is_read = |array| program.inputs.iter().any(|source| source.array == array);
        let factors = || self.factors.iter().zip(d);
        let mut all = |array, make: fn(&MatrixFactor, &mut Words, &Matrix) -> Matrix| -> Vec<Value> {
            let made = factors().filter(|_| is_read(array));
            made.flat_map(|(factor, d)| make(factor, words, d).entries).collect()
        };
        let increments = all(Array::Increment, |_, _, d| d.clone());
        let changes = all(Array::InverseIncrement, MatrixFactor::inverse_increment);
        let inverses = all(Array::Inverse, MatrixFactor::inverse_of_increment);
        words.append(program, |source| match source.array {
            Array::Increment => increments[source.at],
            Array::InverseIncrement => changes[source.at],
            Array::Inverse => inverses[source.at],
            _ => other(source),
        })
    }

    fn with_increments_of(
        &self,
        words: &mut Words,
        program: &Program,
        half: &[Value],
        other: &dyn Fn(Source) -> Value,
    ) -> Vec<Value> {
        let is_one = |array| matches!(array, Array::Increment | Array::InverseIncrement | Array::Inverse);
        let is_read = program.inputs.iter().any(|source| is_one(source.array));
        let d = if is_read { self.increments(words, half) } else { Vec::new() };
        self.with_increments(words, program, &d, other)
    }

    /// The residual of the momentum equation, with the constraints.
    pub(super) fn residual(&self, words: &mut Words, half: &[Value]) -> Vec<Value> {
        let free = self.free_residual(words, half);
        self.with_constraints(words, half, (free, None), &Value::Input).0
    }

    /// The residual of the momentum equation without reactions.
    pub(super) fn free_residual(&self, words: &mut Words, half: &[Value]) -> Vec<Value> {
        let program = &self.staged.programs.newton_residual;
        let mut residual = self.with_increments_of(words, program, half, &Value::Input);
        residual.truncate(self.dimension());
        residual
    }

    /// The residual, and the Jacobian by half the coordinates, with the constraints.
    pub(super) fn system(
        &self,
        words: &mut Words,
        half: &[Value],
        other: &dyn Fn(Source) -> Value,
    ) -> (Vec<Value>, Matrix) {
        let (residual, jacobian) = self.free_system(words, half, other);
        let (residual, constrained) = self.with_constraints(words, half, (residual, Some(jacobian.clone())), other);
        (residual, constrained.unwrap_or(jacobian))
    }

    /// The system of the momentum equation without reactions.
    fn free_system(&self, words: &mut Words, half: &[Value], other: &dyn Fn(Source) -> Value) -> (Vec<Value>, Matrix) {
        let n = self.dimension();
        let mut residual = self.with_increments_of(words, &self.staged.programs.newton_system, half, other);
        let jacobian = Matrix { rows: n, columns: n, entries: residual.split_off(n) };
        if !self.staged.in_increment {
            return (residual, jacobian);
        }
        // The Jacobian is that along `exp(t E_j) F`; the tangent is one block for each factor.
        let mut columns = Vec::new();
        for factor in &self.factors {
            for column in factor.tangent(words, factor.own(half)) {
                columns.push((factor.component, column));
            }
        }
        let product = Matrix::of(n, n, |i, j| {
            let (first, column) = &columns[j];
            words.dot(&jacobian.row(i)[*first..], column)
        });
        (residual, product)
    }
}
