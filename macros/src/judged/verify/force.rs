//! The self-check of a force: its share in the momentum equation against the declared virtual work.

use std::collections::BTreeMap;
use std::rc::Rc;

use super::{Evaluation, Sample, TOLERANCE, Value, evaluated, slope, turn};
use crate::declared::{Declaration, Name, Tree};
use crate::judged::choose::Chosen;
use crate::mathematics::derive::Derived;
use crate::program::{Graph, components, square};

/// The error is the first derived term of a force that disagrees with the declaration.
pub(crate) fn force(declaration: &Declaration, tree: &Rc<Tree>, chosen: &Chosen) -> Result<(), &'static str> {
    let Chosen { lowered, derived, .. } = chosen;
    let (mut graph, none) = (Graph::default(), BTreeMap::new());
    let momentum = components(&mut graph, derived, &none, &derived.momentum);
    let jacobian = square(&mut graph, derived, &none, &derived.jacobian);
    let found = (1..=3).find_map(|seed| {
        let sample = Sample::new(declaration, lowered, derived, seed);
        let inputs = sample.inputs(&sample.increment);
        let values = [&momentum, &jacobian].map(|outputs| evaluated(&graph, outputs, &inputs));
        disagreement(tree, derived, &sample, &values)
    });
    found.map_or(Ok(()), Err)
}

fn disagreement(
    tree: &Rc<Tree>,
    derived: &Derived,
    sample: &Sample,
    [momentum, jacobian]: &[Vec<f64>; 2],
) -> Option<&'static str> {
    let dimension = derived.group.dimension();
    // −f⁻_k at exp(tE_j) F.
    let expected = |k: usize, j: usize, t: f64| {
        let mut values = sample.values.clone();
        values.insert(Name::Increment, turn(&derived.group, j, t).times(&sample.increment));
        values.insert(Name::DisplacementBefore, Value::new(dimension, 1, |row, _| f64::from(u8::from(row == k))));
        values.insert(Name::DisplacementAfter, Value::new(dimension, 1, |_, _| 0.0));
        -Evaluation::new(&values).of(tree).first()
    };
    let size: f64 = jacobian.iter().chain(momentum).map(|x| x.abs()).sum();
    let differs = |found: Option<&f64>, expected: f64| {
        let agrees = found.is_some_and(|found| (found - expected).abs() <= TOLERANCE * (1.0 + size));
        expected.is_finite() && !agrees
    };
    (0..dimension).find_map(|k| {
        if differs(momentum.get(k), expected(k, 0, 0.0)) {
            return Some("force");
        }
        let is_wrong = |j| differs(jacobian.get(dimension * k + j), slope(&|t| expected(k, j, t)));
        (0..dimension).any(is_wrong).then_some("Newton Jacobian")
    })
}
