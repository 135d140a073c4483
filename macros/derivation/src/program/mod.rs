//! Programs: matrix expressions as straight-line scalar code, with stages, shared subexpressions and counts.
//!
//! `scalarise` reduces matrices to their entries, `graph` stores equal operations once, each a `node`, `expand`
//! multiplies out, `closed` has the `let`s that stay closed, `kernel` the step, in the coordinates of `retraction`,
//! `zeros` leaves out entries that a group doesn't have, `stages` the values passed between its stages, `terms` the derived terms without stages, `tangent` and `gradient`
//! the derivatives of a step, and `count` its cost.
//!
//! Deliberately not here: tokens, the group of the user's declaration by any name, and the choice between two programs
//! of different declarations. The room knows `mathematics`.

mod closed;
pub mod count;
pub mod expand;
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
mod zeros;

pub use closed::{Beginning, KnownEntries, with_values};
pub use count::count;
pub use graph::{Graph, Input, Node, NodeId};
pub use kernel::{
    Candidate, Kernel, along_directions, along_unit_vectors, components, diamond_matrices, kernel, square,
};
pub use scalarise::Scalariser;
pub use stages::{Handover, Stages, needed};
pub use tangent::{ByNumbers, Derivatives, Place, WeightedGradient};
pub use terms::{Form, Outputs};
