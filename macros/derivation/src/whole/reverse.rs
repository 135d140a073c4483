//! Derivatives in reverse: from those of a scalar by what a program writes, those by what it reads.
//!
//! A whole step maps attitude, momentum and what is advected, `(g, μ, w)`, by its constants `c`. If a scalar has the derivatives
//! `(z, p, q)` after the step, by a displacement `g ← g exp ζ̂`, by the momentum and by what is advected, then with the
//! residual `r(y, a, w, c)` of the momentum equation (2.7) in half the coordinates `y` of the increment, and the covector
//! `ȳ` that the end of the step has for them,
//!
//! ```text
//! (∂r/∂y)ᵀ λ = −ȳ
//! ā ← ā + (∂r/∂a)ᵀ λ        w̄ ← w̄ + (∂r/∂w)ᵀ λ        c̄ ← c̄ + (∂r/∂c)ᵀ λ
//! ```
//!
//! One solve gives the derivatives by all constants at once. Nothing is derived anew: the programs of the step are read from
//! their last operation to the first.

use super::matrix::Matrix;
use super::tangent::slope;
use super::values::{Value, Words};
use super::writer::Writer;
use crate::staged::{Array, Operation, Program, Source};

/// The derivatives of a scalar by the inputs of a program.
struct Reversed {
    by_inputs: Vec<(Source, Value)>,
}

impl Reversed {
    /// Derivatives by the first `count` numbers of an array.
    fn by(&self, array: Array, count: usize) -> Vec<Value> {
        let mut all = vec![Value::ZERO; count];
        for (source, slope) in self.by_inputs.iter().filter(|(source, _)| source.array == array) {
            all[source.at] = *slope;
        }
        all
    }

    /// Adds derivatives by an array to those there are.
    fn add(&self, words: &mut Words, array: Array, sum: &mut [Value]) {
        for (source, slope) in self.by_inputs.iter().filter(|(source, _)| source.array == array) {
            sum[source.at] = words.add(sum[source.at], *slope);
        }
    }
}

/// Adds the operations of a program, and those of its derivative, of these derivatives by its outputs.
fn reversed(
    words: &mut Words,
    program: &Program,
    input: &dyn Fn(Source) -> Value,
    seeds: impl FnOnce(&mut Words, &[Value]) -> Vec<Value>,
) -> Reversed {
    let literals = program.literals.iter().map(|&literal| Value::of(literal));
    let mut values: Vec<Value> = program.inputs.iter().map(|&source| input(source)).chain(literals).collect();
    let first = values.len();
    for &operation in &program.operations {
        let [a, b] = operation.operands().map(|at| values[at]);
        values.push(words.operation(operation, [a, b]));
    }
    let outputs: Vec<Value> = program.outputs.iter().map(|&at| values[at as usize]).collect();
    let mut slopes = vec![Value::ZERO; values.len()];
    for (&at, seed) in program.outputs.iter().zip(seeds(words, &outputs)) {
        slopes[at as usize] = words.add(slopes[at as usize], seed);
    }
    for (at, &operation) in program.operations.iter().enumerate().rev() {
        let weight = slopes[first + at];
        if weight == Value::ZERO {
            continue;
        }
        let operands = operation.operands();
        let ([x, y], result) = (operands.map(|at| values[at]), values[first + at]);
        let [by_x, by_y] = match operation {
            Operation::Negate(_) => [words.negate(weight), Value::ZERO],
            Operation::Add(..) => [weight; 2],
            Operation::Subtract(..) => [weight, words.negate(weight)],
            Operation::Multiply(..) => [words.multiply(weight, y), words.multiply(weight, x)],
            Operation::Divide(..) => {
                let by_x = words.divide(weight, y);
                let product = words.multiply(by_x, result);
                [by_x, words.negate(product)]
            }
            Operation::Apply(function, _) => {
                let own = slope(words, function, x, result);
                [words.multiply(weight, own), Value::ZERO]
            }
        };
        for (operand, by) in operands.into_iter().zip([by_x, by_y]) {
            slopes[operand] = words.add(slopes[operand], by);
        }
    }
    Reversed { by_inputs: program.inputs.iter().copied().zip(slopes).collect() }
}

/// The program of the derivatives of a scalar by arrays of a program's inputs, each of so many numbers, one array after the
/// other. Its inputs are those of the program, and in the array of factors the derivatives by the outputs.
#[must_use]
pub fn pulled_back(program: &Program, by: &[(Array, usize)]) -> Program {
    let mut words = Words::default();
    let seeds = Value::inputs(Array::Factors, program.outputs.len());
    let found = reversed(&mut words, program, &Value::Input, |_, _| seeds);
    let all: Vec<Value> = by.iter().flat_map(|&(array, count)| found.by(array, count)).collect();
    words.program(&all)
}

