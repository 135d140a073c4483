//! The derivatives of the momenta at both ends of a step: derivatives of programs, operation by operation.
//!
//! `μ` of (2.7) and `μ⁺` of (2.6) are straight-line code in the entries of `D = F − I`, `w` and the parameters. A left
//! variation `ε` of the increment and a displacement `ζ` of the body at the beginning of the step change these entries
//! by
//!
//! ```text
//! δF = ε̂ F        δ(F⁻¹) = −F⁻¹ ε̂        δw = −ζ·w
//! ```
//!
//! and a translation by `δd = ε`.
//!
//! The chain rule is applied to the code and not to the expressions: closed `let`s need no rule of their own, and the
//! derivatives share the values of the momenta.

use std::collections::BTreeMap;

use super::closed::{KnownEntries, entries, with_lets};
use super::gradient::{Gradient, gradient, slope};
use super::graph::{Graph, Input, Node, NodeId};
use super::kernel::{by_increment, components, generator, square, velocity, with_inverse};
use super::scalarise::Entries;
use crate::mathematics::derive::{Derivation, Ends};
use crate::mathematics::symbolic::{Rational, Stage, SymbolId};

/// A number of the fields or of the advected parameters, and its entry of a symbol.
#[derive(Clone, Copy)]
pub struct Place {
    pub number: usize,
    pub symbol: SymbolId,
    pub row: usize,
    pub column: usize,
    /// Whether the number is an off-diagonal entry of a symmetric matrix, which occurs twice.
    pub is_half: bool,
}

/// The derivatives of some outputs by the numbers of the fields, then by those of the advected parameters; numbers
/// without effect are left out.
pub type ByNumbers = [Vec<(usize, Vec<NodeId>)>; 2];

/// The gradient of a weighted sum.
pub struct WeightedGradient {
    /// Along each displacement `ζ = E_j`.
    pub by_place: Vec<NodeId>,
    /// The derivative by each number, a single output.
    pub by_numbers: ByNumbers,
}

/// The derivatives of a step for the emitted code, if they are requested.
///
/// Weights are symbols that the differentiated outputs don't contain: `u` is the target of a step, `p` its velocity,
/// and `r` the coordinates of its increment.
pub struct Derivatives {
    pub graph: Graph,
    /// The components of `μ`, then those of `μ⁺`.
    pub momenta: Vec<NodeId>,
    /// The derivatives of `μ` and of `μ⁺` along each `ε = E_j`, then along each `ζ = E_j`; matrices by rows.
    pub blocks: [[Vec<NodeId>; 2]; 2],
    /// The derivatives of the components of both momenta.
    pub by_numbers: ByNumbers,
    /// `(∂μ⁺/∂ε)ᵀ p`, the right side of the adjoint equation of a step.
    pub by_turn: Vec<NodeId>,
    /// The gradient of `⟨p, μ⁺⟩ − ⟨u, μ⟩` at a fixed increment, which follows the solution of the adjoint equation.
    pub gradient: WeightedGradient,
    /// The gradient of `⟨u, D_v k⟩ + ⟨r, k − J u⟩` for the kick `k`, its derivative `D_v k` and the inertia `J`, for
    /// the derivatives of a force gradient. `None` if `D_v k` isn't derived.
    pub of_kick: Option<WeightedGradient>,
}

impl Derivatives {
    pub fn new(derived: &Derivation, ends: &Ends, numbers: &[Vec<Place>; 2]) -> Self {
        let mut linearisation = Linearisation::new(derived, ends);
        let blocks = linearisation.blocks();
        let by_numbers = numbers.each_ref().map(|places| linearisation.by_numbers(places));
        let by_turn = linearisation.by_turn();
        let weighted = linearisation.momenta_of_adjoint();
        let gradient = linearisation.gradient(&weighted, numbers);
        let of_kick = linearisation.kick().map(|weighted| linearisation.gradient(&weighted, numbers));
        let Linearisation { graph, momenta, .. } = linearisation;
        Self { graph, momenta, blocks, by_numbers, by_turn, gradient, of_kick }
    }
}

