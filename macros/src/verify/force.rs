//! The self-check of a force: its share in the momentum equation against the declared virtual work.

use std::collections::BTreeMap;
use std::rc::Rc;

use super::{Evaluation, SPACING, Sample, TOLERANCE, Value, turn};
use crate::ast::{Declaration, Name, Tree};
use crate::derive::Derived;
use crate::lower::Lowered;
use crate::scalar::{Graph, Input, components, square};

/// The first derived term of a force that disagrees with the declaration, if one does.
pub(crate) fn disagreement_of_force(
    declaration: &Declaration,
    tree: &Rc<Tree>,
    lowered: &Lowered,
    derived: &Derived,
) -> Option<&'static str> {
    let (mut graph, none) = (Graph::default(), BTreeMap::new());
    let momentum = components(&mut graph, derived, &none, &derived.momentum);
    let jacobian = square(&mut graph, derived, &none, &derived.jacobian);
    let dimension = derived.group.dimension();
    (1..=3).find_map(|seed| {
        let sample = Sample::new(declaration, lowered, derived, seed);
        let value = |input: Input| {
            let value = sample.symbols.get(&input.symbol).and_then(|name| sample.values.get(name));
            value.map_or(f64::NAN, |value| value.at(input.row, input.column))
        };
        let (momentum, jacobian) = (graph.evaluate(&momentum, &value), graph.evaluate(&jacobian, &value));
        let f = sample.values.get(&Name::Increment)?.clone();
        // −f⁻_k at exp(tE_j) F.
        let expected = |k: usize, j: usize, t: f64| {
            let mut values = sample.values.clone();
            values.insert(Name::Increment, turn(&derived.group, j, t).times(&f));
            values.insert(Name::DisplacementBefore, Value::new(dimension, 1, |row, _| f64::from(u8::from(row == k))));
            values.insert(Name::DisplacementAfter, Value::new(dimension, 1, |_, _| 0.0));
            -Evaluation { values: &values, known: BTreeMap::new() }.of(tree).first()
        };
        let size: f64 = jacobian.iter().chain(&momentum).map(|x| x.abs()).sum();
        let differs = |found: f64, expected: f64| {
            let agrees = (found - expected).abs() <= TOLERANCE * (1.0 + size);
            expected.is_finite() && !agrees
        };
        (0..dimension).find_map(|k| {
            if differs(momentum[k], expected(k, 0, 0.0)) {
                return Some("force");
            }
            let slope = |j| (expected(k, j, SPACING) - expected(k, j, -SPACING)) / (2.0 * SPACING);
            (0..dimension).any(|j| differs(jacobian[dimension * k + j], slope(j))).then_some("Newton Jacobian")
        })
    })
}
