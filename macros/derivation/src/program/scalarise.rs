//! Matrix expressions to scalar operations.
//!
//! A product is bracketed so that early stages are multiplied first. A scalar coefficient goes into the factor of the
//! earliest stage. Sums over an inner index stay together as one node, so that the entry `P_ij` of a
//! product is the same node in the residual and in its Jacobian.

use std::collections::BTreeMap;
use std::rc::Rc;

use super::graph::{Graph, Input, Matrix, NodeId};
use crate::mathematics::symbolic::{Atom, Expression, Factor, Monomial, Stage, Structure, SymbolId, Symbols, work};

/// A matrix of nodes.
#[derive(Clone, Debug)]
pub struct Entries {
    pub rows: usize,
    pub columns: usize,
    /// The nodes by rows; shared, as factors are copied far more often than constructed.
    nodes: Matrix,
}

impl Entries {
    pub fn new(rows: usize, columns: usize, mut entry: impl FnMut(usize, usize) -> NodeId) -> Self {
        let entries = (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)));
        Self { rows, columns, nodes: entries.map(|(row, column)| entry(row, column)).collect() }
    }

    pub fn at(&self, row: usize, column: usize) -> NodeId {
        self.nodes[row * self.columns + column]
    }

    pub fn all(&self) -> &[NodeId] {
        &self.nodes
    }

    fn transposed(&self) -> Self {
        Self::new(self.columns, self.rows, |row, column| self.at(column, row))
    }
}

/// Turns expressions into nodes of a graph.
pub struct Scalariser<'a> {
    graph: &'a mut Graph,
    symbols: &'a Symbols,
    /// Symbols whose entries aren't inputs: directions, and values computed from other inputs.
    given: &'a BTreeMap<SymbolId, Entries>,
    /// The nodes of scalars so far: a scalar that occurs in every term of a derivative is converted once.
    known: BTreeMap<Atom, NodeId>,
}

impl<'a> Scalariser<'a> {
    pub fn new(graph: &'a mut Graph, symbols: &'a Symbols, given: &'a BTreeMap<SymbolId, Entries>) -> Self {
        Self { graph, symbols, given, known: BTreeMap::new() }
    }

    /// A scalar expression.
    pub fn scalar(&mut self, expression: &Expression) -> NodeId {
        let terms: Vec<NodeId> = expression
            .terms()
            .take_while(|_| work::spend(1))
            .map(|(monomial, coefficient)| {
                let coefficient = self.graph.constant(coefficient);
                self.monomial(monomial, coefficient)
            })
            .collect();
        self.graph.sum(&terms)
    }

    /// The product of a monomial's scalars. All but the trace of the latest stage become one coefficient of that trace.
    fn monomial(&mut self, monomial: &Monomial, coefficient: NodeId) -> NodeId {
        let mut factors = vec![coefficient];
        let mut carrier: Option<(Stage, &[Factor])> = None;
        for (atom, exponent) in &monomial.scalars {
            if let Atom::Trace(word) = atom
                && *exponent == 1
            {
                let stage = self.word_stage(word);
                match carrier {
                    Some((latest, _)) if latest >= stage => factors.push(self.trace(word, None)),
                    _ => {
                        if let Some((_, earlier)) = carrier.replace((stage, word)) {
                            factors.push(self.trace(earlier, None));
                        }
                    }
                }
                continue;
            }
            let base = self.atom(atom);
            factors.push(self.graph.power(base, *exponent));
        }
        let scale = self.graph.product(factors);
        match carrier {
            Some((_, word)) => self.trace(word, Some(scale)),
            None => scale,
        }
    }

    fn atom(&mut self, atom: &Atom) -> NodeId {
        if let Some(&known) = self.known.get(atom) {
            return known;
        }
        let node = match atom {
            Atom::Symbol(id) => return self.symbol(*id).at(0, 0),
            Atom::Trace(word) => self.trace(word, None),
            Atom::Function(function, inner) => {
                let argument = self.scalar(inner);
                self.graph.apply(*function, argument)
            }
            Atom::Sum(inner) => self.scalar(inner),
        };
        self.known.insert(atom.clone(), node);
        node
    }

