//! What is put around a method: compensated sums, remedies for steps without a solution, checkpoints; runs that are
//! observed, recorded and stopped, and events in them.
//!
//! Each goes with every method for which it makes sense, and with each other.

#[cfg(feature = "serde")]
mod checkpoint;
mod compensated;
mod frames;
mod record;
mod remedies;
mod run;
pub mod sections;

#[cfg(feature = "serde")]
pub use checkpoint::{Checkpoint, CheckpointError, Stored};
pub use compensated::{Carried, Compensable, Compensated};
pub use frames::Frames;
#[cfg(feature = "std")]
pub use record::{Background, Csv};
pub use record::{Column, RecordError, Recorder, Sink, SinkError, Table};
pub use remedies::{Instead, OrElse, Substeps};
pub use run::{Event, Reason, Run, RunError, RunReport};
