//! The derivation of liestep: what a declaration means, whether it is right, and the code that it becomes.
//!
//! Its rooms depend on each other in one direction:
//!
//! `lib → staged → expand → emit → judged → {declared, program} → mathematics`
//!
//! Tokens are quoted in `emit` alone. Syntax is known in `declared`, where it is read, and in `emit`, where it is
//! written; `mathematics` and `program` know no span either. A test reads this page and holds all sources to it.
//!
//! The macros of `liestep-macros` hand their tokens to [`expand()`] and its neighbours; [`staged()`] derives a text while a
//! program runs.

mod declared;
mod emit;
mod expand;
mod judged;
mod mathematics;
mod program;
mod staged;

pub use declared::Role;
pub use declared::errors::{Mistake, suggestion};
pub use emit::{hot, lanes};
pub use expand::{expand, matrix_group};
pub use staged::{
    Action, Array, Carried, Factor, Function, MOST_WORK, Operation, Parameter, ParameterKind, Program, Refusal, Source,
    StagedDeclaration, Stages, staged,
};
