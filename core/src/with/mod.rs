//! What is put around a method: compensated sums, values given to each step, remedies for steps
//! without a solution, checkpoints.
//!
//! Each goes with every method for which it makes sense, and with each other.

#[cfg(feature = "serde")]
mod checkpoint;
mod compensated;
mod driven;
mod remedies;

#[cfg(feature = "serde")]
pub use checkpoint::{Checkpoint, CheckpointError, Storable};
pub use compensated::{Compensable, Compensated, MemoryWithCarry};
pub use driven::Driven;
pub use remedies::Substeps;
