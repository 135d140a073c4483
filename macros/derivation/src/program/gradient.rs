//! The gradient of a weighted sum of outputs: the chain rule from the outputs back to the inputs.
//!
//! It takes about three times the operations of the outputs, independently of the number of inputs.

use std::collections::BTreeMap;

use super::graph::{Graph, Node, NodeId};
use crate::mathematics::symbolic::{Function, Rational};

/// The derivative by each node that the sum depends on.
pub(super) type Gradient = BTreeMap<NodeId, NodeId>;

/// The gradient of the sum of the outputs, each times its weight.
pub(super) fn gradient(graph: &mut Graph, weighted: &[(NodeId, NodeId)]) -> Gradient {
    let mut found = Gradient::new();
    let outputs: Vec<NodeId> = weighted.iter().map(|(output, _)| *output).collect();
    for &(output, weight) in weighted {
        give(graph, &mut found, output, weight);
    }
    for id in graph.reachable(&outputs).into_iter().rev() {
        let Some(&own) = found.get(&id) else { continue };
        match graph.node(id) {
            Node::Constant(_) | Node::Input(_) => {}
            Node::Negate(a) => {
                let minus = graph.negate(own);
                give(graph, &mut found, a, minus);
            }
            Node::Add(a, b) => {
                give(graph, &mut found, a, own);
                give(graph, &mut found, b, own);
            }
            Node::Subtract(a, b) => {
                let minus = graph.negate(own);
                give(graph, &mut found, a, own);
                give(graph, &mut found, b, minus);
            }
            Node::Multiply(a, b) => {
                let [by_first, by_second] = [graph.multiply(own, b), graph.multiply(own, a)];
                give(graph, &mut found, a, by_first);
                give(graph, &mut found, b, by_second);
            }
            // d(a/b) = (da − (a/b) db)/b.
            Node::Divide(a, b) => {
                let by_dividend = graph.divide(own, b);
                let by_divisor = graph.multiply(id, by_dividend);
                let by_divisor = graph.negate(by_divisor);
                give(graph, &mut found, a, by_dividend);
                give(graph, &mut found, b, by_divisor);
            }
            Node::Apply(function, a) => {
                let slope = slope(graph, function, a, id);
                let by_argument = graph.multiply(own, slope);
                give(graph, &mut found, a, by_argument);
            }
        }
    }
    found
}

/// Adds a contribution to the derivative by a node; constants have none.
fn give(graph: &mut Graph, found: &mut Gradient, node: NodeId, share: NodeId) {
    if graph.value(node).is_none() && !graph.is_zero(share) {
        let sum = found.get(&node).map_or(share, |&sum| graph.add(sum, share));
        found.insert(node, sum);
    }
}

/// `f'(a)`, where `value` is the node of `f(a)`; the rules of [`variation`](crate::mathematics::symbolic::variation).
pub(super) fn slope(graph: &mut Graph, function: Function, a: NodeId, value: NodeId) -> NodeId {
    let half = graph.constant(Rational::new(1, 2));
    match function {
        Function::Sqrt => graph.divide(half, value),
        Function::Ln => {
            let one = graph.one();
            graph.divide(one, a)
        }
        Function::Exp => value,
        Function::Sin => graph.apply(Function::Cos, a),
        Function::Cos => {
            let sine = graph.apply(Function::Sin, a);
            graph.negate(sine)
        }
        Function::Stumpff(k) => {
            let (second, first) = (graph.apply(Function::Stumpff(k + 2), a), graph.apply(Function::Stumpff(k + 1), a));
            let factor = graph.constant(Rational::new(k.into(), 2));
            let (second, first) = (graph.multiply(factor, second), graph.multiply(half, first));
            graph.subtract(second, first)
        }
        Function::LogRatio(k) => graph.apply(Function::LogRatio(k + 1), a),
    }
}
