#![doc = include_str!("lib.md")]

mod runs;
mod table;
mod text;
mod timed;

pub use runs::{Reference, RefinementError, convergence};
pub use table::{Measurement, Refinement};
pub use timed::{Effort, work_precision};
