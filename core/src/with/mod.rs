//! Wrappers of a method: compensated sums, prescribed values, steps of varying length, remedies for steps without a
//! solution, checkpoints; and a method with its wrappers as a value, a [`Method`].
//!
//! Each can be combined with every method for which it makes sense, and with the others.

#[cfg(feature = "serde")]
mod checkpoint;
mod clock;
mod compensated;
pub mod densities;
mod density;
mod driven;
mod kepler;
mod method;
mod orbit;
mod pace;
mod remedies;
mod varied;

#[cfg(feature = "serde")]
pub use checkpoint::{Checkpoint, CheckpointError, Storable};
pub use clock::Clock;
pub use compensated::{Carry, Compensable, CompensatedSums};
#[doc(hidden)]
pub use density::Density;
pub use driven::Driven;
pub use kepler::Kepler;
pub use method::{Method, Scheme, Stages, Steppable, UnknownMethod};
pub use pace::Pacable;
#[doc(hidden)]
pub use pace::PacedStep;
pub use remedies::Substeps;
#[doc(hidden)]
pub use varied::{Lengths, VariedSteps};
