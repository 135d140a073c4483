//! Operation counts by stage.

use std::fmt;

use super::graph::{Graph, Node, NodeId};
use crate::mathematics::symbolic::Stage;

/// The number of operations in a piece of code.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Operations {
    /// Additions, subtractions, multiplications and divisions.
    pub arithmetic: usize,
    /// Changes of sign, which the next operation usually absorbs.
    pub sign_flips: usize,
    /// Calls of a library function.
    pub functions: usize,
}

impl Operations {
    /// A single cost for comparisons: a library call costs about as much as twenty operations.
    pub fn cost(self) -> usize {
        2 * self.arithmetic + self.sign_flips + 40 * self.functions
    }
}

impl std::ops::Add for Operations {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            arithmetic: self.arithmetic + other.arithmetic,
            sign_flips: self.sign_flips + other.sign_flips,
            functions: self.functions + other.functions,
        }
    }
}

impl fmt::Display for Operations {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} operations", self.arithmetic)?;
        if self.sign_flips > 0 {
            write!(f, ", {} sign flips", self.sign_flips)?;
        }
        if self.functions > 0 {
            write!(f, ", {} library calls", self.functions)?;
        }
        Ok(())
    }
}

/// The operations of one stage, or of all, that the outputs need.
pub fn count(graph: &Graph, outputs: &[NodeId], stage: Option<Stage>) -> Operations {
    let mut operations = Operations::default();
    for id in graph.reachable(outputs) {
        if stage.is_some_and(|stage| graph.stage(id) != stage) {
            continue;
        }
        match graph.node(id) {
            Node::Constant(_) | Node::Input(_) => {}
            Node::Negate(_) => operations.sign_flips += 1,
            Node::Apply(..) => operations.functions += 1,
            Node::Add(..) | Node::Subtract(..) | Node::Multiply(..) | Node::Divide(..) => operations.arithmetic += 1,
        }
    }
    operations
}
