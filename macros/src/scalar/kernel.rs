//! The staged step: candidates for the Newton system, of which the cheapest is taken.

use std::collections::{BTreeMap, BTreeSet};

use super::count::{Operations, count};
use super::expand::expanded;
use super::graph::{Graph, Input, NodeId};
use super::scalarise::{Entries, Scalariser};
use crate::derive::{Cleared, Derived};
use crate::symbolic::{Expression, Rational, Stage, SymbolId, Symbols};

/// A way to write the Newton system, with its operations an iteration.
#[derive(Clone, Debug)]
pub(crate) struct Candidate {
    pub(crate) name: &'static str,
    pub(crate) operations: Operations,
}

/// The outputs of the stages, in one graph.
#[derive(Clone, Debug)]
pub(crate) struct Kernel {
    pub(crate) graph: Graph,
    pub(crate) kick_before: Vec<NodeId>,
    pub(crate) residual: Vec<NodeId>,
    pub(crate) jacobian: Vec<NodeId>,
    pub(crate) kick_after: Vec<NodeId>,
    /// The first is the one that was taken.
    pub(crate) candidates: Vec<Candidate>,
}

/// `tr(E_k W)` and the like for each generator: the components of a covector.
pub(crate) fn components(
    graph: &mut Graph,
    symbols: &Symbols,
    given: &BTreeMap<SymbolId, Entries>,
    covector: &Expression,
    direction: SymbolId,
) -> Vec<NodeId> {
    (0..3)
        .map(|k| {
            let mut given = given.clone();
            given.insert(direction, generator(graph, k));
            Scalariser { graph, symbols, given }.scalar(covector)
        })
        .collect()
}

/// `E_k = ê_k` of so(3).
pub(crate) fn generator(graph: &mut Graph, k: usize) -> Entries {
    let (zero, one) = (graph.zero(), graph.one());
    let minus = graph.negate(one);
    let (i, j) = ((k + 1) % 3, (k + 2) % 3);
    Entries::new(3, 3, |row, column| match (row, column) {
        place if place == (j, i) => one,
        place if place == (i, j) => minus,
        _ => zero,
    })
}

/// A Jacobian, row by row.
pub(crate) fn square(
    graph: &mut Graph,
    symbols: &Symbols,
    given: &BTreeMap<SymbolId, Entries>,
    bilinear: &Expression,
    (row, column): (SymbolId, SymbolId),
) -> Vec<NodeId> {
    let mut columns = Vec::new();
    for j in 0..3 {
        let mut given = given.clone();
        given.insert(column, generator(graph, j));
        columns.push(components(graph, symbols, &given, bilinear, row));
    }
    (0..3).flat_map(|k| columns.iter().map(move |column| column[k])).collect()
}

pub(crate) fn kernel(derived: &Derived) -> Kernel {
    let mut graph = Graph::default();
    let (symbols, first) = (&derived.symbols, derived.directions.first);
    let none = BTreeMap::new();
    let kick_before = components(&mut graph, symbols, &none, &derived.kick_before, first);
    let increment = shifted_by_identity(&mut graph, derived);
    let kick_after = components(&mut graph, symbols, &increment, &derived.kick_after, first);
    let mut found: Vec<(Candidate, Vec<NodeId>)> = Vec::new();
    let mut add = |graph: &Graph, name, outputs: Vec<NodeId>| {
        let operations = count(graph, &outputs, Some(Stage::Iteration));
        found.push((Candidate { name, operations }, outputs));
    };
    let (retracted, opaque) = retracted(&mut graph, derived);
    add(&graph, "F rebuilt from ξ", retracted.clone());
    if let Some(outputs) = expanded(&mut graph, &retracted, &opaque) {
        add(&graph, "F rebuilt from ξ, multiplied out", outputs);
    }
    if let Some(cleared) = &derived.cleared {
        let (nested, denominator) = cleared_system(&mut graph, derived, cleared);
        add(&graph, "Cayley, denominators cleared", nested.clone());
        if let Some(outputs) = expanded(&mut graph, &nested, &BTreeSet::from([denominator])) {
            add(&graph, "Cayley, denominators cleared, multiplied out", outputs);
        }
    }
    found.sort_by_key(|(candidate, _)| candidate.operations.cost());
    let outputs = found.first().map(|(_, outputs)| outputs.clone()).unwrap_or_default();
    let (residual, jacobian) = outputs.split_at(3);
    Kernel {
        kick_before,
        residual: residual.to_vec(),
        jacobian: jacobian.to_vec(),
        kick_after,
        candidates: found.into_iter().map(|(candidate, _)| candidate).collect(),
        graph,
    }
}

