//! The Cayley map from half the coordinates `y`, and its tangent, entry by entry.

use super::graph::{Graph, NodeId};
use super::scalarise::Entries;
use crate::mathematics::symbolic::Rational;

/// `1 + |y|²`.
pub(super) fn denominator(graph: &mut Graph, y: &[NodeId]) -> NodeId {
    let squares: Vec<NodeId> = y.iter().map(|&x| graph.multiply(x, x)).collect();
    let sum = graph.sum(&squares);
    let one = graph.one();
    graph.add(one, sum)
}

/// `d = 2y` of a translation, and the tangent in `y`.
pub(super) fn translation(graph: &mut Graph, y: &[NodeId]) -> (Entries, Entries) {
    let (zero, two) = (graph.zero(), graph.constant(Rational::integer(2)));
    let displacement = Entries::new(y.len(), 1, |row, _| graph.multiply(two, y[row]));
    (displacement, Entries::new(y.len(), y.len(), |row, column| if row == column { two } else { zero }))
}

/// `D = cay(2y) − I` of a rotation, and the tangent in `y`.
pub(super) fn rotation(graph: &mut Graph, y: &[NodeId]) -> (Entries, Entries) {
    let d = denominator(graph, y);
    let two = graph.constant(Rational::integer(2));
    let scale = graph.divide(two, d);
    let hat = |graph: &mut Graph, row: usize, column: usize| match (3 + column - row) % 3 {
        0 => graph.zero(),
        1 => graph.negate(y[3 - row - column]),
        _ => y[3 - row - column],
    };
    let tangent = Entries::new(3, 3, |row, column| {
        let entry = hat(graph, row, column);
        let scaled = graph.multiply(scale, entry);
        if row == column { scale } else { scaled }
    });
    // D = (ŷ + ŷ²) · 2/(1 + |y|²), ŷ² = yyᵀ − |y|² I; on the diagonal the squares cancel before they are formed.
    let small = Entries::new(3, 3, |row, column| {
        if row == column {
            let others: Vec<NodeId> = (0..3).filter(|&k| k != row).map(|k| graph.multiply(y[k], y[k])).collect();
            let sum = graph.sum(&others);
            let shrink = graph.multiply(scale, sum);
            return graph.negate(shrink);
        }
        let product = graph.multiply(y[row], y[column]);
        let outer = graph.multiply(scale, product);
        let skew = hat(graph, row, column);
        let skew = graph.multiply(scale, skew);
        graph.sum(&[outer, skew])
    });
    (small, tangent)
}
