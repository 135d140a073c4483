//! The three ensembles of the example.

#![allow(missing_docs)] // an example

pub mod map;
pub mod satellite;
pub mod section;

/// An error as a message for the user.
pub type Mistake = Box<dyn std::error::Error>;
