//! The declaration: syntax, spans, and the tree of the declared expression.
//!
//! `parse` reads tokens, `check` assigns shapes, and `lower` hands an expression without spans to the mathematics.
//! Mistakes of syntax, names and shapes are found here, those of the mathematics in `judged`. Each is reported at its token,
//! and collected in [`errors::Errors`].
//!
//! Deliberately not here: derived terms and generated code. The room knows `mathematics`, and nothing above itself.

pub mod check;
mod declaration;
pub mod errors;
pub mod lower;
pub mod parse;
pub mod spelling;
mod tree;

pub use declaration::Role;
pub use declaration::{
    AdvectedParameter, Continuous, Coordinates, Declaration, Discretisation, Factor, Field, FieldKind, Quadrature,
    Scalar, named_displacements, named_velocities,
};
pub use spelling::Spelling;
pub use tree::{Frames, Kind, Name, OF_ANY_SIZE, Shape, Tree, parts};
