//! Values of straight-line code under construction, and the builder that adds operations on them.

use std::collections::{BTreeMap, BTreeSet};

use crate::staged::{Array, Function, Operation, Program, Source};

/// A value of a program under construction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Value {
    /// A number, as its bits.
    Number(u64),
    /// An input of the program.
    Input(Source),
    /// The result of an operation of the program.
    Result(usize),
}

impl Value {
    /// Zero.
    pub const ZERO: Self = Self::Number(0);
    /// One.
    pub const ONE: Self = Self::Number(1.0_f64.to_bits());

    /// A number; zeros of both signs are equal.
    #[must_use]
    pub fn of(number: f64) -> Self {
        Self::Number((number + 0.0).to_bits())
    }

    /// One if a condition holds, else zero.
    #[must_use]
    pub const fn one_if(holds: bool) -> Self {
        if holds { Self::ONE } else { Self::ZERO }
    }

    /// The first `count` inputs of an array.
    #[must_use]
    pub fn inputs(array: Array, count: usize) -> Vec<Self> {
        (0..count).map(|at| Self::Input(Source::new(array, at))).collect()
    }

    fn number(self) -> Option<f64> {
        match self {
            Self::Number(bits) => Some(f64::from_bits(bits)),
            _ => None,
        }
    }
}

/// An operation on values.
type ValueOperation = Operation<Value>;

/// A program under construction.
///
/// Operations on known numbers are folded, equal operations are made once, and sums with zero, products with zero and one
/// and double negations are left out. The results have the bits of the operations as they are written, but for the sign of
/// a zero, and for products of zero with what isn't finite.
#[derive(Debug, Default)]
pub struct Words {
    operations: Vec<ValueOperation>,
    known: BTreeMap<ValueOperation, Value>,
}

impl Words {
    /// The number of operations so far.
    #[must_use]
    pub fn len(&self) -> usize {
        self.operations.len()
    }

    fn push(&mut self, made: ValueOperation) -> Value {
        let operations = &mut self.operations;
        *self.known.entry(made).or_insert_with(|| {
            operations.push(made);
            Value::Result(operations.len() - 1)
        })
    }

    /// The operation that a value is the result of.
    fn made(&self, value: Value) -> Option<ValueOperation> {
        match value {
            Value::Result(at) => self.operations.get(at).copied(),
            _ => None,
        }
    }

    /// The value whose negative this value is, if it is one.
    fn negated(&self, value: Value) -> Option<Value> {
        match self.made(value) {
            Some(ValueOperation::Negate(a)) => Some(a),
            _ => None,
        }
    }

    /// `−a`.
    pub fn negate(&mut self, a: Value) -> Value {
        match a.number() {
            Some(a) => Value::of(-a),
            None => self.negated(a).unwrap_or_else(|| self.push(ValueOperation::Negate(a))),
        }
    }

    /// `a + b`.
    pub fn add(&mut self, a: Value, b: Value) -> Value {
        match (a.number(), b.number()) {
            (Some(a), Some(b)) => Value::of(a + b),
            (Some(0.0), _) => b,
            (_, Some(0.0)) => a,
            _ => match (self.negated(a), self.negated(b)) {
                (_, Some(b)) => self.subtract(a, b),
                (Some(a), None) => self.subtract(b, a),
                _ => self.push(ValueOperation::Add(a.min(b), a.max(b))),
            },
        }
    }

    /// `a − b`.
    pub fn subtract(&mut self, a: Value, b: Value) -> Value {
        match (a.number(), b.number()) {
            (Some(a), Some(b)) => Value::of(a - b),
            (Some(0.0), _) => self.negate(b),
            (_, Some(0.0)) => a,
            _ => match self.negated(b) {
                Some(b) => self.add(a, b),
                None => self.push(ValueOperation::Subtract(a, b)),
            },
        }
    }

    /// `a b`.
    pub fn multiply(&mut self, a: Value, b: Value) -> Value {
        // Numbers come first in the order of values.
        let (a, b) = (a.min(b), a.max(b));
        match (a.number(), b.number()) {
            (Some(a), Some(b)) => Value::of(a * b),
            (Some(0.0), _) => Value::ZERO,
            (Some(1.0), _) => b,
            (Some(-1.0), _) => self.negate(b),
            _ => match (self.negated(a), self.negated(b)) {
                (Some(a), Some(b)) => self.multiply(a, b),
                (None, None) => self.push(ValueOperation::Multiply(a, b)),
                (x, y) => {
                    let product = self.multiply(x.unwrap_or(a), y.unwrap_or(b));
                    self.negate(product)
                }
            },
        }
    }