    fn symbol(&mut self, id: SymbolId) -> Entries {
        if let Some(given) = self.given.get(&id) {
            return given.clone();
        }
        let symbol = self.symbols.get(id);
        let ((rows, columns), structure, stage) = (symbol.shape, symbol.structure, symbol.stage);
        if let Some(nodes) = self.graph.symbols.get(&(id, false)) {
            return Entries { rows, columns, nodes: nodes.clone() };
        }
        let graph = &mut *self.graph;
        let entries = Entries::new(rows, columns, |row, column| {
            if structure == Structure::Diagonal && row != column {
                return graph.zero();
            }
            if structure == Structure::Point && row == rows - 1 {
                return graph.one();
            }
            let (row, column) =
                if structure.is_symmetric() { (row.min(column), row.max(column)) } else { (row, column) };
            graph.input(Input { symbol: id, row, column }, stage)
        });
        self.graph.symbols.insert((id, false), entries.nodes.clone());
        entries
    }

    fn transposed_symbol(&mut self, id: SymbolId) -> Entries {
        let entries = self.symbol(id);
        if self.given.contains_key(&id) {
            return entries.transposed();
        }
        let nodes = self.graph.symbols.entry((id, true)).or_insert_with(|| entries.transposed().nodes);
        Entries { rows: entries.columns, columns: entries.rows, nodes: nodes.clone() }
    }

    fn word_stage(&mut self, word: &[Factor]) -> Stage {
        let factors: Vec<Entries> = word.iter().map(|factor| self.factor(factor)).collect();
        factors.iter().map(|entries| self.stage_of(entries)).max().unwrap_or(Stage::Construction)
    }

    fn stage_of(&self, entries: &Entries) -> Stage {
        entries.all().iter().map(|&id| self.graph.stage(id)).max().unwrap_or(Stage::Construction)
    }

    fn is_constant(&self, entries: &Entries) -> bool {
        entries.all().iter().all(|&id| self.graph.value(id).is_some())
    }

    fn factor(&mut self, factor: &Factor) -> Entries {
        let turned = |entries: Entries, transposed: bool| if transposed { entries.transposed() } else { entries };
        match factor {
            Factor::Symbol { id, transposed: true } => self.transposed_symbol(*id),
            Factor::Symbol { id, transposed: false } => self.symbol(*id),
            Factor::Inverse { id, transposed } => {
                let inverse = if let Some(inverse) = self.symbols.inverse_of(*id) {
                    self.symbol(inverse)
                } else {
                    let entries = self.symbol(*id);
                    inverse(self.graph, &entries)
                };
                turned(inverse, *transposed)
            }
            Factor::Unit { index, size, transposed } => {
                let (zero, one) = (self.graph.zero(), self.graph.one());
                turned(Entries::new(*size, 1, |row, _| if row == *index { one } else { zero }), *transposed)
            }
            Factor::Hat(word) => {
                let v = self.product(word);
                let zero = self.graph.zero();
                let minus: Vec<NodeId> = v.all().iter().map(|&id| self.graph.negate(id)).collect();
                Entries::new(3, 3, |row, column| match (row, column) {
                    (0, 1) => minus[2],
                    (0, 2) => v.at(1, 0),
                    (1, 0) => v.at(2, 0),
                    (1, 2) => minus[0],
                    (2, 0) => minus[1],
                    (2, 1) => v.at(0, 0),
                    _ => zero,
                })
            }
            Factor::Diagonal(word) => {
                let v = self.product(word);
                let zero = self.graph.zero();
                Entries::new(v.rows, v.rows, |row, column| if row == column { v.at(row, 0) } else { zero })
            }
            Factor::Vee { word, transposed } => {
                let m = self.product(word);
                let half = self.graph.constant(crate::mathematics::symbolic::Rational::new(1, 2));
                let graph = &mut *self.graph;
                let v = Entries::new(3, 1, |row, _| {
                    let (i, j) = ((row + 2) % 3, (row + 1) % 3);
                    let difference = graph.subtract(m.at(i, j), m.at(j, i));
                    graph.multiply(half, difference)
                });
                turned(v, *transposed)
            }
        }
    }

