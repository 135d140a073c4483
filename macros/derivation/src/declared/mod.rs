//! What was written: syntax, spans, and the tree of the declared expression.
//!
//! Tokens come in at `parse`, shapes are settled in `check`, and spans end at `lower`, which hands an expression without
//! any to the mathematics. Every mistake that a user can make in a declaration is found here, at the token that it is
//! about, and gathered in [`errors::Errors`].
//!
//! Deliberately not here: anything that is derived, and any code that is written. The room knows `mathematics`, and
//! nothing above itself.

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
pub use tree::{Frames, Kind, Name, Shape, Tree, parts};
