//! The kernel of a step: the cheapest of several forms of the Newton system.

use std::collections::{BTreeMap, BTreeSet};

use super::closed::{Beginning, KnownEntries, entries, with_lets, with_tangents};
use super::count::{Operations, count};
use super::expand::expanded;
use super::graph::{Graph, Input, Node, NodeId};
use super::retraction::{denominator, rotation, translation};
use super::scalarise::{Entries, Scalariser};
use super::zeros::without_zeros;
use crate::mathematics::derive::{ClearedSystem, Continuous, Derivation, OfFactor, unit};
use crate::mathematics::group::Group;
use crate::mathematics::symbolic::{Expression, Rational, Stage, SymbolId, Symbols};

/// A form of the Newton system, with its operations an iteration.
#[derive(Clone, Debug)]
pub struct Candidate {
    pub name: &'static str,
    pub operations: Operations,
    /// The power of `1 + |y|²` that the system is multiplied by.
    denominators: u32,
}

/// The outputs of the stages, in one graph.
#[derive(Clone, Debug)]
pub struct Kernel {
    /// The beginning of the graph below, and of those of single terms.
    pub beginning: Beginning,
    pub graph: Graph,
    pub kick_before: Vec<NodeId>,
    /// The derivative of `kick_before` along a body velocity, if it is derived.
    pub kick_derivative: Option<Vec<NodeId>>,
    pub residual: Vec<NodeId>,
    pub jacobian: Vec<NodeId>,
    pub kick_after: Vec<NodeId>,
    /// Whether the Newton system is written in `D = F − I`, with a right-trivialised Jacobian. On products of SO(3)
    /// and translations it is written in Cayley coordinates.
    pub in_increment: bool,
    /// The power of `1 + |y|²` that the Newton system is multiplied by.
    pub denominators: u32,
    /// The candidates, the chosen one first.
    pub candidates: Vec<Candidate>,
}

impl Kernel {
    /// The factors at which the Jacobian falls into blocks: no earlier factor couples to them or to later ones.
    pub fn ends(&self, group: &Group) -> Vec<usize> {
        let dimension = group.dimension();
        let is_zero = |row: usize, column: usize| {
            self.jacobian.get(dimension * row + column).is_none_or(|&entry| self.graph.is_zero(entry))
        };
        let is_end = |factor: &usize| {
            let start = group.component_of(*factor);
            (0..start).all(|k| (start..dimension).all(|j| is_zero(k, j) && is_zero(j, k)))
        };
        (1..group.factors().len()).filter(is_end).collect()
    }

    /// The operations of a step without the solve and of an iteration, for `Facts::operations`.
    pub fn operations(&self) -> [u32; 2] {
        let before = [self.kick_before.as_slice(), &self.residual, &self.jacobian].concat();
        let step = count(&self.graph, &before, Some(Stage::Step))
            + count(&self.graph, &self.kick_after, Some(Stage::Step))
            + count(&self.graph, &self.kick_after, Some(Stage::Iteration));
        let iteration = count(&self.graph, &before, Some(Stage::Iteration));
        [step, iteration].map(|operations| u32::try_from(operations.cost() / 2).unwrap_or(u32::MAX))
    }

    /// The cost of a step with two Newton iterations.
    pub fn cost(&self) -> usize {
        let iteration = self.candidates.first().map_or(0, |candidate| candidate.operations.cost());
        2 * iteration + count(&self.graph, &self.kick_after, None).cost()
    }
}

/// The components of a covector, `tr(E_k W)` and the like for each generator.
pub fn components(graph: &mut Graph, derived: &Derivation, given: &KnownEntries, covector: &Expression) -> Vec<NodeId> {
    let mut given = given.clone();
    let mut of = |k| {
        for (factor, one) in derived.directions.factors.iter().enumerate() {
            given.insert(one.first, generator(graph, &derived.group, factor, k));
        }
        Scalariser::new(graph, &derived.symbols, &given).scalar(covector)
    };
    (0..derived.group.dimension()).map(&mut of).collect()
}

