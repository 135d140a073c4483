//! How the momenta at both ends of a step vary: derivatives of programs, operation by operation.
//!
//! `μ` of (2.7) and `μ⁺` of (2.6) are straight-line code in the entries of `D = F − I`, `w` and the parameters. A turn
//! `ε` of the increment and a displacement `ζ` of the body at the beginning of the step move these entries by
//!
//! ```text
//! δF = ε̂ F        δ(F⁻¹) = −F⁻¹ ε̂        δw = −ζ·w
//! ```
//!
//! and a translation by `δd = ε`.
//!
//! The chain rule is applied to the code and not to the expressions: closed `let`s need no rule of their own, and what
//! the momenta have computed their derivatives share.

use std::collections::BTreeMap;

use super::closed::{Given, entries, with_lets};
use super::gradient::{Gradient, gradient, slope};
use super::graph::{Graph, Input, Node, NodeId};
use super::kernel::{by_increment, components, generator, square, velocity, with_inverse};
use super::scalarise::Entries;
use crate::mathematics::derive::{Derived, Ends};
use crate::mathematics::symbolic::{Rational, Stage, SymbolId};

/// The momenta at both ends of a step, to be differentiated.
pub(crate) struct Linearisation<'a> {
    derived: &'a Derived,
    ends: &'a Ends,
    pub(crate) graph: Graph,
    /// The components of `μ`, then those of `μ⁺`.
    momenta: Vec<NodeId>,
    /// `F` and `F⁻¹` by their entries.
    increments: Given,
}

/// The change of each input that changes.
pub(super) type Changes = BTreeMap<NodeId, NodeId>;

/// The gradient of a weighted sum: of `⟨p, μ⁺⟩ − ⟨u, μ⟩` at a fixed increment, what a step's adjoint ends with, or of a
/// kick.
pub(crate) struct WeightedGradient(Gradient);

impl<'a> Linearisation<'a> {
    pub(crate) fn new(derived: &'a Derived, ends: &'a Ends) -> Self {
        let mut graph = Graph::default();
        let given = by_increment(&mut graph, derived, |graph, one, row, column| {
            graph.input(Input { symbol: one.small, row, column }, Stage::Iteration)
        });
        let increments = with_inverse(&mut graph, derived, given);
        let given = with_lets(&mut graph, derived, increments.clone());
        let [start, end] = &ends.momenta;
        let momenta = [start, end].map(|momentum| components(&mut graph, derived, &given, momentum)).concat();
        let linearisation = Self { derived, ends, graph, momenta, increments };
        let weights = [linearisation.weights_of_start(), linearisation.weights_of_end()];
        debug_assert!(
            linearisation.are_free(weights, &linearisation.momenta),
            "the weights are symbols of the momenta"
        );
        linearisation
    }

    /// The components of `μ` and of `μ⁺`.
    pub(crate) fn momenta(&self) -> [Vec<NodeId>; 2] {
        let (start, end) = self.momenta.split_at(self.derived.group.dimension());
        [start.to_vec(), end.to_vec()]
    }

    /// Whether none of these depends on the symbols that stand for weights.
    fn are_free(&self, weights: [SymbolId; 2], outputs: &[NodeId]) -> bool {
        let is_weight = |id| matches!(self.graph.node(id), Node::Input(input) if weights.contains(&input.symbol));
        !self.graph.reachable(outputs).into_iter().any(is_weight)
    }

