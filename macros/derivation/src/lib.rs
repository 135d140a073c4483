//! The derivation of liestep: the meaning of a declaration, its verification, and its generated code.
//!
//! Its rooms depend on each other in one direction:
//!
//! `lib → whole → staged → expand → emit → judged → {declared, program} → mathematics`
//!
//! Tokens are quoted in `emit` alone. Syntax is known in `declared`, which reads it, and in `emit`, which writes it;
//! `mathematics` and `program` know no span either. A test reads this page and holds all sources to it.
//!
//! The macros of `liestep-macros` pass their tokens to [`expand()`] and its neighbours; [`staged()`] derives texts at run
//! time, and [`whole`] makes steps of them. Four rooms are public for the tests alone, and hidden.

// Marks for callers outside of the crate, which the functions of these rooms don't have.
#![allow(clippy::len_without_is_empty, clippy::must_use_candidate, clippy::return_self_not_must_use)]

#[doc(hidden)]
pub mod declared;
mod emit;
mod expand;
#[doc(hidden)]
pub mod judged;
#[doc(hidden)]
pub mod mathematics;
#[doc(hidden)]
pub mod program;
mod staged;
pub mod whole;

pub use declared::Role;
pub use declared::errors::{Mistake, suggestion};
pub use emit::{hot, lanes};
pub use expand::{expand, matrix_group};
pub use staged::{
    Action, Array, Carried, Constraint, Constraints, Factor, Function, MOST_WORK, Operation, Parameter, ParameterKind,
    Program, Refusal, Source, StagedDeclaration, Stages, Variance, staged,
};
