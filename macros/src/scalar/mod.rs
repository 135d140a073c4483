//! From matrix expressions to scalar operations: entries, stages, shared subexpressions, counts.

mod count;
mod expand;
mod graph;
mod kernel;
mod scalarise;
#[cfg(test)]
mod tests;

pub(crate) use count::count;
pub(crate) use graph::{Graph, Input, Node, NodeId};
pub(crate) use kernel::{Candidate, Kernel, components, kernel, square};
pub(crate) use scalarise::Scalariser;
