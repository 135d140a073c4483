//! Programs made of others: with all numbers known, constants as literals and operations on them folded; or several in
//! one.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use liestep_derivation::{Array, Operation, Program, Source, Stages};

use crate::code::applied;

/// The programs of a step with these constants, those of the parameters and `h`, as literals: products with zero and
/// one, sums with zero and equal operations are removed, and divisions by a number are products. The bits may differ
/// from those of the general programs by rounding.
#[must_use]
pub fn specialised(programs: &Stages<Program>, constants: &[f64]) -> Stages<Program> {
    let Ok(folded) = programs.try_map(|program| Ok::<_, std::convert::Infallible>(fold(program, constants)));
    folded
}

/// The contents of a register.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) enum Value {
    /// A number, by its bits.
    Number(u64),
    /// An input of the new program.
    Input(Source),
    /// The result of an operation of the new program.
    Result(usize),
}

impl Value {
    pub(crate) fn of(number: f64) -> Self {
        // Zeros of both signs are equal.
        Self::Number((number + 0.0).to_bits())
    }

    fn number(self) -> Option<f64> {
        match self {
            Self::Number(bits) => Some(f64::from_bits(bits)),
            _ => None,
        }
    }
}

/// An operation of the new program.
type Made = Operation<Value>;

/// A program under construction.
#[derive(Default)]
pub(crate) struct Fold {
    operations: Vec<Made>,
    known: HashMap<Made, Value>,
}

impl Fold {
    fn push(&mut self, made: Made) -> Value {
        let operations = &mut self.operations;
        *self.known.entry(made).or_insert_with(|| {
            operations.push(made);
            Value::Result(operations.len() - 1)
        })
    }

    /// The value whose negative this is, if that is known.
    fn negated(&self, value: Value) -> Option<Value> {
        match value {
            Value::Number(bits) => Some(Value::of(-f64::from_bits(bits))),
            Value::Result(at) => match self.operations[at] {
                Made::Negate(a) => Some(a),
                _ => None,
            },
            Value::Input(_) => None,
        }
    }

    fn negate(&mut self, a: Value) -> Value {
        self.negated(a).unwrap_or_else(|| self.push(Made::Negate(a)))
    }

    pub(crate) fn add(&mut self, a: Value, b: Value) -> Value {
        match (a.number(), b.number()) {
            (Some(a), Some(b)) => Value::of(a + b),
            (Some(0.0), _) => b,
            (_, Some(0.0)) => a,
            _ => {
                if let (Value::Result(_), Some(b)) = (b, self.negated(b)) {
                    return self.subtract(a, b);
                }
                if let (Value::Result(_), Some(a)) = (a, self.negated(a)) {
                    return self.subtract(b, a);
                }
                self.push(Made::Add(a.min(b), a.max(b)))
            }
        }
    }

    pub(crate) fn subtract(&mut self, a: Value, b: Value) -> Value {
        match (a.number(), b.number()) {
            (Some(a), Some(b)) => Value::of(a - b),
            (Some(0.0), _) => self.negate(b),
            (_, Some(0.0)) => a,
            _ => match (b, self.negated(b)) {
                (Value::Result(_), Some(b)) => self.add(a, b),
                _ => self.push(Made::Subtract(a, b)),
            },
        }
    }

    pub(crate) fn multiply(&mut self, a: Value, b: Value) -> Value {
        let (a, b) = (a.min(b), a.max(b));
        match (a.number(), b.number()) {
            (Some(a), Some(b)) => Value::of(a * b),
            (Some(0.0), _) => a,
            (Some(1.0), _) => b,
            (Some(-1.0), _) => self.negate(b),
            (Some(number), _) => match b {
                // Numerical factors are collected.
                Value::Result(at) => match self.operations[at] {
                    Made::Multiply(inner, c) if inner.number().is_some() => {
                        let product = number * inner.number().unwrap_or(1.0);
                        self.multiply(Value::of(product), c)
                    }
                    Made::Negate(c) => self.multiply(Value::of(-number), c),
                    _ => self.push(Made::Multiply(a, b)),
                },
                _ => self.push(Made::Multiply(a, b)),
            },
            _ => self.push(Made::Multiply(a, b)),
        }
    }

