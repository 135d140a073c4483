//! The index of the nodes in a graph.
//!
//! A hash table with a fixed rule instead of a seed, so that results don't depend on the run. A long declaration looks
//! up some hundred thousand nodes; a tree took a fifth of an expansion, which runs unoptimised in most builds.

use super::node::{Node, NodeId};

/// The places of nodes, which are stored in the graph.
#[derive(Clone, Debug, Default)]
pub(super) struct Index {
    /// The slots: a power of two, at least half of them empty.
    slots: Vec<Option<NodeId>>,
}

impl Index {
    /// The node's place, or a free slot for it; `at` reads a node of the graph.
    pub(super) fn find(&self, node: &Node, at: impl Fn(NodeId) -> Node) -> Result<NodeId, usize> {
        let last = self.slots.len().wrapping_sub(1);
        let mut slot = hash(node) & last;
        while let Some(&Some(id)) = self.slots.get(slot) {
            if at(id) == *node {
                return Ok(id);
            }
            slot = (slot + 1) & last;
        }
        Err(slot)
    }

    /// Puts a new node, the last of the graph, into the slot that `find` returned.
    pub(super) fn insert(&mut self, slot: usize, id: NodeId, at: impl Fn(NodeId) -> Node) {
        if let Some(free) = self.slots.get_mut(slot) {
            *free = Some(id);
        }
        if 2 * (id.0 + 1) >= self.slots.len() {
            *self = Self { slots: vec![None; 4 * (id.0 + 16).next_power_of_two()] };
            for earlier in (0..=id.0).map(NodeId) {
                if let Err(slot) = self.find(&at(earlier), &at) {
                    self.slots[slot] = Some(earlier);
                }
            }
        }
    }
}

/// A hash that separates near numbers, such as those of operands.
fn hash(node: &Node) -> usize {
    let small = |x: i128| usize::try_from(x.unsigned_abs() & 0xFFFF_FFFF).unwrap_or(0) ^ usize::from(x < 0);
    let (kind, a, b) = match node {
        Node::Constant(value) => {
            let (numerator, denominator) = value.parts();
            (1, small(numerator), small(denominator))
        }
        Node::Input(input) => (2, input.symbol.0, 4 * input.row + input.column),
        Node::Negate(a) => (3, a.0, 0),
        Node::Add(a, b) => (4, a.0, b.0),
        Node::Subtract(a, b) => (5, a.0, b.0),
        Node::Multiply(a, b) => (6, a.0, b.0),
        Node::Divide(a, b) => (7, a.0, b.0),
        Node::Apply(function, a) => (8, a.0, function.number()),
    };
    let mut mixed: usize = kind;
    for part in [a, b] {
        // The multiplier is odd and 2³² over the golden ratio: its multiples are spread evenly.
        mixed = mixed.rotate_left(13).wrapping_add(part).wrapping_mul(0x9E37_79B1);
        mixed ^= mixed >> 15;
    }
    mixed
}
