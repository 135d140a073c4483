//! The hard cases: for each a measurement, and its bound.

// Public items need no full documentation, as only this repository uses them.
#![allow(missing_docs, clippy::missing_errors_doc, clippy::missing_panics_doc)]
#![allow(clippy::must_use_candidate, clippy::return_self_not_must_use)]

mod closed;
mod engines;
mod poisson;
pub mod report;
mod rivals;
pub mod row;
pub mod rows;
mod walk;
