//! The entries of closed `let`s, of their multipliers, and of the derivatives of both.

use std::collections::BTreeMap;

use super::graph::Graph;
use super::scalarise::{Entries, Scalariser};
use crate::mathematics::derive::Derivation;
use crate::mathematics::symbolic::{Expression, Factor, SymbolId, Symbols};

pub type KnownEntries = BTreeMap<SymbolId, Entries>;

/// The common beginning of all derived terms: the values of `let`s and multipliers at symbolic `F` and `w`.
#[derive(Clone, Debug)]
pub struct Beginning {
    pub graph: Graph,
    pub given: KnownEntries,
}

impl Beginning {
    pub(super) fn new(derived: &Derivation) -> Self {
        let mut graph = Graph::default();
        let given = with_lets(&mut graph, derived, KnownEntries::new());
        Self { graph, given }
    }
}

/// Adds the values of all `let`s; `F` and `w` are those in `given`, if they are there.
pub fn with_values<'a>(
    graph: &mut Graph,
    symbols: &Symbols,
    lets: impl Iterator<Item = (SymbolId, &'a Expression)>,
    mut given: KnownEntries,
) -> KnownEntries {
    for (symbol, value) in lets {
        let entries = entries(graph, symbols, &given, value);
        given.insert(symbol, entries);
    }
    given
}

/// Adds the values of all `let`s and multipliers; `F` and `w` are those in `given`, if they are there.
pub(super) fn with_lets(graph: &mut Graph, derived: &Derivation, given: KnownEntries) -> KnownEntries {
    let lets = derived.closed.iter().map(|closed| (closed.symbol, &closed.value));
    let mut given = with_values(graph, &derived.symbols, lets, given);
    let has_increment = derived.directions.factors.iter().any(|one| given.contains_key(&one.small));
    for closed in derived.closed.iter().rev() {
        let shape = derived.symbols.get(closed.symbol).shape;
        let pairing = if has_increment { &closed.near } else { &closed.pairing };
        let entries = dual(graph, derived, &mut given, (pairing, closed.direction, shape));
        given.insert(closed.multiplier, entries);
    }
    given
}

/// Adds the derivatives of all `let`s and multipliers along the direction in `given`.
pub(super) fn with_tangents(graph: &mut Graph, derived: &Derivation, mut given: KnownEntries) -> KnownEntries {
    let tangents = derived.closed.iter().map(|closed| (closed.tangent.0, &closed.tangent.1));
    given = with_values(graph, &derived.symbols, tangents, given);
    for closed in derived.closed.iter().rev() {
        let shape = derived.symbols.get(closed.symbol).shape;
        let (symbol, pairing) = &closed.multiplier_tangent;
        let entries = dual(graph, derived, &mut given, (pairing, closed.direction, shape));
        given.insert(*symbol, entries);
    }
    given
}

/// The entries of a scalar, vector or matrix expression.
pub(super) fn entries(graph: &mut Graph, symbols: &Symbols, given: &KnownEntries, expression: &Expression) -> Entries {
    let (rows, columns) = expression.shape();
    let unit = |index: usize, size: usize, transposed: bool| {
        let shape = if transposed { (1, size) } else { (size, 1) };
        Expression::from_word(vec![Factor::Unit { index, size, transposed }], shape, symbols)
    };
    let mut scalariser = Scalariser::new(graph, symbols, given);
    Entries::new(rows, columns, |row, column| {
        if (rows, columns) == (1, 1) {
            return scalariser.scalar(expression);
        }
        let of_row = unit(row, rows, true).times(expression, symbols);
        let entry = if columns == 1 { of_row } else { of_row.times(&unit(column, columns, false), symbols) };
        scalariser.scalar(&entry)
    })
}

/// `λ` from `⟨λ, δv⟩`, evaluated at the unit matrices.
fn dual(
    graph: &mut Graph,
    derived: &Derivation,
    given: &mut KnownEntries,
    (pairing, direction, (rows, columns)): (&Expression, SymbolId, (usize, usize)),
) -> Entries {
    let values = Entries::new(rows, columns, |row, column| {
        let (zero, one) = (graph.zero(), graph.one());
        let unit = Entries::new(rows, columns, |i, j| if (i, j) == (row, column) { one } else { zero });
        given.insert(direction, unit);
        Scalariser::new(graph, &derived.symbols, given).scalar(pairing)
    });
    // The direction is used in this function alone: no later term may use its last value.
    given.remove(&direction);
    values
}
