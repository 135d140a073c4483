//! The declaration: syntax, spans, and the tree of the declared expression.
//!
//! `parse` reads tokens, `check` assigns shapes, and `lower` hands an expression without spans to the mathematics.
//! Every mistake that a user can make in a declaration is found here, reported at its token, and collected in
//! [`errors::Errors`].
//!
//! Deliberately not here: derived terms and generated code. The room knows `mathematics`, and nothing above itself.

pub(crate) mod check;
mod declaration;
pub(crate) mod errors;
pub(crate) mod lower;
pub(crate) mod parse;
mod spelling;
mod tree;

pub use declaration::Role;
pub(crate) use declaration::{
    AdvectedParameter, Continuous, Coordinates, Declaration, Discretisation, Factor, Field, FieldKind, Quadrature,
    Scalar, named_displacements, named_velocities,
};
pub(crate) use spelling::Spelling;
pub(crate) use tree::{Frames, Kind, Name, Shape, Tree, parts};