    /// The derivatives of `μ` and of `μ⁺` along each `ε = E_j`, then those along each `ζ = E_j`; matrices row by row.
    pub(crate) fn blocks(&mut self) -> [[Vec<NodeId>; 2]; 2] {
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

    /// What the adjoint of a step begins with: `∂μ/∂ε`, row by row, and `(∂μ⁺/∂ε)ᵀ p` for the weights `p` of `μ⁺`.
    pub(crate) fn adjoint_system(&mut self) -> [Vec<NodeId>; 2] {
        let dimension = self.derived.group.dimension();
        let end = self.weighted(1, self.weights_of_end());
        let by = gradient(&mut self.graph, &end);
        let (mut columns, mut by_turn) = (Vec::new(), Vec::new());
        for j in 0..dimension {
            let changes = self.turned(j);
            let start = self.momenta.iter().take(dimension).copied().collect::<Vec<_>>();
            columns.push(tangent(&mut self.graph, &start, &changes));
            by_turn.push(along(&mut self.graph, &by, &changes));
        }
        let row = |k: usize| columns.iter().filter_map(move |column| column.get(k).copied());
        [(0..dimension).flat_map(row).collect(), by_turn]
    }

    /// What it ends with: the gradient of `⟨p, μ⁺⟩ − ⟨u, μ⟩` at a fixed increment.
    pub(crate) fn adjoint_gradient(&mut self) -> WeightedGradient {
        let mut weighted = self.weighted(0, self.weights_of_start());
        for (_, weight) in &mut weighted {
            *weight = self.graph.negate(*weight);
        }
        weighted.extend(self.weighted(1, self.weights_of_end()));
        WeightedGradient(gradient(&mut self.graph, &weighted))
    }

    /// The gradient of `⟨u, D_v k⟩ + ⟨r, k − J u⟩` for the kick `k`, its derivative `D_v k` and the inertia `J`: what the
    /// derivatives of a force gradient are made of. `None` where `D_v k` isn't derived.
    pub(crate) fn kick_gradient(&mut self) -> Option<WeightedGradient> {
        let change = self.derived.kick_derivative.as_ref()?;
        let velocity = velocity(&mut self.graph, self.derived);
        let second = self.derived.directions.factors.first().map(|one| (one.second, velocity));
        let change = components(&mut self.graph, self.derived, &second.into_iter().collect(), change);
        let kick = components(&mut self.graph, self.derived, &Given::new(), &self.derived.kick_before);
        let inertia = square(&mut self.graph, self.derived, &Given::new(), &self.derived.limit.inertia);
        let weights = self.weights_of_kick();
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
        let weighted = outputs.into_iter().zip([u, r, of_inertia].concat()).collect::<Vec<_>>();
        Some(WeightedGradient(gradient(&mut self.graph, &weighted)))
    }

    /// The weights `u` and `r` of [`kick_gradient`](Self::kick_gradient): symbols that are free there.
    pub(crate) fn weights_of_kick(&self) -> [SymbolId; 2] {
        [self.derived.directions.target, self.derived.directions.coordinates]
    }

    /// Along displacements `ζ = E_j`.
    pub(crate) fn by_place(&mut self, gradient: &WeightedGradient) -> Vec<NodeId> {
        let dimension = self.derived.group.dimension();
        let displaced = |j| {
            let changes = self.displaced(j);
            along(&mut self.graph, &gradient.0, &changes)
        };
        (0..dimension).map(displaced).collect()
    }

    /// By an entry of a symbol.
    pub(crate) fn gradient_by_entry(
        &mut self,
        gradient: &WeightedGradient,
        symbol: SymbolId,
        row: usize,
        column: usize,
    ) -> NodeId {
        let entry = self.entry(symbol, row, column);
        gradient.0.get(&entry).copied().unwrap_or_else(|| self.graph.zero())
    }

    /// The weights `u` of `μ`. The momenta don't depend on this symbol, which is asserted where they are made.
    pub(crate) fn weights_of_start(&self) -> SymbolId {
        self.derived.directions.target
    }

    /// The weights `p` of `μ⁺`, an element of the algebra; as those of `μ`, a symbol that is free here.
    pub(crate) fn weights_of_end(&self) -> SymbolId {
        self.derived.directions.along
    }

    /// The components of one of the momenta with their weights.
    fn weighted(&mut self, momentum: usize, weights: SymbolId) -> Vec<(NodeId, NodeId)> {
        let dimension = self.derived.group.dimension();
        let components = self.momenta.iter().skip(momentum * dimension).take(dimension).copied().collect::<Vec<_>>();
        let weight = |(row, component)| (component, self.entry(weights, row, 0));
        components.into_iter().enumerate().map(weight).collect()
    }

    fn entry(&mut self, symbol: SymbolId, row: usize, column: usize) -> NodeId {
        let stage = self.derived.symbols.get(symbol).stage;
        self.graph.input(Input { symbol, row, column }, stage)
    }

    /// The derivatives of `μ` and of `μ⁺` by an entry of a symbol.
    pub(crate) fn by_entry(&mut self, symbol: SymbolId, row: usize, column: usize) -> Vec<NodeId> {
        let (entry, one) = (self.entry(symbol, row, column), self.graph.one());
        tangent(&mut self.graph, &self.momenta, &Changes::from([(entry, one)]))
    }

    /// Half of a derivative.
    pub(crate) fn halved(&mut self, derivative: NodeId) -> NodeId {
        let half = self.graph.constant(Rational::new(1, 2));
        self.graph.multiply(half, derivative)
    }

    /// Whether nothing of both momenta changes.
    pub(crate) fn is_nothing(&self, derivative: &[NodeId]) -> bool {
        derivative.iter().all(|&node| self.graph.is_zero(node))
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
        let mut given = Given::new();
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

/// The change along these changes of the inputs.
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

/// How the outputs change with the inputs.
pub(super) fn tangent(graph: &mut Graph, outputs: &[NodeId], changes: &Changes) -> Vec<NodeId> {
    // What isn't here doesn't change.
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