    /// The product of a word's factors; the cheapest pair first.
    fn product(&mut self, word: &[Factor]) -> Entries {
        let mut factors: Vec<Entries> = word.iter().map(|factor| self.factor(factor)).collect();
        while factors.len() > 1 {
            let costs: Vec<_> = factors.windows(2).map(|pair| self.pair_cost(&pair[0], &pair[1])).collect();
            let at = cheapest(&costs);
            let right = factors.remove(at + 1);
            factors[at] = self.multiply(&factors[at].clone(), &right);
        }
        factors.pop().unwrap_or_else(|| Entries { rows: 0, columns: 0, nodes: Rc::new([]) })
    }

    /// The trace of a closed word, or the value of a bilinear form, times a scale.
    fn trace(&mut self, word: &[Factor], scale: Option<NodeId>) -> NodeId {
        // Known products are free, and the search for the first one compares all pairs.
        if !work::spend(word.len().saturating_mul(word.len())) {
            return self.graph.zero();
        }
        let mut factors: Vec<Entries> = word.iter().map(|factor| self.factor(factor)).collect();
        let mut outside = Vec::new();
        if let Some(scale) = scale {
            match self.earliest(&factors, scale) {
                Some(at) => factors[at] = self.scaled(&factors[at].clone(), scale),
                None => outside.push(scale),
            }
        }
        let is_form = factors.first().is_some_and(|first| first.rows == 1);
        while factors.len() > 2 {
            let pairs = if is_form { factors.len() - 1 } else { factors.len() };
            let next = |i: usize| (i + 1) % factors.len();
            let costs: Vec<_> = (0..pairs).map(|i| self.pair_cost(&factors[i], &factors[next(i)])).collect();
            let at = cheapest(&costs);
            let partner = next(at);
            let product = self.multiply(&factors[at].clone(), &factors[partner].clone());
            factors[at] = product;
            factors.remove(partner);
        }
        let value = match factors.as_slice() {
            [single] => {
                let diagonal: Vec<NodeId> = (0..single.rows).map(|i| single.at(i, i)).collect();
                self.graph.sum(&diagonal)
            }
            [left, right] => {
                let (left, right) = (left.clone(), right.clone());
                let rows: Vec<NodeId> = (0..left.rows).map(|i| self.inner(&left, i, &right, i)).collect();
                self.graph.sum(&rows)
            }
            _ => self.graph.one(),
        };
        outside.push(value);
        self.graph.product(outside)
    }

    /// The factor that takes a scale: the earliest known, if it is neither constant nor later than the scale, and
    /// something else comes later.
    fn earliest(&self, factors: &[Entries], scale: NodeId) -> Option<usize> {
        if self.graph.value(scale).is_some_and(|value| value == crate::mathematics::symbolic::Rational::ONE) {
            return None;
        }
        let stages = || factors.iter().map(|entries| self.stage_of(entries));
        let latest = stages().max()?;
        let candidates = stages().enumerate().filter(|&(at, _)| !self.is_constant(&factors[at]));
        let (at, stage) = candidates.min_by_key(|&(_, stage)| stage)?;
        (self.graph.stage(scale) <= stage && stage < latest).then_some(at)
    }

    fn scaled(&mut self, entries: &Entries, scale: NodeId) -> Entries {
        let graph = &mut *self.graph;
        Entries::new(entries.rows, entries.columns, |row, column| graph.multiply(scale, entries.at(row, column)))
    }

    fn multiply(&mut self, left: &Entries, right: &Entries) -> Entries {
        let key = (left.columns, left.nodes.clone(), right.nodes.clone());
        if let Some(nodes) = self.graph.products.get(&key) {
            return Entries { rows: left.rows, columns: right.columns, nodes: nodes.clone() };
        }
        let product = Entries::new(left.rows, right.columns, |row, column| self.inner(left, row, right, column));
        self.graph.products.insert(key, product.nodes.clone());
        product
    }

