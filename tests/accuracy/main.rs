//! Methods of higher order: their coefficients, the order of each measured, and what each conserves.
//!
//! One crate, so that the declarations are expanded once.

// The letters of the field.
#![allow(non_snake_case)]
// The tops are declared for the other tests too, in `common`.
#![allow(clippy::duplicate_mod)]

#[path = "../common/mod.rs"]
mod common;
#[path = "../../examples/declarations/mod.rs"]
mod declarations;

mod composition;
mod conditions;
mod convergence;
mod preprocessed;
mod splitting;
