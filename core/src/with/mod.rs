//! What is put around a method: compensated sums, remedies for steps without a solution, checkpoints.

#[cfg(feature = "serde")]
mod checkpoint;
mod compensated;
mod remedies;

#[cfg(feature = "serde")]
pub use checkpoint::{Checkpoint, CheckpointError, Stored};
pub use compensated::{CompensatedState, CompensatedStepper};
pub use remedies::{Fallback, OnFailure, RemediedStepper, Remedy, Substeps};