/// The matrix of a column that is linear in a direction of three components, by rows.
pub fn along_unit_vectors(
    graph: &mut Graph,
    symbols: &Symbols,
    direction: SymbolId,
    column: &Expression,
) -> Vec<NodeId> {
    let rows = column.shape().0;
    let places = (0..rows).flat_map(|row| [0, 1, 2].map(|k| (row, k)));
    let entry = |(row, k)| {
        let (zero, one) = (graph.zero(), graph.one());
        let along = Entries::new(3, 1, |at, _| if at == k { one } else { zero });
        let of_row = unit(row, rows, true, symbols).times(column, symbols);
        Scalariser::new(graph, symbols, &KnownEntries::from([(direction, along)])).scalar(&of_row)
    };
    places.map(entry).collect()
}

/// The values of a continuous term: a scalar for rank 0, the components of a covector for rank 1, and the entries of a
/// bilinear form by rows for rank 2.
pub fn along_directions(graph: &mut Graph, derived: &Continuous, rank: usize, term: &Expression) -> Vec<NodeId> {
    let dimension = derived.group.dimension();
    let along = [1, 2].map(|least| if rank >= least { dimension } else { 1 });
    let places = (0..along[0]).flat_map(|k| (0..along[1]).map(move |j| [k, j]));
    let of_place = |place: [usize; 2]| {
        let mut given = with_velocities(graph, derived);
        for (factor, directions) in derived.directions.iter().enumerate() {
            let (own, first) = (derived.group.factor(factor).dimension(), derived.group.component_of(factor));
            for (direction, k) in directions.iter().zip(place) {
                let (zero, one) = (graph.zero(), graph.one());
                let unit = Entries::new(own, 1, |row, _| if first + row == k { one } else { zero });
                given.insert(direction.components, unit);
                if let Some(matrix) = direction.matrix {
                    given.insert(matrix, generator(graph, &derived.group, factor, k));
                }
            }
        }
        Scalariser::new(graph, &derived.symbols, &given).scalar(term)
    };
    places.map(of_place).collect()
}

/// The matrices of the velocities, if they have symbols of their own.
fn with_velocities(graph: &mut Graph, derived: &Continuous) -> KnownEntries {
    let velocities = derived.velocities.iter().zip(derived.group.factors());
    let matrices = velocities.filter_map(|(velocity, own)| Some((velocity.matrix?, velocity.components, own)));
    matrices.map(|(matrix, components, own)| (matrix, matrix_of(graph, own, components))).collect()
}

/// The matrices that the diamond along any matrix pairs with, one for each factor of the group, by rows. For a
/// translation only the last column counts.
pub fn diamond_matrices(graph: &mut Graph, derived: &Continuous) -> Vec<Vec<NodeId>> {
    let factors = derived.group.factors().iter().enumerate();
    let of_factor = |(factor, own): (usize, &Group)| {
        let places = (0..own.size).flat_map(|row| (0..own.size).map(move |column| (row, column)));
        let entry = |(row, column): (usize, usize)| {
            let place = if own.is_added { (row, (column + 1 == own.size).then_some(0)) } else { (row, Some(column)) };
            let (zero, one) = (graph.zero(), graph.one());
            let mut given = with_velocities(graph, derived);
            for (other, &any) in derived.any.iter().enumerate() {
                let shape = derived.group.factor(other).shape();
                let is_one = |row, column| other == factor && place == (row, Some(column));
                let unit = Entries::new(shape.0, shape.1, |row, column| if is_one(row, column) { one } else { zero });
                given.insert(any, unit);
            }
            Scalariser::new(graph, &derived.symbols, &given).scalar(&derived.diamond_of_any)
        };
        places.map(entry).collect()
    };
    factors.map(of_factor).collect()
}

/// The block of the constant matrix `E_k` for a factor, which is all of it if the group isn't a product; a column for a
/// translation.
pub(super) fn generator(graph: &mut Graph, group: &Group, factor: usize, k: usize) -> Entries {
    let own = group.factor(factor);
    if own.is_added {
        let (zero, one, first) = (graph.zero(), graph.one(), group.component_of(factor));
        return Entries::new(own.dimension(), 1, |row, _| if first + row == k { one } else { zero });
    }
    let entries = group.generators.get(k).map_or(&[][..], Vec::as_slice);
    let (start, size) = (group.row_of(factor), group.factors().get(factor).map_or(0, |factor| factor.size));
    Entries::new(size, size, |row, column| {
        let entry = entries.get((start + row) * group.size + start + column).copied();
        graph.constant(entry.unwrap_or(Rational::ZERO))
    })
}

