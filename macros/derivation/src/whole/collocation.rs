//! The canonical equations of a declaration in attitude and conjugate momentum, as programs for a collocation.
//!
//! The Hamiltonian `h(μ, w)` of the continuous limit is a function on the cotangent bundle of all invertible matrices, with
//! `μ_k = tr(pᵀ g E_k)` and `w = g⁻¹·a_0`. Its equations are
//!
//! ```text
//! ġ = g ξ̂        ṗ = −p ξ̂ᵀ + ∂l/∂g        ξ = ∂h/∂μ
//! ```
//!
//! with the derivative of `l(ξ, g⁻¹·a_0)` by the entries of `g` at a constant `ξ`, operation by operation. Stages of a
//! collocation aren't in the group, so that `g⁻¹` is the inverse of any matrix here.

use super::actions::at_attitude;
use super::factor::MatrixFactor;
use super::matrix::Matrix;
use super::tangent::{Dual, along};
use super::values::{Value, Words};
use super::writer::Writer;
use super::{MOST_OPERATIONS, StepRefusal};
use crate::mathematics::chart::Chart;
use crate::staged::{Array, Program, Source, StagedDeclaration};

/// The programs of the canonical equations, or code for them. The conjugate momentum stands in the array of histories.
#[derive(Clone, Debug, PartialEq)]
pub struct Canonical<P = Program> {
    /// The conjugate momentum of an attitude in the group and a momentum, of least norm.
    pub lifted: P,
    /// The momentum of any matrices, of attitude and conjugate momentum.
    pub momentum: P,
    /// The advected parameters seen through any invertible matrices, of attitude and parameters.
    pub seen: P,
    /// The rates of attitude and conjugate momentum, of both, velocity and parameters.
    pub rates: P,
}

impl Canonical {
    /// Writes the canonical equations of a declaration.
    ///
    /// # Errors
    ///
    /// [`StepRefusal::NotQuadratic`] if collocation leaves the group; the errors of [`WholeStep::of`](super::WholeStep::of).
    pub fn of(staged: &StagedDeclaration) -> Result<Self, StepRefusal> {
        let writer = Writer::of(staged)?;
        if writer.factors.iter().any(|factor| factor.chart != Chart::Cayley) {
            return Err(StepRefusal::NotQuadratic);
        }
        let seen = writer.seen_through();
        let programs = Self {
            lifted: writer.lifted(),
            momentum: writer.paired(),
            rates: writer.rates(&seen),
            seen: writer.inverted(&seen),
        };
        let operations = [&programs.momentum, &programs.seen, &programs.rates].map(|program| program.operations.len());
        let is_long = operations.iter().sum::<usize>() > MOST_OPERATIONS;
        if is_long { Err(StepRefusal::TooLong { most: MOST_OPERATIONS }) } else { Ok(programs) }
    }

    /// The programs of the lift, of the momentum, of the advected parameters and of the rates.
    #[must_use]
    pub fn all(&self) -> [&Program; 4] {
        [&self.lifted, &self.momentum, &self.seen, &self.rates]
    }
}

