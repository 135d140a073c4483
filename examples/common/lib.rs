//! Code that examples, tests and benchmarks share: the heavy top and its rivals, arguments, timed runs, tables, files
//! and figures.
//!
//! Code for the longer examples and the tests alone is in other packages, so that the first example builds fast.

// Public items need no full documentation, as only this repository uses them.
#![allow(missing_docs, clippy::missing_errors_doc, clippy::missing_panics_doc)]
#![allow(clippy::must_use_candidate, clippy::return_self_not_must_use)]

pub mod args;
pub mod double_double;
pub mod drawing;
pub mod heavy_top;
pub mod measure;
pub mod newton_tolerance;
pub mod progress;
pub mod run;
pub mod runge_kutta;
pub mod table;
mod tenths;
pub mod top_equations;
pub mod variational;

pub use liestep_plot as plot;
pub use liestep_plot::output;