/// The matrix `Σ v_j E_j` of the velocity.
pub(super) fn velocity(graph: &mut Graph, derived: &Derivation) -> Entries {
    matrix_of(graph, &derived.group, derived.directions.along)
}

/// `Σ v_j E_j` for the components of a symbol.
fn matrix_of(graph: &mut Graph, group: &Group, symbol: SymbolId) -> Entries {
    let components: Vec<NodeId> =
        (0..group.dimension()).map(|row| graph.input(Input { symbol, row, column: 0 }, Stage::Step)).collect();
    let generators: Vec<Entries> = (0..group.dimension()).map(|j| generator(graph, group, 0, j)).collect();
    Entries::new(group.size, group.size, |row, column| {
        let terms: Vec<NodeId> = generators
            .iter()
            .zip(&components)
            .map(|(generator, &component)| graph.multiply(generator.at(row, column), component))
            .collect();
        graph.sum(&terms)
    })
}

/// A Jacobian, bilinear in `E_k` and `E_j`, by rows.
pub fn square(graph: &mut Graph, derived: &Derivation, given: &KnownEntries, bilinear: &Expression) -> Vec<NodeId> {
    let dimension = derived.group.dimension();
    let varies = derived
        .closed
        .iter()
        .any(|one| bilinear.contains(one.tangent.0) || bilinear.contains(one.multiplier_tangent.0));
    let columns: Vec<Vec<NodeId>> = (0..dimension)
        .map(|j| {
            let mut given = given.clone();
            for (factor, one) in derived.directions.factors.iter().enumerate() {
                given.insert(one.second, generator(graph, &derived.group, factor, j));
            }
            let given = if varies { with_tangents(graph, derived, given) } else { given };
            components(graph, derived, &given, bilinear)
        })
        .collect();
    by_rows(dimension, &columns)
}

fn by_rows(dimension: usize, columns: &[Vec<NodeId>]) -> Vec<NodeId> {
    (0..dimension).flat_map(|k| columns.iter().filter_map(move |column| column.get(k).copied())).collect()
}

pub fn kernel(derived: &Derivation) -> Kernel {
    let beginning = Beginning::new(derived);
    let mut graph = beginning.graph.clone();
    let kick_before = components(&mut graph, derived, &beginning.given, &derived.kick_before);
    let kick_derivative = derived.kick_derivative.as_ref().map(|expression| {
        let velocity = velocity(&mut graph, derived);
        let second = derived.directions.factors.first().map(|one| (one.second, velocity));
        components(&mut graph, derived, &second.into_iter().collect(), expression)
    });
    let increment = by_increment(&mut graph, derived, |graph, factor, row, column| {
        graph.input(Input { symbol: factor.small, row, column }, Stage::Iteration)
    });
    let kick_after = {
        let given = after(&mut graph, derived, increment.clone());
        let kick = components(&mut graph, derived, &given, &derived.kick_after);
        without_zeros(&mut graph, derived, &kick)
    };
    let mut found: Vec<(Candidate, Vec<NodeId>)> = Vec::new();
    let mut add = |graph: &Graph, name, denominators, outputs: Vec<NodeId>| {
        let operations = count(graph, &outputs, Some(Stage::Iteration));
        found.push((Candidate { name, operations, denominators }, outputs));
    };
    let in_increment = !derived.group.rotates();
    if in_increment {
        let given = with_inverse(&mut graph, derived, increment);
        let given = with_lets(&mut graph, derived, given);
        let outputs = system(&mut graph, derived, &given);
        let outputs = without_zeros(&mut graph, derived, &outputs);
        add(&graph, "in F", 0, outputs);
    } else {
        let (retracted, opaque) = retracted(&mut graph, derived);
        add(&graph, "F rebuilt from y", 0, retracted.clone());
        if derived.closed.is_empty()
            && let Some(outputs) = expanded(&mut graph, &retracted, &opaque)
        {
            add(&graph, "F rebuilt from y, multiplied out", 0, outputs);
        }
    }
    if let Some(cleared) = &derived.cleared {
        let (nested, denominator) = cleared_system(&mut graph, derived, cleared);
        add(&graph, "Cayley, denominators cleared", cleared.power, nested.clone());
        if let Some(outputs) = expanded(&mut graph, &nested, &BTreeSet::from([denominator])) {
            add(&graph, "Cayley, denominators cleared, multiplied out", cleared.power, outputs);
        }
    }
    found.sort_by_key(|(candidate, _)| candidate.operations.cost());
    let outputs = found.first().map(|(_, outputs)| outputs.clone()).unwrap_or_default();
    let (residual, jacobian) = outputs.split_at(derived.group.dimension().min(outputs.len()));
    Kernel {
        beginning,
        kick_before,
        kick_derivative,
        residual: residual.to_vec(),
        jacobian: jacobian.to_vec(),
        kick_after,
        in_increment,
        denominators: found.first().map_or(0, |(candidate, _)| candidate.denominators),
        candidates: found.into_iter().map(|(candidate, _)| candidate).collect(),
        graph,
    }
}

