//! Code that the tests share: declared Lagrangians, reference data, random states, order estimates.

// Public items need no full documentation, as only tests of this repository use them.
#![allow(missing_docs, clippy::missing_errors_doc, clippy::missing_panics_doc)]
#![allow(clippy::must_use_candidate, clippy::return_self_not_must_use)]

pub mod affine;
pub mod any_scalar;
pub mod continuous;
pub mod drift;
pub mod examples;
pub mod free_body;
pub mod limit;
pub mod order;
pub mod orders;
pub mod random;
pub mod samples;
pub mod solvers;
pub mod structure;

#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
struct Readme;
