//! Scalar operations, with equal ones shared.

use std::collections::BTreeMap;
use std::rc::Rc;

use super::index::Index;
pub use super::node::{Input, Node, NodeId};
use crate::mathematics::symbolic::{Function, Rational, Stage, SymbolId, work};

/// Hash-consed operations; the constructors fold constants and move signs outward.
#[derive(Clone, Debug, Default)]
pub struct Graph {
    nodes: Vec<(Node, Stage)>,
    index: Index,
    /// Zero and one, if they are nodes already: they are looked up most often.
    units: [Option<NodeId>; 2],
    /// The products of matrices so far, by the inner dimension and the entries of both. The components of a covector
    /// share many of them, and the entries of a Jacobian more.
    pub(super) products: BTreeMap<(usize, Matrix, Matrix), Matrix>,
    /// The costs of products of matrices.
    pub(super) costs: BTreeMap<(usize, Matrix, Matrix), (bool, usize, usize)>,
    /// The entries of symbols and, with `true`, of their transposes, if they have been used.
    pub(super) symbols: BTreeMap<(SymbolId, bool), Matrix>,
}

/// The entries of a matrix, by rows.
pub(super) type Matrix = Rc<[NodeId]>;

impl Graph {
    pub fn node(&self, id: NodeId) -> Node {
        self.nodes[id.0].0
    }

    pub fn stage(&self, id: NodeId) -> Stage {
        self.nodes[id.0].1
    }

    fn insert(&mut self, node: Node, stage: Stage) -> NodeId {
        let slot = match self.index.find(&node, |id| self.node(id)) {
            Ok(id) => return id,
            Err(slot) => slot,
        };
        let id = NodeId(self.nodes.len());
        self.nodes.push((node, stage));
        let nodes = &self.nodes;
        self.index.insert(slot, id, |id| nodes[id.0].0);
        id
    }

    fn operation(&mut self, node: Node) -> NodeId {
        if !work::spend(1) {
            return self.zero();
        }
        let stage = node.operands().into_iter().flatten().map(|id| self.stage(id)).max();
        self.insert(node, stage.unwrap_or(Stage::Construction))
    }

    pub fn constant(&mut self, value: Rational) -> NodeId {
        self.insert(Node::Constant(value), Stage::Construction)
    }

    /// The exact value of an operation on constants, or the operation if the value is out of range.
    fn folded(&mut self, value: Rational, node: Node) -> NodeId {
        if value.is_overflow() { self.operation(node) } else { self.constant(value) }
    }

    pub fn zero(&mut self) -> NodeId {
        self.unit(0, Rational::ZERO)
    }

    pub fn one(&mut self) -> NodeId {
        self.unit(1, Rational::ONE)
    }

    fn unit(&mut self, place: usize, value: Rational) -> NodeId {
        let known = self.units[place];
        known.unwrap_or_else(|| {
            let id = self.constant(value);
            self.units[place] = Some(id);
            id
        })
    }

    pub fn input(&mut self, input: Input, stage: Stage) -> NodeId {
        self.insert(Node::Input(input), stage)
    }

    pub fn value(&self, id: NodeId) -> Option<Rational> {
        match self.node(id) {
            Node::Constant(value) => Some(value),
            _ => None,
        }
    }

    pub fn is_zero(&self, id: NodeId) -> bool {
        self.value(id).is_some_and(Rational::is_zero)
    }

    pub fn negate(&mut self, a: NodeId) -> NodeId {
        match self.node(a) {
            Node::Constant(value) => self.constant(-value),
            Node::Negate(inner) => inner,
            Node::Subtract(x, y) => self.subtract(y, x),
            _ => self.operation(Node::Negate(a)),
        }
    }

    pub fn add(&mut self, a: NodeId, b: NodeId) -> NodeId {
        match (self.node(a), self.node(b)) {
            (Node::Constant(x), Node::Constant(y)) => self.folded(x + y, Node::Add(a, b)),
            (Node::Constant(x), _) if x.is_zero() => b,
            (_, Node::Constant(y)) if y.is_zero() => a,
            (_, Node::Negate(y)) => self.subtract(a, y),
            (Node::Negate(x), _) => self.subtract(b, x),
            _ if a == b => {
                let two = self.constant(Rational::integer(2));
                self.multiply(two, a)
            }
            _ => self.operation(Node::Add(a.min(b), a.max(b))),
        }
    }