/// Adds the values of closed `let`s at `F` and `w = F·w⁺`.
fn after(graph: &mut Graph, derived: &Derivation, mut given: KnownEntries) -> KnownEntries {
    if derived.closed.is_empty() {
        return given;
    }
    for (w, previous) in &derived.previous {
        let entries = entries(graph, &derived.symbols, &given, previous);
        given.insert(*w, entries);
    }
    with_lets(graph, derived, given)
}

/// The entries of `D`, and `F = I + D`, of each factor.
pub(super) fn by_increment(
    graph: &mut Graph,
    derived: &Derivation,
    mut entry: impl FnMut(&mut Graph, &OfFactor, usize, usize) -> NodeId,
) -> KnownEntries {
    let mut given = KnownEntries::new();
    for (one, group) in derived.directions.factors.iter().zip(derived.group.factors()) {
        let (rows, columns) = group.shape();
        let small = Entries::new(rows, columns, |row, column| entry(graph, one, row, column));
        let f = if group.is_added { small.clone() } else { plus_identity(graph, &small) };
        given.extend([(one.small, small), (one.increment, f)]);
    }
    given
}

/// Adds the entries of `D⁻`, and `F⁻¹ = I + D⁻`.
pub(super) fn with_inverse(graph: &mut Graph, derived: &Derivation, mut given: KnownEntries) -> KnownEntries {
    let factors = derived.directions.factors.iter().zip(derived.group.factors());
    for (one, group) in factors.filter(|(_, group)| !group.is_added) {
        let small = Entries::new(group.size, group.size, |row, column| {
            graph.input(Input { symbol: one.small_inverse, row, column }, Stage::Iteration)
        });
        let inverse = plus_identity(graph, &small);
        given.extend([(one.small_inverse, small), (one.inverse, inverse)]);
    }
    given
}

fn plus_identity(graph: &mut Graph, small: &Entries) -> Entries {
    let one = graph.one();
    Entries::new(small.rows, small.columns, |row, column| {
        let entry = small.at(row, column);
        if row == column { graph.add(entry, one) } else { entry }
    })
}

/// `(h/2) (U(F) − a)` and its derivatives along `E_j`, at the `F`, `D` and `let`s in `given`.
fn system(graph: &mut Graph, derived: &Derivation, given: &KnownEntries) -> Vec<NodeId> {
    let target = target(graph, derived);
    let (mut outputs, jacobian) = if derived.closed.is_empty() {
        let scaled = |expression: &Expression| derived.half_step.clone().times(expression, &derived.symbols);
        let unknown = components(graph, derived, given, &scaled(&derived.unknown));
        (unknown, square(graph, derived, given, &scaled(&derived.jacobian)))
    } else {
        // The factor is applied to the results: closed `let`s leave nothing for it to cancel.
        let half_step = half_step(graph, derived);
        let unknown = components(graph, derived, given, &derived.unknown);
        let jacobian = square(graph, derived, given, &derived.jacobian);
        let mut scaled = |nodes: Vec<NodeId>| -> Vec<NodeId> {
            nodes.into_iter().map(|node| graph.multiply(half_step, node)).collect()
        };
        (scaled(unknown), scaled(jacobian))
    };
    for (row, value) in outputs.iter_mut().enumerate() {
        *value = graph.subtract(*value, target.at(row, 0));
    }
    outputs.extend(jacobian);
    outputs
}

