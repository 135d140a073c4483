//! Programs: matrix expressions as straight-line scalar code, with stages, shared subexpressions and counts.
//!
//! `scalarise` reduces matrices to their entries, `graph` stores equal operations once, each a `node`, `expand`
//! multiplies out, `closed` has the `let`s that stay closed, `kernel` the step, in the coordinates of `retraction`,
//! `stages` the values passed between its stages, `terms` the derived terms without stages, `tangent` and `gradient`
//! the derivatives of a step, and `count` its cost.
//!
//! Deliberately not here: tokens, the group of the user's declaration by any name, and the choice between two programs
//! of different declarations. The room knows `mathematics`.

mod closed;
mod count;
mod expand;
mod gradient;
mod graph;
mod index;
mod kernel;
mod node;
mod retraction;
mod scalarise;
mod stages;
mod tangent;
mod terms;
#[cfg(test)]
mod tests;

pub(crate) use closed::{Beginning, Given, with_values};
pub(crate) use count::count;
pub(crate) use graph::{Graph, Input, Node, NodeId};
pub(crate) use kernel::{
    Candidate, Kernel, along_directions, along_unit_vectors, components, diamond_matrices, kernel, square,
};
pub(crate) use scalarise::Scalariser;
pub(crate) use stages::{Handed, Stages, needed};
pub(crate) use tangent::{ByNumbers, Derivatives, Place, WeightedGradient};
pub(crate) use terms::{Form, Outputs};
