//! Observed runs: recording, stopping, and events.
//!
//! A [`Run`] calls observers with the motion: every `n` steps, at requested times, at events. A [`Recorder`] is such an
//! observer, whose rows go to a [`Sink`]. [`Frames`] has the motion at the times of a renderer. All of it takes any
//! [`Integrator`](crate::motion::Integrator), and so any method.

// The first module is the first on the documentation's page.
mod run;

#[cfg(feature = "std")]
mod background;
mod crossing;
#[cfg(feature = "std")]
mod csv;
mod error;
mod event;
mod frames;
mod observer;
mod recorder;
pub mod sections;
mod table;

#[cfg(feature = "std")]
pub use background::Background;
#[cfg(feature = "std")]
pub use csv::Csv;
pub use error::{Reason, RunError, RunReport};
pub use event::Event;
pub use frames::Frames;
pub use recorder::{Column, RecordError, Recorder, Sink, SinkError};
pub use run::Run;
pub use table::Table;