impl Writer<'_> {
    /// The derivatives of a scalar before a step, by displacement, momentum, what is advected and constants, of half, momentum,
    /// advected and constants; those after it stand in the arrays of velocities, histories and next advected values.
    pub(super) fn backwards(&self, target: &Program, finish: &Program) -> Program {
        let (mut words, n) = (Words::default(), self.dimension());
        let half = Value::inputs(Array::Half, n);
        let goal = words.append(target, Value::Input);
        let identity: Vec<Value> =
            self.factors.iter().flat_map(|factor| Matrix::identity(factor.size()).entries).collect();
        let read = |source: Source| match source.array {
            Array::Target => goal[source.at],
            Array::Attitude => identity[source.at],
            Array::History => Value::ZERO,
            _ => Value::Input(source),
        };
        let end = reversed(&mut words, finish, &read, |words, outputs| {
            let mut seeds = self.of_displacements(words, outputs);
            seeds.extend(Value::inputs(Array::History, n));
            seeds.extend(Value::inputs(Array::Next, self.carried));
            seeds
        });
        let mut turn = Vec::new();
        let by_attitude = end.by(Array::Attitude, self.entries);
        for factor in &self.factors {
            let size = factor.size();
            let entries = by_attitude[factor.entry..factor.entry + size * size].to_vec();
            turn.extend(factor.pairings(&mut words, &Matrix { rows: size, columns: size, entries }));
        }
        let constants = self.staged.programs.constants.outputs.len();
        let mut by_target = end.by(Array::Target, n);
        let mut by_momentum = end.by(Array::Momentum, n);
        let mut by_advected = end.by(Array::Advected, self.carried);
        let mut by_constants = end.by(Array::Constants, constants);
        let mut own = Words::default();
        let residual = self.residual(&mut own, &half);
        let residual = own.program(&residual);
        let multipliers = self.multipliers(&mut words, &read, &end.by(Array::Half, n));
        let equation = reversed(&mut words, &residual, &read, |_, _| multipliers);
        equation.add(&mut words, Array::Target, &mut by_target);
        equation.add(&mut words, Array::Advected, &mut by_advected);
        equation.add(&mut words, Array::Constants, &mut by_constants);
        by_target.push(Value::ZERO);
        let begin = reversed(&mut words, target, &Value::Input, |_, _| by_target);
        begin.add(&mut words, Array::Momentum, &mut by_momentum);
        begin.add(&mut words, Array::Advected, &mut by_advected);
        begin.add(&mut words, Array::Constants, &mut by_constants);
        words.program(&[turn, by_momentum, by_advected, by_constants].concat())
    }

    /// Derivatives by the entries of the increments from those by displacements after the step: `ζ⁺ = vee(F⁻¹ δF)`.
    fn of_displacements(&self, words: &mut Words, outputs: &[Value]) -> Vec<Value> {
        let by_displacement = Value::inputs(Array::Velocity, self.dimension());
        let mut all = Vec::new();
        for factor in &self.factors {
            let size = factor.size();
            let of = |array: Array| Matrix { rows: size, columns: size, entries: Value::inputs(array, size * size) };
            let mut own = Words::default();
            let turn = of(Array::Inverse).times(&mut own, &of(Array::Element));
            let components = factor.vee(&mut own, &turn);
            let program = own.program(&components);
            let entries = outputs[factor.entry..factor.entry + size * size].to_vec();
            let inverse = factor.inverse(words, &Matrix { rows: size, columns: size, entries });
            let read = |source: Source| match source.array {
                Array::Inverse => inverse.entries[source.at],
                // The map is linear in these.
                _ => Value::ZERO,
            };
            let seeds = factor.own(&by_displacement).to_vec();
            all.extend(reversed(words, &program, &read, |_, _| seeds).by(Array::Element, size * size));
        }
        all
    }

    /// The multipliers `λ` of the momentum equation, `(∂r/∂y)ᵀ λ = −ȳ`.
    fn multipliers(&self, words: &mut Words, read: &dyn Fn(Source) -> Value, by_half: &[Value]) -> Vec<Value> {
        let half = Value::inputs(Array::Half, self.dimension());
        let (_, jacobian) = self.system(words, &half, read);
        let factorisation = self.pattern.factorise(words, &jacobian.transpose());
        let right: Vec<Value> = by_half.iter().map(|&slope| words.negate(slope)).collect();
        self.pattern.solve(words, &factorisation.factors, factorisation.determinants[0][0], &right)
    }
}
