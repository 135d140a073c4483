//! What the tests share: declared Lagrangians, reference data, random states, order estimates.

// A library of this repository alone.
#![allow(missing_docs, clippy::missing_errors_doc, clippy::missing_panics_doc)]
#![allow(clippy::must_use_candidate, clippy::return_self_not_must_use)]

pub mod affine;
pub mod any_scalar;
pub mod drift;
pub mod examples;
pub mod order;
pub mod orders;
pub mod random;
pub mod solvers;
pub mod structure;