    fn divide(&mut self, a: Value, b: Value) -> Value {
        match (a.number(), b.number()) {
            (Some(a), Some(b)) => Value::of(a / b),
            (Some(0.0), _) => a,
            (_, Some(b)) if (1.0 / b).is_normal() => self.multiply(a, Value::of(1.0 / b)),
            _ => self.push(Made::Divide(a, b)),
        }
    }
}

fn fold(program: &Program, constants: &[f64]) -> Program {
    let of_input = |source: Source| match constants.get(source.at) {
        Some(&number) if source.array == Array::Constants => Value::of(number),
        _ => Value::Input(source),
    };
    let mut fold = Fold::default();
    let outputs = fold.append(program, of_input, Fold::folded);
    fold.program(&outputs)
}

impl Fold {
    /// Adds a program with these inputs, each operation by `make`; returns its outputs.
    pub(crate) fn append(
        &mut self,
        program: &Program,
        input: impl Fn(Source) -> Value,
        make: fn(&mut Self, Operation, [Value; 2]) -> Value,
    ) -> Vec<Value> {
        let literals = program.literals.iter().map(|&literal| Value::of(literal));
        let mut values: Vec<Value> = program.inputs.iter().map(|&source| input(source)).chain(literals).collect();
        for &operation in &program.operations {
            let value = make(self, operation, operation.operands().map(|at| values[at]));
            values.push(value);
        }
        program.outputs.iter().map(|&at| values[at as usize]).collect()
    }

    fn folded(&mut self, operation: Operation, [a, b]: [Value; 2]) -> Value {
        match operation {
            Operation::Negate(_) => self.negate(a),
            Operation::Add(..) => self.add(a, b),
            Operation::Subtract(..) => self.subtract(a, b),
            Operation::Multiply(..) => self.multiply(a, b),
            Operation::Divide(..) => self.divide(a, b),
            Operation::Apply(function, _) => match a.number() {
                Some(a) => Value::of(applied(function, a)),
                None => self.push(Made::Apply(function, a)),
            },
        }
    }

    /// Adds the operation itself, to keep the bits of the program; but zeros are dropped.
    pub(crate) fn kept(&mut self, operation: Operation, [a, b]: [Value; 2]) -> Value {
        let zero = Value::of(0.0);
        match operation {
            Operation::Add(..) if a == zero => b,
            Operation::Add(..) | Operation::Subtract(..) if b == zero => a,
            Operation::Multiply(..) if a == zero || b == zero => zero,
            _ => self.push(operation.of([a, b])),
        }
    }

    /// The program of these outputs, with nothing that they don't need.
    pub(crate) fn program(&self, outputs: &[Value]) -> Program {
        written(&self.operations, outputs)
    }
}

fn written(operations: &[Made], outputs: &[Value]) -> Program {
    let mut needed: BTreeSet<Value> = outputs.iter().copied().collect();
    for (at, &made) in operations.iter().enumerate().rev() {
        if needed.contains(&Value::Result(at)) {
            needed.extend(made.read());
        }
    }
    // A set has numbers before inputs and results; a program has its inputs first.
    let of = |kind: fn(&Value) -> bool| needed.iter().filter(move |value| kind(value)).copied();
    let inputs = || of(|value| matches!(value, Value::Input(_)));
    let all = inputs()
        .chain(of(|value| matches!(value, Value::Number(_))))
        .chain(of(|value| matches!(value, Value::Result(_))));
    let registers: BTreeMap<Value, u32> = all.zip(0..).collect();
    let made = of(|value| matches!(value, Value::Result(_))).filter_map(|value| match value {
        Value::Result(at) => operations.get(at),
        _ => None,
    });
    let operation = |made: &Made| made.of(made.read().map(|value| registers[&value]));
    let source = |value| match value {
        Value::Input(source) => Some(source),
        _ => None,
    };
    Program {
        inputs: inputs().filter_map(source).collect(),
        literals: of(|value| matches!(value, Value::Number(_))).filter_map(Value::number).collect(),
        operations: made.map(operation).collect(),
        outputs: outputs.iter().map(|output| registers[output]).collect(),
    }
}
