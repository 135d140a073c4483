//! The single operations of a graph.

use crate::mathematics::symbolic::{Function, Rational, SymbolId};

/// An index into a [`Graph`](super::Graph); operands come before their operation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct NodeId(pub usize);

/// One entry of a symbol.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Input {
    pub symbol: SymbolId,
    pub row: usize,
    pub column: usize,
}

/// A constant, an input, or one operation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Node {
    Constant(Rational),
    Input(Input),
    Negate(NodeId),
    Add(NodeId, NodeId),
    Subtract(NodeId, NodeId),
    Multiply(NodeId, NodeId),
    Divide(NodeId, NodeId),
    Apply(Function, NodeId),
}

impl Node {
    pub fn operands(&self) -> [Option<NodeId>; 2] {
        match *self {
            Self::Constant(_) | Self::Input(_) => [None, None],
            Self::Negate(a) | Self::Apply(_, a) => [Some(a), None],
            Self::Add(a, b) | Self::Subtract(a, b) | Self::Multiply(a, b) | Self::Divide(a, b) => [Some(a), Some(b)],
        }
    }
}
