//! Programs under construction: what is folded, and what keeps its bits.

use liestep_derivation::whole::{Value, Words};
use liestep_derivation::{Array, Function, Operation, Program, Source};

use crate::common::random::Random;

fn input(at: usize) -> Value {
    Value::Input(Source::new(Array::Parameters, at))
}

fn run(program: &Program, inputs: &[f64]) -> Vec<f64> {
    let mut values: Vec<f64> = program.inputs.iter().map(|source| inputs[source.at]).collect();
    values.extend(&program.literals);
    for operation in &program.operations {
        let [a, b] = operation.operands().map(|at| values[at]);
        values.push(match operation {
            Operation::Negate(_) => -a,
            Operation::Add(..) => a + b,
            Operation::Subtract(..) => a - b,
            Operation::Multiply(..) => a * b,
            Operation::Divide(..) => a / b,
            Operation::Apply(function, _) => function.apply(a),
        });
    }
    program.outputs.iter().map(|&at| values[at as usize]).collect()
}

/// A random program with many zeros, ones and negations has the same bits after folding.
#[test]
fn folding_keeps_the_bits() {
    let mut random = Random::new(23);
    for _ in 0..200 {
        let mut operations = Vec::new();
        for at in 6..40_u32 {
            let mut below = || u32::try_from(random.below(at as usize)).expect("a register");
            let (a, b) = (below(), below());
            operations.push(match random.below(6) {
                0 => Operation::Negate(a),
                1 => Operation::Add(a, b),
                2 => Operation::Subtract(a, b),
                3 => Operation::Apply(Function::Sin, a),
                _ => Operation::Multiply(a, b),
            });
        }
        let inputs = (0..3).map(|at| Source::new(Array::Parameters, at)).collect();
        let program = Program { inputs, literals: vec![0.0, 1.0, -1.0], operations, outputs: (20..40).collect() };
        let numbers = [random.signed(), random.signed(), random.signed()];
        let mut words = Words::default();
        let outputs = words.append(&program, Value::Input);
        let folded = words.program(&outputs);
        assert!(folded.operations.len() < program.operations.len());
        // The comparison takes zeros of both signs as equal.
        assert_eq!(run(&folded, &numbers), run(&program, &numbers));
    }
}

#[test]
fn zeros_ones_and_signs_are_left_out() {
    let mut words = Words::default();
    let (x, y) = (input(0), input(1));
    assert_eq!(words.add(x, Value::ZERO), x);
    assert_eq!(words.subtract(x, Value::ZERO), x);
    assert_eq!(words.multiply(x, Value::ONE), x);
    assert_eq!(words.multiply(Value::ZERO, x), Value::ZERO);
    assert_eq!(words.divide(x, Value::ONE), x);
    let minus = words.negate(x);
    assert_eq!(words.multiply(Value::of(-1.0), x), minus);
    assert_eq!(words.negate(minus), x);
    let difference = words.subtract(y, x);
    assert_eq!(words.add(y, minus), difference);
    assert_eq!(words.add(minus, y), difference);
    let product = words.multiply(x, y);
    let negative = words.multiply(minus, y);
    assert_eq!(words.negate(negative), product);
    // The operations are a negation, a difference, a product and its negation.
    assert_eq!(words.len(), 4);
    let program = words.program(&[difference]);
    assert_eq!((program.inputs.len(), program.operations.len()), (2, 1));
}