/// The momenta at both ends of a step, and the inputs that they are differentiated by.
struct Linearisation<'a> {
    derived: &'a Derivation,
    ends: &'a Ends,
    graph: Graph,
    /// The components of `μ`, then those of `μ⁺`.
    momenta: Vec<NodeId>,
    /// The entries of `F` and `F⁻¹`.
    increments: KnownEntries,
}

/// The changes of the inputs; other inputs don't change.
pub(super) type Changes = BTreeMap<NodeId, NodeId>;

/// Outputs with their weights.
type Pairings = Vec<(NodeId, NodeId)>;

impl<'a> Linearisation<'a> {
    fn new(derived: &'a Derivation, ends: &'a Ends) -> Self {
        let mut graph = Graph::default();
        let given = by_increment(&mut graph, derived, |graph, one, row, column| {
            graph.input(Input { symbol: one.small, row, column }, Stage::Iteration)
        });
        let increments = with_inverse(&mut graph, derived, given);
        let given = with_lets(&mut graph, derived, increments.clone());
        let momenta =
            ends.momenta.each_ref().map(|momentum| components(&mut graph, derived, &given, momentum)).concat();
        let linearisation = Self { derived, ends, graph, momenta, increments };
        let weights = [derived.directions.target, derived.directions.along];
        debug_assert!(
            linearisation.are_free(weights, &linearisation.momenta),
            "the weights are symbols of the momenta"
        );
        linearisation
    }

    /// Whether none of the outputs depends on the weights.
    fn are_free(&self, weights: [SymbolId; 2], outputs: &[NodeId]) -> bool {
        let is_weight = |id| matches!(self.graph.node(id), Node::Input(input) if weights.contains(&input.symbol));
        !self.graph.reachable(outputs).into_iter().any(is_weight)
    }

    /// The derivatives of `μ` and of `μ⁺` along each `ε = E_j`, then along each `ζ = E_j`; matrices by rows.
    fn blocks(&mut self) -> [[Vec<NodeId>; 2]; 2] {
        let dimension = self.derived.group.dimension();
        [false, true].map(|is_displaced| {
            let columns: Vec<Vec<NodeId>> = (0..dimension)
                .map(|j| {
                    let changes = if is_displaced { self.displaced(j) } else { self.turned(j) };
                    tangent(&mut self.graph, &self.momenta, &changes)
                })
                .collect();
            let rows = |momentum: usize| {
                let row = |k: usize| columns.iter().filter_map(move |column| column.get(k).copied());
                (momentum * dimension..(momentum + 1) * dimension).flat_map(row).collect()
            };
            [rows(0), rows(1)]
        })
    }

    fn by_turn(&mut self) -> Vec<NodeId> {
        let (end, dimension) = (self.weighted(1, self.derived.directions.along), self.derived.group.dimension());
        let by = gradient(&mut self.graph, &end);
        let turned = |j| {
            let changes = self.turned(j);
            along(&mut self.graph, &by, &changes)
        };
        (0..dimension).map(turned).collect()
    }

    fn momenta_of_adjoint(&mut self) -> Pairings {
        let mut weighted = self.weighted(0, self.derived.directions.target);
        for (_, weight) in &mut weighted {
            *weight = self.graph.negate(*weight);
        }
        weighted.extend(self.weighted(1, self.derived.directions.along));
        weighted
    }

    fn kick(&mut self) -> Option<Pairings> {
        let change = self.derived.kick_derivative.as_ref()?;
        let velocity = velocity(&mut self.graph, self.derived);
        let second = self.derived.directions.factors.first().map(|one| (one.second, velocity));
        let change = components(&mut self.graph, self.derived, &second.into_iter().collect(), change);
        let kick = components(&mut self.graph, self.derived, &KnownEntries::new(), &self.derived.kick_before);
        let inertia = square(&mut self.graph, self.derived, &KnownEntries::new(), &self.derived.limit.inertia);
        let weights = [self.derived.directions.target, self.derived.directions.coordinates];
        let outputs = [change.as_slice(), &kick, &inertia].concat();
        debug_assert!(self.are_free(weights, &outputs), "the weights are symbols of the kick");
        let dimension = self.derived.group.dimension();
        let [u, r] = weights.map(|symbol| (0..dimension).map(|row| self.entry(symbol, row, 0)).collect::<Vec<_>>());
        let of_inertia = r.iter().flat_map(|&of_row| u.iter().map(move |&of_column| (of_row, of_column)));
        let of_inertia: Vec<NodeId> = of_inertia
            .map(|(of_row, of_column)| {
                let product = self.graph.multiply(of_row, of_column);
                self.graph.negate(product)
            })
            .collect();
        Some(outputs.into_iter().zip([u, r, of_inertia].concat()).collect())
    }