    pub fn subtract(&mut self, a: NodeId, b: NodeId) -> NodeId {
        match (self.node(a), self.node(b)) {
            (Node::Constant(x), Node::Constant(y)) => self.folded(x - y, Node::Subtract(a, b)),
            (_, Node::Constant(y)) if y.is_zero() => a,
            (Node::Constant(x), _) if x.is_zero() => self.negate(b),
            (_, Node::Negate(y)) => self.add(a, y),
            (Node::Negate(x), _) => {
                let sum = self.add(x, b);
                self.negate(sum)
            }
            _ if a == b => self.zero(),
            _ => self.operation(Node::Subtract(a, b)),
        }
    }

    pub fn multiply(&mut self, a: NodeId, b: NodeId) -> NodeId {
        match (self.node(a), self.node(b)) {
            (Node::Constant(x), Node::Constant(y)) => self.folded(x * y, Node::Multiply(a, b)),
            (Node::Constant(x), _) if x.is_zero() => a,
            (_, Node::Constant(y)) if y.is_zero() => b,
            (Node::Constant(x), _) if x == Rational::ONE => b,
            (_, Node::Constant(y)) if y == Rational::ONE => a,
            (Node::Constant(x), _) if x.is_negative() => {
                let size = self.constant(-x);
                let product = self.multiply(size, b);
                self.negate(product)
            }
            (Node::Negate(x), _) => {
                let product = self.multiply(x, b);
                self.negate(product)
            }
            (_, Node::Negate(_) | Node::Constant(_)) => self.multiply(b, a),
            _ => match self.constants_together(a, b) {
                Some((constant, rest)) => {
                    let constant = self.constant(constant);
                    self.multiply(constant, rest)
                }
                None => self.operation(Node::Multiply(a.min(b), a.max(b))),
            },
        }
    }

    /// `x (y b) = (x y) b` for constants `x` and `y`, if their product is exact.
    fn constants_together(&self, a: NodeId, b: NodeId) -> Option<(Rational, NodeId)> {
        let (Node::Constant(x), Node::Multiply(left, right)) = (self.node(a), self.node(b)) else { return None };
        let constant = |node, rest| self.value(node).map(|y| (x * y, rest));
        constant(left, right).or_else(|| constant(right, left)).filter(|(product, _)| !product.is_overflow())
    }

    pub fn divide(&mut self, a: NodeId, b: NodeId) -> NodeId {
        match (self.node(a), self.node(b)) {
            (Node::Constant(x), Node::Constant(y)) if !y.is_zero() => self.folded(x * y.inverse(), Node::Divide(a, b)),
            (_, Node::Constant(y)) if y == Rational::ONE => a,
            (Node::Constant(x), _) if x.is_zero() => a,
            _ => self.operation(Node::Divide(a, b)),
        }
    }

    /// `f(a)`. In a family with a recurrence only the highest members are called: the recurrence downwards loses no
    /// digits, and its operations are shared.
    pub fn apply(&mut self, function: Function, a: NodeId) -> NodeId {
        match function {
            // c_k = 1/k! − q c_{k+2}.
            Function::Stumpff(k) if k < 5 => {
                let higher = self.apply(Function::Stumpff(k + 2), a);
                let first = self.constant(function.at_zero().unwrap_or(Rational::ZERO));
                let rest = self.multiply(a, higher);
                self.subtract(first, rest)
            }
            Function::LogRatio(k) if k < 2 => self.log_ratio(k, a),
            _ => self.operation(Node::Apply(function, a)),
        }
    }

    /// `G` or `G'` from `G''`, with `u = n(1 − n)` and `s = 1 − 2n`: `G' = (2 − 2u s G'')/(3 − 8u)` and
    /// `G = u G'' + (3/2) s G'`, which hold at every angle.
    fn log_ratio(&mut self, derivative: u8, n: NodeId) -> NodeId {
        let second = self.apply(Function::LogRatio(2), n);
        let integers = [1, 2, 3, 8].map(|value| self.constant(Rational::integer(value)));
        let [one, two, three, eight] = integers;
        let (rest, twice) = (self.subtract(one, n), self.multiply(two, n));
        let (u, s) = (self.multiply(n, rest), self.subtract(one, twice));
        let product = self.multiply(u, second);
        let shifted = self.multiply(s, product);
        let (numerator, multiple) = (self.subtract(one, shifted), self.multiply(eight, u));
        let (numerator, denominator) = (self.multiply(two, numerator), self.subtract(three, multiple));
        let first = self.divide(numerator, denominator);
        if derivative == 1 {
            return first;
        }
        let three_halves = self.constant(Rational::new(3, 2));
        let scaled = self.multiply(s, first);
        let scaled = self.multiply(three_halves, scaled);
        self.add(product, scaled)
    }