impl Writer<'_> {
    /// The matrices of all factors in an array.
    fn matrices(&self, array: Array) -> Vec<Matrix> {
        self.factors.iter().map(|factor| factor.read_all(array)).collect()
    }

    /// `p = g⁻ᵀ D`, where `D` pairs with `E_k` to `μ_k`.
    fn lifted(&self) -> Program {
        let (mut words, momentum, mut all) =
            (Words::default(), Value::inputs(Array::Momentum, self.dimension()), Vec::new());
        for factor in &self.factors {
            let inverse = factor.inverse(&mut words, &factor.read(Array::Attitude));
            let dual = factor.dual_hat(&mut words, factor.own(&momentum));
            all.extend(inverse.transpose().times(&mut words, &dual).entries);
        }
        words.program(&all)
    }

    /// `μ_k = tr(pᵀ g E_k)`.
    fn paired(&self) -> Program {
        let (mut words, mut all) = (Words::default(), Vec::new());
        let both = self.matrices(Array::Attitude).into_iter().zip(self.matrices(Array::History));
        for (factor, (g, p)) in self.factors.iter().zip(both) {
            let paired = g.transpose().times(&mut words, &p);
            all.extend(factor.pairings(&mut words, &paired));
        }
        words.program(&all)
    }

    /// The advected parameters of attitude, its inverse in the array of inverses, and parameters.
    fn seen_through(&self) -> Program {
        let (mut words, g, mut all) = (Words::default(), self.matrices(Array::Attitude), Vec::new());
        let inverses = self.matrices(Array::Inverse);
        for (at, one) in self.staged.carried.iter().enumerate() {
            let inverse = &|_: &mut Words, factor: usize| inverses[factor].clone();
            all.extend(at_attitude(&mut words, one.action, &self.in_space(at), &g, inverse).entries);
        }
        words.program(&all)
    }

    /// The same program with the inverse written out.
    fn inverted(&self, seen: &Program) -> Program {
        let mut words = Words::default();
        let inverse = self.inverses(&mut words);
        let outputs = words.append(seen, |source| match source.array {
            Array::Inverse => inverse[source.at],
            _ => Value::Input(source),
        });
        words.program(&outputs)
    }

    /// The entries of the inverse matrices of all factors.
    fn inverses(&self, words: &mut Words) -> Vec<Value> {
        let inverse = |factor: &MatrixFactor| factor.read(Array::Attitude).inverse(words).entries;
        self.factors.iter().flat_map(inverse).collect()
    }

    /// The limit `l` of a velocity, attitude, its inverse and parameters.
    fn limit_seen(&self, seen: &Program) -> Program {
        let (mut words, stages, n) = (Words::default(), &self.staged.programs, self.dimension());
        let advected = words.append(seen, Value::Input);
        let read = |source: Source| match source.array {
            Array::Advected => advected[source.at],
            _ => Value::Input(source),
        };
        if let Some([l, ..]) = &stages.at_velocity {
            let l = words.append(l, read);
            return words.program(&l);
        }
        let at_rest = words.append(&stages.at_rest, read);
        let (inertia, rest) = at_rest.split_at(n * n);
        let velocity = Value::inputs(Array::Velocity, n);
        let image: Vec<Value> = inertia.chunks(n).map(|row| words.dot(row, &velocity)).collect();
        let (square, linear) = (words.dot(&velocity, &image), words.dot(&rest[..n], &velocity));
        let kinetic = words.multiply(square, Value::of(0.5));
        let sum = words.add(kinetic, linear);
        let l = words.subtract(sum, rest[n]);
        words.program(&[l])
    }

    fn rates(&self, seen: &Program) -> Program {
        let l = self.limit_seen(seen);
        let mut words = Words::default();
        let is_read = l.inputs.iter().any(|source| source.array == Array::Inverse);
        let inverse = if is_read { self.inverses(&mut words) } else { Vec::new() };
        let velocity = Value::inputs(Array::Velocity, self.dimension());
        let (mut attitude, mut momentum) = (Vec::new(), Vec::new());
        for factor in &self.factors {
            let (size, first) = (factor.size(), factor.entry);
            let hat = factor.hat(&mut words, factor.own(&velocity));
            attitude.extend(factor.read(Array::Attitude).times(&mut words, &hat).entries);
            let turned = factor.read_all(Array::History).times(&mut words, &hat.transpose());
            for at in 0..size * size {
                let (row, column) = (at / size, at % size);
                // `∂(g⁻¹)/∂g_ij = −g⁻¹ e_ij g⁻¹`
                let change_of_inverse = |words: &mut Words, at: usize| {
                    let own = (first..first + size * size).contains(&at).then(|| at - first);
                    own.map_or(Value::ZERO, |at| {
                        let entry = |i: usize, j: usize| inverse[first + i * size + j];
                        let product = words.multiply(entry(at / size, row), entry(column, at % size));
                        words.negate(product)
                    })
                };
                let changes: Vec<Value> = (0..inverse.len()).map(|at| change_of_inverse(&mut words, at)).collect();
                let read = |source: Source| -> Dual {
                    match source.array {
                        Array::Attitude => (Value::Input(source), Value::one_if(source.at == first + at)),
                        Array::Inverse => (inverse[source.at], changes[source.at]),
                        _ => (Value::Input(source), Value::ZERO),
                    }
                };
                let force = along(&mut words, &l, &read)[0].1;
                momentum.push(words.subtract(force, turned.entries[at]));
            }
        }
        words.program(&[attitude, momentum].concat())
    }
}
