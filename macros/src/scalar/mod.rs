//! From matrix expressions to scalar operations: entries, stages, shared subexpressions, counts.

mod closed;
mod count;
mod expand;
mod graph;
mod kernel;
mod scalarise;
#[cfg(test)]
mod tests;

pub(crate) use closed::{Given, with_lets, with_values};
pub(crate) use count::count;
pub(crate) use graph::{Graph, Input, Node, NodeId};
pub(crate) use kernel::{Candidate, Kernel, components, kernel, square};
pub(crate) use scalarise::Scalariser;