/// `F = I + D`, where the inputs named `F` are the entries of `D`.
fn shifted_by_identity(graph: &mut Graph, derived: &Derived) -> BTreeMap<SymbolId, Entries> {
    let symbol = derived.increment();
    let one = graph.one();
    let entries = Entries::new(3, 3, |row, column| {
        let entry = graph.input(Input { symbol, row, column }, Stage::Iteration);
        if row == column { graph.add(entry, one) } else { entry }
    });
    BTreeMap::from([(symbol, entries)])
}

fn coordinates(graph: &mut Graph, derived: &Derived) -> Vec<NodeId> {
    let symbol = derived.directions.coordinates;
    (0..3).map(|row| graph.input(Input { symbol, row, column: 0 }, Stage::Iteration)).collect()
}

/// `4 + |ξ|²`.
fn denominator(graph: &mut Graph, xi: &[NodeId]) -> NodeId {
    let squares: Vec<NodeId> = xi.iter().map(|&x| graph.multiply(x, x)).collect();
    let sum = graph.sum(&squares);
    let four = graph.constant(Rational::integer(4));
    graph.add(four, sum)
}

/// Residual and Jacobian of the cleared equation, nine and three; the denominator's node.
fn cleared_system(graph: &mut Graph, derived: &Derived, cleared: &Cleared) -> (Vec<NodeId>, NodeId) {
    let directions = &derived.directions;
    let xi = coordinates(graph, derived);
    let d = denominator(graph, &xi);
    let given = BTreeMap::from([(directions.denominator, Entries::new(1, 1, |_, _| d))]);
    let mut outputs = components(graph, &derived.symbols, &given, &cleared.residual, directions.first);
    let mut columns = Vec::new();
    for j in 0..3 {
        let (zero, one) = (graph.zero(), graph.one());
        let mut given = given.clone();
        let unit = Entries::new(3, 1, |row, _| if row == j { one } else { zero });
        given.insert(directions.coordinate_direction, unit);
        columns.push(components(graph, &derived.symbols, &given, &cleared.jacobian, directions.first));
    }
    outputs.extend((0..3).flat_map(|k| columns.iter().map(move |column| column[k])));
    (outputs, d)
}

/// `U(F) − a` with `F` computed from `ξ`, and its Jacobian `∂U/∂E_j · T_j`, with the tangent `T` of the retraction.
fn retracted(graph: &mut Graph, derived: &Derived) -> (Vec<NodeId>, BTreeSet<NodeId>) {
    let directions = &derived.directions;
    let xi = coordinates(graph, derived);
    let d = denominator(graph, &xi);
    let (one, half) = (graph.one(), graph.constant(Rational::new(1, 2)));
    let four = graph.constant(Rational::integer(4));
    let scale = graph.divide(four, d);
    let half_scale = graph.multiply(half, scale);
    let hat = |graph: &mut Graph, row: usize, column: usize| match (3 + column - row) % 3 {
        0 => graph.zero(),
        1 => graph.negate(xi[3 - row - column]),
        _ => xi[3 - row - column],
    };
    let tangent = Entries::new(3, 3, |row, column| {
        let entry = hat(graph, row, column);
        let scaled = graph.multiply(half_scale, entry);
        if row == column { scale } else { scaled }
    });
    // ξ̂² = ξξᵀ − |ξ|² I.
    let squared = {
        let squares: Vec<NodeId> = xi.iter().map(|&x| graph.multiply(x, x)).collect();
        graph.sum(&squares)
    };
    let f = Entries::new(3, 3, |row, column| {
        let product = graph.multiply(xi[row], xi[column]);
        let outer = graph.multiply(half_scale, product);
        let skew = hat(graph, row, column);
        let skew = graph.multiply(scale, skew);
        if row != column {
            return graph.sum(&[outer, skew]);
        }
        let shrink = graph.multiply(half_scale, squared);
        let kept = graph.subtract(outer, shrink);
        graph.add(kept, one)
    });
    let opaque: BTreeSet<NodeId> = f.all().iter().chain(tangent.all()).copied().collect();
    let given = BTreeMap::from([(derived.increment(), f)]);
    let symbol = directions.target;
    let unknown = components(graph, &derived.symbols, &given, &derived.unknown, directions.first);
    let mut outputs: Vec<NodeId> = unknown
        .into_iter()
        .enumerate()
        .map(|(row, value)| {
            let a = graph.input(Input { symbol, row, column: 0 }, Stage::Step);
            graph.subtract(value, a)
        })
        .collect();
    let pair = (directions.first, directions.second);
    let jacobian = square(graph, &derived.symbols, &given, &derived.jacobian, pair);
    for row in 0..3 {
        for column in 0..3 {
            let terms: Vec<NodeId> =
                (0..3).map(|k| graph.multiply(jacobian[3 * row + k], tangent.at(k, column))).collect();
            outputs.push(graph.sum(&terms));
        }
    }
    (outputs, opaque)
}
