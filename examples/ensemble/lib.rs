//! The two ensembles of the example.

#![allow(missing_docs)] // an example

pub mod map;
pub mod satellite;

/// What went wrong, in words.
pub type Mistake = Box<dyn std::error::Error>;