    /// `a / b`.
    pub fn divide(&mut self, a: Value, b: Value) -> Value {
        match (a.number(), b.number()) {
            (Some(a), Some(b)) => Value::of(a / b),
            (Some(0.0), _) => Value::ZERO,
            (_, Some(1.0)) => a,
            _ => self.push(ValueOperation::Divide(a, b)),
        }
    }

    /// A function of `a`.
    pub fn apply(&mut self, function: Function, a: Value) -> Value {
        self.push(ValueOperation::Apply(function, a))
    }

    /// `Σ a_k b_k`, in this order.
    pub fn dot(&mut self, a: &[Value], b: &[Value]) -> Value {
        a.iter().zip(b).fold(Value::ZERO, |sum, (&a, &b)| {
            let product = self.multiply(a, b);
            self.add(sum, product)
        })
    }

    /// The sums of entries with the same index.
    pub fn added(&mut self, a: &[Value], b: &[Value]) -> Vec<Value> {
        a.iter().zip(b).map(|(&a, &b)| self.add(a, b)).collect()
    }

    /// The differences of entries with the same index.
    pub fn subtracted(&mut self, a: &[Value], b: &[Value]) -> Vec<Value> {
        a.iter().zip(b).map(|(&a, &b)| self.subtract(a, b)).collect()
    }

    /// The result of an operation on these operands.
    pub(super) fn operation<R: Copy>(&mut self, operation: Operation<R>, [a, b]: [Value; 2]) -> Value {
        match operation {
            Operation::Negate(_) => self.negate(a),
            Operation::Add(..) => self.add(a, b),
            Operation::Subtract(..) => self.subtract(a, b),
            Operation::Multiply(..) => self.multiply(a, b),
            Operation::Divide(..) => self.divide(a, b),
            Operation::Apply(function, _) => self.apply(function, a),
        }
    }

    /// Adds the operations of a program with these inputs; returns its outputs.
    pub fn append(&mut self, program: &Program, input: impl Fn(Source) -> Value) -> Vec<Value> {
        let literals = program.literals.iter().map(|&literal| Value::of(literal));
        let mut values: Vec<Value> = program.inputs.iter().map(|&source| input(source)).chain(literals).collect();
        for &operation in &program.operations {
            let operands = operation.operands().map(|at| values[at]);
            values.push(self.operation(operation, operands));
        }
        program.outputs.iter().map(|&at| values[at as usize]).collect()
    }

    /// The program of these outputs, without the operations that they don't need.
    #[must_use]
    pub fn program(&self, outputs: &[Value]) -> Program {
        // Results by their places, and inputs and numbers in the order of values.
        let (mut needed, mut given) = (vec![false; self.operations.len()], BTreeSet::new());
        let mut need = |needed: &mut Vec<bool>, value: Value| match value {
            Value::Result(at) => needed[at] = true,
            _ => {
                given.insert(value);
            }
        };
        for &value in outputs {
            need(&mut needed, value);
        }
        for (at, made) in self.operations.iter().enumerate().rev() {
            if needed[at] {
                for value in made.read() {
                    need(&mut needed, value);
                }
            }
        }
        let (mut inputs, mut literals, mut operations) = (Vec::new(), Vec::new(), Vec::new());
        let (mut given_at, mut result_at) = (BTreeMap::new(), vec![u32::MAX; needed.len()]);
        let number = |at: usize| u32::try_from(at).unwrap_or(u32::MAX);
        let numbers = given.iter().filter(|value| matches!(value, Value::Number(_))).count();
        // Sorted values begin with numbers, while the registers of a program begin with its inputs.
        let others = given.len() - numbers;
        for (at, &value) in given.iter().enumerate() {
            given_at.insert(value, number(if at < numbers { at + others } else { at - numbers }));
            match value {
                Value::Number(bits) => literals.push(f64::from_bits(bits)),
                Value::Input(source) => inputs.push(source),
                Value::Result(_) => {}
            }
        }
        for (at, made) in self.operations.iter().enumerate().filter(|(at, _)| needed[*at]) {
            result_at[at] = number(given.len() + operations.len());
            operations.push(*made);
        }
        let register = |value: Value| match value {
            Value::Result(at) => result_at[at],
            _ => given_at.get(&value).copied().unwrap_or(u32::MAX),
        };
        Program {
            inputs,
            literals,
            operations: operations.iter().map(|made| made.of(made.read().map(register))).collect(),
            outputs: outputs.iter().map(|&output| register(output)).collect(),
        }
    }
}