fn half_step(graph: &mut Graph, derived: &Derivation) -> NodeId {
    Scalariser::new(graph, &derived.symbols, &KnownEntries::new()).scalar(&derived.half_step)
}

/// `(h/2) a`, computed once a step.
fn target(graph: &mut Graph, derived: &Derivation) -> Entries {
    let half_step = half_step(graph, derived);
    let symbol = derived.directions.target;
    Entries::new(derived.group.dimension(), 1, |row, column| {
        let a = graph.input(Input { symbol, row, column }, Stage::Step);
        graph.multiply(half_step, a)
    })
}

fn coordinates(graph: &mut Graph, derived: &Derivation) -> Vec<NodeId> {
    let symbol = derived.directions.coordinates;
    let dimension = derived.group.dimension();
    (0..dimension).map(|row| graph.input(Input { symbol, row, column: 0 }, Stage::Iteration)).collect()
}

/// The residual and the Jacobian of the cleared equation, three and nine entries, and the node of the denominator.
fn cleared_system(graph: &mut Graph, derived: &Derivation, cleared: &ClearedSystem) -> (Vec<NodeId>, NodeId) {
    let directions = &derived.directions;
    let y = coordinates(graph, derived);
    let d = denominator(graph, &y);
    let target = target(graph, derived);
    let given = BTreeMap::from([(directions.denominator, Entries::new(1, 1, |_, _| d)), (directions.target, target)]);
    let mut outputs = components(graph, derived, &given, &cleared.residual);
    let mut columns = Vec::new();
    for j in 0..3 {
        let (zero, one) = (graph.zero(), graph.one());
        let mut given = given.clone();
        let unit = Entries::new(3, 1, |row, _| if row == j { one } else { zero });
        given.insert(directions.coordinate_direction, unit);
        columns.push(components(graph, derived, &given, &cleared.jacobian));
    }
    outputs.extend(by_rows(3, &columns));
    (outputs, d)
}

/// `(h/2) (U(F) − a)` with `F = cay(2y)`, and its Jacobian `(h/2) ∂U/∂E_j · T_j`, with the tangent `T` in `y`.
///
/// Returns also the part of the diamond that depends on `F`, if it is derived, and the nodes that count as variables
/// when the system is multiplied out.
fn retracted(graph: &mut Graph, derived: &Derivation) -> (Vec<NodeId>, BTreeSet<NodeId>) {
    let y = coordinates(graph, derived);
    let (mut given, mut tangents) = (KnownEntries::new(), Vec::new());
    for (factor, (one, group)) in derived.directions.factors.iter().zip(derived.group.factors()).enumerate() {
        let y = &y[component_range(&derived.group, factor)];
        let (small, tangent) = if group.is_added { translation(graph, y) } else { rotation(graph, y) };
        let f = if group.is_added { small.clone() } else { plus_identity(graph, &small) };
        given.extend([(one.small, small), (one.increment, f)]);
        tangents.push(tangent);
    }
    let opaque = given.values().chain(&tangents).flat_map(|entries| entries.all().to_vec());
    let opaque: BTreeSet<NodeId> = opaque.filter(|&id| !matches!(graph.node(id), Node::Constant(_))).collect();
    let given = with_lets(graph, derived, given);
    let mut outputs = system(graph, derived, &given);
    let dimension = derived.group.dimension();
    let jacobian = outputs.split_off(dimension);
    for row in jacobian.chunks(dimension) {
        for (factor, tangent) in tangents.iter().enumerate() {
            let entries = &row[component_range(&derived.group, factor)];
            for column in 0..entries.len() {
                let terms: Vec<NodeId> = entries
                    .iter()
                    .enumerate()
                    .map(|(k, &entry)| graph.multiply(entry, tangent.at(k, column)))
                    .collect();
                outputs.push(graph.sum(&terms));
            }
        }
    }
    (outputs, opaque)
}

/// The components of a factor.
fn component_range(group: &Group, factor: usize) -> std::ops::Range<usize> {
    let first = group.component_of(factor);
    first..first + group.factor(factor).dimension()
}
