//! Scenes with exact states, their methods, and the time of each method to an accuracy.

// Public items need no full documentation, as only this repository uses them.
#![allow(missing_docs, clippy::missing_errors_doc, clippy::missing_panics_doc)]
#![allow(clippy::must_use_candidate, clippy::return_self_not_must_use)]

pub mod asked;
pub mod figure;
pub mod measure;
pub mod methods;
pub mod report;
pub mod rivals;
pub mod scenes;
