//! Zeros that the increments of all elements of a group share, left out of a program.

use std::collections::{BTreeMap, BTreeSet};

use super::graph::{Graph, Input, Node, NodeId};
use crate::mathematics::derive::Derivation;
use crate::mathematics::group::Group;

/// The outputs with the entries of `F − I` and `F⁻¹ − I` that are zero in all elements as constants. The order of the other
/// operations remains, so that results have the same bits.
pub(super) fn without_zeros(graph: &mut Graph, derived: &Derivation, outputs: &[NodeId]) -> Vec<NodeId> {
    let mut zeros = BTreeSet::new();
    for (one, group) in derived.directions.factors.iter().zip(derived.group.factors()) {
        for (row, column) in zeros_of(group) {
            zeros.extend([one.small, one.small_inverse].map(|symbol| (symbol, row, column)));
        }
    }
    if zeros.is_empty() {
        return outputs.to_vec();
    }
    let mut known: BTreeMap<NodeId, NodeId> = BTreeMap::new();
    for id in graph.reachable(outputs) {
        let at = |id: NodeId| known.get(&id).copied().unwrap_or(id);
        let new = match graph.node(id) {
            Node::Input(Input { symbol, row, column }) if zeros.contains(&(symbol, row, column)) => graph.zero(),
            Node::Input(_) | Node::Constant(_) => id,
            Node::Negate(a) => graph.negate(at(a)),
            Node::Add(a, b) => graph.add(at(a), at(b)),
            Node::Subtract(a, b) => graph.subtract(at(a), at(b)),
            Node::Multiply(a, b) => graph.multiply(at(a), at(b)),
            Node::Divide(a, b) => graph.divide(at(a), at(b)),
            Node::Apply(_, a) if at(a) == a => id,
            Node::Apply(function, a) => graph.apply(function, at(a)),
        };
        known.insert(id, new);
    }
    outputs.iter().map(|id| known.get(id).copied().unwrap_or(*id)).collect()
}

/// The entries that are zero in all products of generators.
fn zeros_of(group: &Group) -> Vec<(usize, usize)> {
    let n = group.size;
    if group.is_added {
        return Vec::new();
    }
    let mut filled: Vec<bool> = (0..n * n).map(|at| group.generators.iter().any(|e| !e[at].is_zero())).collect();
    // Warshall's closure: an entry of a product needs a path between its row and its column.
    for k in 0..n {
        for at in 0..n * n {
            filled[at] |= filled[at / n * n + k] && filled[k * n + at % n];
        }
    }
    (0..n * n).filter(|&at| !filled[at]).map(|at| (at / n, at % n)).collect()
}