    /// An integer power by squaring; a negative one is the reciprocal of the positive.
    pub fn power(&mut self, base: NodeId, exponent: i32) -> NodeId {
        let mut result = self.one();
        let (mut square, mut rest) = (base, exponent.unsigned_abs());
        while rest > 0 {
            if rest % 2 == 1 {
                result = self.multiply(result, square);
            }
            rest /= 2;
            if rest > 0 {
                square = self.multiply(square, square);
            }
        }
        if exponent < 0 {
            let one = self.one();
            return self.divide(one, result);
        }
        result
    }

    /// A product in which factors of early stages are multiplied first.
    pub fn product(&mut self, mut factors: Vec<NodeId>) -> NodeId {
        factors.sort_by_key(|&id| (self.stage(id), id));
        let one = self.one();
        factors.into_iter().fold(one, |product, factor| self.multiply(product, factor))
    }

    /// A sum in which early stages are added first.
    ///
    /// A sum of negatives becomes the negative of a sum, so that `a + b` and `−a − b` share a node.
    pub fn sum(&mut self, terms: &[NodeId]) -> NodeId {
        let mut signed: Vec<(NodeId, bool)> = Vec::with_capacity(terms.len());
        for &term in terms {
            match self.node(term) {
                Node::Constant(value) if value.is_zero() => {}
                Node::Negate(inner) => signed.push((inner, true)),
                _ => signed.push((term, false)),
            }
        }
        signed.sort_by_key(|&(id, _)| (self.stage(id), id));
        let mut total = self.zero();
        for stage in [Stage::Construction, Stage::Step, Stage::Iteration] {
            let here: Vec<_> = signed.iter().filter(|(id, _)| self.stage(*id) == stage).copied().collect();
            let factor = if stage == Stage::Construction { self.common_factor(&here) } else { None };
            let sum = match factor {
                // a c + b c = (a + b) c, so that a constant has one form, wherever it comes from.
                Some(factor) => {
                    let rest: Vec<_> = here.iter().map(|&(id, sign)| (self.without_factor(id, factor), sign)).collect();
                    let sum = self.sum_of_one_stage(&rest);
                    self.multiply(sum, factor)
                }
                None => self.sum_of_one_stage(&here),
            };
            total = self.add(total, sum);
        }
        total
    }

    /// The common factor of all terms, if there are at least two.
    fn common_factor(&self, terms: &[(NodeId, bool)]) -> Option<NodeId> {
        let (&(first, _), others) = terms.split_first()?;
        let Node::Multiply(a, b) = self.node(first) else { return None };
        let is_factor = |factor: NodeId| {
            others.iter().all(|&(id, _)| matches!(self.node(id), Node::Multiply(a, b) if a == factor || b == factor))
        };
        [b, a].into_iter().find(|&factor| !others.is_empty() && is_factor(factor))
    }

    fn without_factor(&self, product: NodeId, factor: NodeId) -> NodeId {
        match self.node(product) {
            Node::Multiply(a, b) if b == factor => a,
            Node::Multiply(a, b) if a == factor => b,
            _ => product,
        }
    }

    fn sum_of_one_stage(&mut self, terms: &[(NodeId, bool)]) -> NodeId {
        let mut sum = self.zero();
        for &(term, _) in terms.iter().filter(|(_, negative)| !negative) {
            sum = self.add(sum, term);
        }
        let mut taken = self.zero();
        if self.is_zero(sum) {
            for &(term, _) in terms {
                taken = self.add(taken, term);
            }
            return self.negate(taken);
        }
        for &(term, _) in terms.iter().filter(|(_, negative)| *negative) {
            sum = self.subtract(sum, term);
        }
        sum
    }

    /// The nodes that the outputs need, operands first.
    pub fn reachable(&self, outputs: &[NodeId]) -> Vec<NodeId> {
        self.reachable_from(outputs, &|_| false)
    }

    /// The nodes that the outputs need, operands first; given nodes need no operands.
    pub fn reachable_from(&self, outputs: &[NodeId], is_given: &dyn Fn(NodeId) -> bool) -> Vec<NodeId> {
        let end = outputs.iter().map(|output| output.0 + 1).max().unwrap_or(0);
        let mut needed = vec![false; end];
        for output in outputs {
            needed[output.0] = true;
        }
        for id in (0..end).rev() {
            if needed[id] && !is_given(NodeId(id)) {
                for operand in self.nodes[id].0.operands().into_iter().flatten() {
                    needed[operand.0] = true;
                }
            }
        }
        (0..end).filter(|&id| needed[id]).map(NodeId).collect()
    }

    pub fn nodes(&self) -> impl Iterator<Item = &Node> {
        self.nodes.iter().map(|(node, _)| node)
    }
}
