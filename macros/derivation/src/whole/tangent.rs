//! The tangent map of a whole step as a program: derivatives operation by operation along one direction, and the implicit
//! function theorem for the increment.
//!
//! A direction is a displacement `ζ` of the attitude, `g ← g exp ζ̂`, with a change `δμ` of the momentum; advected
//! parameters change by `δw = −ζ·w`, or by any `δw` where parameters and constants change, too. With the residual `r(y, a, w)` of the momentum equation (2.7) in half the coordinates
//! `y` of the increment,
//!
//! ```text
//! δy = −(∂r/∂y)⁻¹ (∂r/∂a δa + ∂r/∂w δw + ∂r/∂c δc)      ζ⁺ = vee(F⁻¹ (ζ̂ F + δF))
//! ```
//!
//! Nothing is derived anew: the programs of the step are differentiated as they are written.

use super::actions::change;
use super::matrix::Matrix;
use super::values::{Value, Words};
use super::writer::Writer;
use crate::staged::{Array, Function, Operation, Program, Source};

/// A value, and its derivative along the direction.
pub(super) type Dual = (Value, Value);

impl Writer<'_> {
    /// The displacement and the change of the momentum after a step, of half, momentum and advected; a displacement before
    /// it stands in the array of velocities, and a change of the momentum in that of histories. If what is advected and the
    /// constants have changes of their own, these stand in the arrays of next advected values and of factors, and the change of
    /// what is advected follows.
    pub(super) fn tangent(&self, target: &Program, finish: &Program, has_own_changes: bool) -> Program {
        let (mut words, n) = (Words::default(), self.dimension());
        let [zeta, changed] = [Array::Velocity, Array::History].map(|array| Value::inputs(array, n));
        let hats: Vec<Matrix> = self.factors.iter().map(|factor| factor.hat(&mut words, factor.own(&zeta))).collect();
        let turned: Vec<Value> = hats.iter().flat_map(|hat| hat.entries.iter().copied()).collect();
        let identity = self.factors.iter().flat_map(|factor| Matrix::identity(factor.size()).entries);
        let attitude: Vec<Dual> = identity.zip(turned.iter().copied()).collect();
        let changes = Value::inputs(Array::Next, self.carried);
        let advected = if has_own_changes {
            Value::inputs(Array::Advected, self.carried).into_iter().zip(changes).collect()
        } else {
            self.moved(&mut words, &turned)
        };
        let read = |source: Source| match source.array {
            Array::Constants if has_own_changes => {
                (Value::Input(source), Value::Input(Source::new(Array::Factors, source.at)))
            }
            Array::Momentum => (Value::Input(source), changed[source.at]),
            Array::Advected => advected[source.at],
            Array::Attitude => attitude[source.at],
            Array::History => (Value::ZERO, Value::ZERO),
            _ => (Value::Input(source), Value::ZERO),
        };
        let target = along(&mut words, target, &read);
        let half = self.solved(&mut words, &|source| match source.array {
            Array::Target => target[source.at],
            _ => read(source),
        });
        let end = along(&mut words, finish, &|source| match source.array {
            Array::Target => target[source.at],
            Array::Half => half[source.at],
            _ => read(source),
        });
        let mut all = Vec::new();
        for factor in &self.factors {
            let (first, size) = (factor.entry, factor.size());
            let own = &end[first..first + size * size];
            let part =
                |of: fn(&Dual) -> Value| Matrix { rows: size, columns: size, entries: own.iter().map(of).collect() };
            let inverse = factor.inverse(&mut words, &part(|dual| dual.0));
            let turn = inverse.times(&mut words, &part(|dual| dual.1));
            all.extend(factor.vee(&mut words, &turn));
        }
        let rest = if has_own_changes { n + self.carried } else { n };
        all.extend(end[self.entries..self.entries + rest].iter().map(|dual| dual.1));
        words.program(&all)
    }

    /// Advected parameters with their derivatives `−ζ·w`, by the entries of `ζ̂`.
    pub(super) fn moved(&self, words: &mut Words, turned: &[Value]) -> Vec<Dual> {
        let mut own = Words::default();
        let increments: Vec<Matrix> = self.factors.iter().map(|factor| factor.read_all(Array::Increment)).collect();
        let mut changes = Vec::new();
        for (w, carried) in self.advected(Array::Advected).iter().zip(&self.staged.carried) {
            changes.extend(change(&mut own, &self.factors, carried.action, w, &increments).entries);
        }
        let changes = along(words, &own.program(&changes), &|source| match source.array {
            Array::Increment => (Value::ZERO, turned[source.at]),
            _ => (Value::Input(source), Value::ZERO),
        });
        Value::inputs(Array::Advected, self.carried)
            .into_iter()
            .zip(changes)
            .map(|(w, (_, slope))| (w, slope))
            .collect()
    }

    /// Half the coordinates of the increment with their derivatives, by those of target and advected.
    fn solved(&self, words: &mut Words, read: &dyn Fn(Source) -> Dual) -> Vec<Dual> {
        let half = Value::inputs(Array::Half, self.dimension());
        let mut own = Words::default();
        let residual = self.residual(&mut own, &half);
        let missed: Vec<Value> = along(words, &own.program(&residual), read).into_iter().map(|dual| dual.1).collect();
        let (_, jacobian) = self.system(words, &half, &|source| read(source).0);
        let factorisation = self.pattern.factorise(words, &jacobian);
        let change = self.pattern.solve(words, &factorisation.factors, factorisation.determinants[0][0], &missed);
        half.iter().zip(change).map(|(&half, change)| (half, words.negate(change))).collect()
    }
}

