//! The three ensembles of the example.

#![allow(missing_docs)] // an example

pub mod map;
pub mod satellite;
pub mod section;

/// What went wrong, in words.
pub type Mistake = Box<dyn std::error::Error>;