    fn gradient(&mut self, weighted: &[(NodeId, NodeId)], numbers: &[Vec<Place>; 2]) -> WeightedGradient {
        let (by, dimension) = (gradient(&mut self.graph, weighted), self.derived.group.dimension());
        let displaced = |j| {
            let changes = self.displaced(j);
            along(&mut self.graph, &by, &changes)
        };
        let by_place = (0..dimension).map(displaced).collect();
        let by_numbers = numbers.each_ref().map(|places| {
            let of_place = |one: &mut Self, entry| vec![by.get(&entry).copied().unwrap_or_else(|| one.graph.zero())];
            self.of_places(places, of_place)
        });
        WeightedGradient { by_place, by_numbers }
    }

    fn by_numbers(&mut self, places: &[Place]) -> Vec<(usize, Vec<NodeId>)> {
        self.of_places(places, |one, entry| {
            let unit = one.graph.one();
            tangent(&mut one.graph, &one.momenta, &Changes::from([(entry, unit)]))
        })
    }

    /// The derivatives by each number, from those by its entry; numbers without effect are left out.
    fn of_places(
        &mut self,
        places: &[Place],
        mut by_entry: impl FnMut(&mut Self, NodeId) -> Vec<NodeId>,
    ) -> Vec<(usize, Vec<NodeId>)> {
        let mut found = Vec::new();
        for &Place { number, symbol, row, column, is_half } in places {
            let entry = self.entry(symbol, row, column);
            let mut derivatives = by_entry(self, entry);
            if derivatives.iter().all(|&node| self.graph.is_zero(node)) {
                continue;
            }
            if is_half {
                let half = self.graph.constant(Rational::new(1, 2));
                for node in &mut derivatives {
                    *node = self.graph.multiply(half, *node);
                }
            }
            found.push((number, derivatives));
        }
        found
    }

    /// The components of one of the momenta with their weights.
    fn weighted(&mut self, momentum: usize, weights: SymbolId) -> Pairings {
        let dimension = self.derived.group.dimension();
        let components = self.momenta.iter().skip(momentum * dimension).take(dimension).copied().collect::<Vec<_>>();
        let weight = |(row, component)| (component, self.entry(weights, row, 0));
        components.into_iter().enumerate().map(weight).collect()
    }

    fn entry(&mut self, symbol: SymbolId, row: usize, column: usize) -> NodeId {
        let stage = self.derived.symbols.get(symbol).stage;
        self.graph.input(Input { symbol, row, column }, stage)
    }

    fn turned(&mut self, j: usize) -> Changes {
        let mut changes = Changes::new();
        for (factor, one) in self.derived.directions.factors.iter().enumerate() {
            let e = generator(&mut self.graph, &self.derived.group, factor, j);
            if self.derived.group.factor(factor).is_added {
                self.collect(one.small, &e, &mut changes);
                continue;
            }
            let [f, inverse] = [one.increment, one.inverse].map(|symbol| self.matrix(symbol));
            let minus = negated(&mut self.graph, &e);
            let (small, of_inverse) = (product(&mut self.graph, &e, &f), product(&mut self.graph, &inverse, &minus));
            self.collect(one.small, &small, &mut changes);
            self.collect(one.small_inverse, &of_inverse, &mut changes);
        }
        changes
    }

