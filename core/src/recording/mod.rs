//! Runs that are observed, recorded and stopped, and the events in them.
//!
//! A [`Run`] shows the motion to observers: every `n` steps, at given times, at events. A [`Recorder`] is such an
//! observer, whose rows go to a [`Sink`]. [`Frames`] shows it at the times of a renderer. All of it is written for an
//! [`Integrator`](crate::motion::Integrator), and so goes with every method.

// First, as on its page in the documentation.
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