/// The outputs of a program with their derivatives.
pub(super) fn along(words: &mut Words, program: &Program, input: &dyn Fn(Source) -> Dual) -> Vec<Dual> {
    let literals = program.literals.iter().map(|&literal| (Value::of(literal), Value::ZERO));
    let mut values: Vec<Dual> = program.inputs.iter().map(|&source| input(source)).chain(literals).collect();
    for &operation in &program.operations {
        let [(x, dx), (y, dy)] = operation.operands().map(|at| values[at]);
        values.push(match operation {
            Operation::Negate(_) => (words.negate(x), words.negate(dx)),
            Operation::Add(..) => (words.add(x, y), words.add(dx, dy)),
            Operation::Subtract(..) => (words.subtract(x, y), words.subtract(dx, dy)),
            Operation::Multiply(..) => {
                let (first, second) = (words.multiply(dx, y), words.multiply(x, dy));
                (words.multiply(x, y), words.add(first, second))
            }
            Operation::Divide(..) => {
                let ratio = words.divide(x, y);
                let part = words.multiply(ratio, dy);
                let above = words.subtract(dx, part);
                (ratio, words.divide(above, y))
            }
            Operation::Apply(function, _) => {
                let value = words.apply(function, x);
                // The slope of a root at zero is infinite; times no change it isn't needed.
                let slope = if dx == Value::ZERO { Value::ZERO } else { slope(words, function, x, value) };
                (value, words.multiply(slope, dx))
            }
        });
    }
    program.outputs.iter().map(|&at| values[at as usize]).collect()
}

/// The derivative of a function at `x`, where it has this value.
pub(super) fn slope(words: &mut Words, function: Function, x: Value, value: Value) -> Value {
    let half = Value::of(0.5);
    match function {
        Function::Sqrt => words.divide(half, value),
        Function::Ln => words.divide(Value::ONE, x),
        Function::Exp => value,
        Function::Sin => words.apply(Function::Cos, x),
        Function::Cos => {
            let sine = words.apply(Function::Sin, x);
            words.negate(sine)
        }
        // `c_k′ = (k c_{k+2} − c_{k+1})/2`
        Function::Stumpff(k) => {
            let [first, second] = [k + 1, k + 2].map(|k| words.apply(Function::Stumpff(k), x));
            let times = words.multiply(Value::of(k.into()), second);
            let difference = words.subtract(times, first);
            words.multiply(half, difference)
        }
        Function::LogRatio(k) => words.apply(Function::LogRatio(k + 1), x),
    }
}