    fn displaced(&mut self, j: usize) -> Changes {
        let mut given = KnownEntries::new();
        for (factor, one) in self.derived.directions.factors.iter().enumerate() {
            let e = generator(&mut self.graph, &self.derived.group, factor, j);
            given.insert(one.first, negated(&mut self.graph, &e));
        }
        let mut changes = Changes::new();
        for (w, moved) in &self.ends.moved {
            let moved = entries(&mut self.graph, &self.derived.symbols, &given, moved);
            self.collect(*w, &moved, &mut changes);
        }
        changes
    }

    /// An increment or its inverse.
    fn matrix(&self, symbol: SymbolId) -> Entries {
        self.increments.get(&symbol).cloned().unwrap_or_else(|| Entries::new(0, 0, |_, _| NodeId(0)))
    }

    fn collect(&mut self, symbol: SymbolId, moved: &Entries, changes: &mut Changes) {
        for row in 0..moved.rows {
            for column in 0..moved.columns {
                let entry = self.entry(symbol, row, column);
                changes.insert(entry, moved.at(row, column));
            }
        }
    }
}

/// The change of a weighted sum of outputs along changes of the inputs, by its gradient.
fn along(graph: &mut Graph, gradient: &Gradient, changes: &Changes) -> NodeId {
    let share = |(entry, &change): (&NodeId, &NodeId)| Some(graph.multiply(*gradient.get(entry)?, change));
    let shares: Vec<NodeId> = changes.iter().filter_map(share).collect();
    graph.sum(&shares)
}

fn negated(graph: &mut Graph, matrix: &Entries) -> Entries {
    Entries::new(matrix.rows, matrix.columns, |row, column| graph.negate(matrix.at(row, column)))
}

fn product(graph: &mut Graph, left: &Entries, right: &Entries) -> Entries {
    Entries::new(left.rows, right.columns, |row, column| {
        let terms: Vec<NodeId> =
            (0..left.columns).map(|k| graph.multiply(left.at(row, k), right.at(k, column))).collect();
        graph.sum(&terms)
    })
}

/// The changes of the outputs.
pub(super) fn tangent(graph: &mut Graph, outputs: &[NodeId], changes: &Changes) -> Vec<NodeId> {
    // Nodes that aren't in this map don't change.
    let mut known = changes.clone();
    known.retain(|_, change| !graph.is_zero(*change));
    for id in graph.reachable(outputs) {
        let change = |operand: NodeId| known.get(&operand).copied();
        let found = match graph.node(id) {
            Node::Constant(_) | Node::Input(_) => None,
            Node::Negate(a) => change(a).map(|a| graph.negate(a)),
            Node::Add(a, b) => either(graph, change(a), change(b), Graph::add),
            Node::Subtract(a, b) => {
                let taken = change(b).map(|b| graph.negate(b));
                either(graph, change(a), taken, Graph::add)
            }
            Node::Multiply(a, b) => {
                let of_first = change(a).map(|change| graph.multiply(change, b));
                let of_second = change(b).map(|change| graph.multiply(a, change));
                either(graph, of_first, of_second, Graph::add)
            }
            // d(a/b) = (da − (a/b) db)/b.
            Node::Divide(a, b) => {
                let of_divisor = change(b).map(|change| {
                    let product = graph.multiply(id, change);
                    graph.negate(product)
                });
                either(graph, change(a), of_divisor, Graph::add).map(|change| graph.divide(change, b))
            }
            Node::Apply(function, a) => change(a).map(|change| {
                let slope = slope(graph, function, a, id);
                graph.multiply(slope, change)
            }),
        };
        if let Some(change) = found.filter(|&change| !graph.is_zero(change)) {
            known.insert(id, change);
        }
    }
    outputs.iter().map(|output| known.get(output).copied().unwrap_or_else(|| graph.zero())).collect()
}

fn either(
    graph: &mut Graph,
    a: Option<NodeId>,
    b: Option<NodeId>,
    both: impl Fn(&mut Graph, NodeId, NodeId) -> NodeId,
) -> Option<NodeId> {
    match (a, b) {
        (Some(a), Some(b)) => Some(both(graph, a, b)),
        (one, other) => one.or(other),
    }
}