    fn inner(&mut self, left: &Entries, row: usize, right: &Entries, column: usize) -> NodeId {
        let terms: Vec<NodeId> =
            (0..left.columns).map(|k| self.graph.multiply(left.at(row, k), right.at(k, column))).collect();
        self.graph.sum(&terms)
    }

    /// The number of nodes of each stage, without constants.
    fn stages(&self, nodes: impl Iterator<Item = NodeId>) -> [usize; 3] {
        let mut counts = [0; 3];
        for node in nodes.filter(|&node| self.graph.value(node).is_none()) {
            counts[match self.graph.stage(node) {
                Stage::Construction => 0,
                Stage::Step => 1,
                Stage::Iteration => 2,
            }] += 1;
        }
        counts
    }

    /// The cost of a product of two factors, for comparisons: whether one factor is a generator, so that the other
    /// components of a covector don't share the product; its multiplications, weighted by their stage; the size of the
    /// result.
    fn pair_cost(&mut self, left: &Entries, right: &Entries) -> (bool, usize, usize) {
        let key = (left.columns, left.nodes.clone(), right.nodes.clone());
        if let Some(&cost) = self.graph.costs.get(&key) {
            return cost;
        }
        let is_own = self.is_constant(left) != self.is_constant(right);
        // The nodes of each stage in column k of the left factor meet those in row k of the right one.
        let cost = (0..left.columns).map(|k| {
            let above = self.stages((0..left.rows).map(|row| left.at(row, k)));
            let below = self.stages((0..right.columns).map(|column| right.at(k, column)));
            let [construction, step, iteration] = [0, 1, 2].map(|latest| {
                let up_to = |counts: &[usize; 3]| counts.iter().take(latest + 1).sum::<usize>();
                up_to(&above) * up_to(&below)
            });
            construction + 100 * (step - construction) + 10_000 * (iteration - step)
        });
        let cost: usize = cost.sum();
        let cost = (is_own, cost, left.rows * right.columns);
        self.graph.costs.insert(key, cost);
        cost
    }
}

/// The index of the least cost, the first of equal ones.
fn cheapest(costs: &[(bool, usize, usize)]) -> usize {
    (0..costs.len()).min_by_key(|&i| costs[i]).unwrap_or(0)
}

/// The entries of `A⁻¹` by Cramer's rule, for matrices of up to three rows.
fn inverse(graph: &mut Graph, matrix: &Entries) -> Entries {
    let size = matrix.rows;
    let is_diagonal =
        (0..size).all(|row| (0..size).all(|column| row == column || graph.is_zero(matrix.at(row, column))));
    let (zero, one) = (graph.zero(), graph.one());
    if is_diagonal {
        return Entries::new(
            size,
            size,
            |row, column| {
                if row == column { graph.divide(one, matrix.at(row, row)) } else { zero }
            },
        );
    }
    // Minors with rows and columns in cyclic order carry their sign.
    let cofactor = |graph: &mut Graph, row: usize, column: usize| {
        let at = |i: usize, j: usize| matrix.at((row + i) % size, (column + j) % size);
        match size {
            2 => {
                if row == column {
                    at(1, 1)
                } else {
                    graph.negate(at(1, 1))
                }
            }
            3 => {
                let (a, b) = (graph.multiply(at(1, 1), at(2, 2)), graph.multiply(at(1, 2), at(2, 1)));
                graph.subtract(a, b)
            }
            _ => graph.one(),
        }
    };
    let adjugate = Entries::new(size, size, |row, column| cofactor(graph, column, row));
    let terms: Vec<NodeId> = (0..size).map(|k| graph.multiply(matrix.at(0, k), adjugate.at(k, 0))).collect();
    let determinant = graph.sum(&terms);
    let reciprocal = graph.divide(one, determinant);
    Entries::new(size, size, |row, column| graph.multiply(adjugate.at(row, column), reciprocal))
}
