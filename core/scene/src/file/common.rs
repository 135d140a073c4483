//! The common part of all files of scenes, whatever is in them.

use std::path::Path;

use crate::file::column::{Column, Output};
use crate::file::schedule::Schedule;

/// Everything that scenes of both kinds read from their files.
pub(crate) trait Parts: Clone {
    fn title(&self) -> &str;

    fn schedule(&self) -> &Schedule;

    fn schedule_mut(&mut self) -> &mut Schedule;

    fn columns(&self) -> &[Column];

    fn output(&self) -> &Output;

    fn path(&self) -> &Path;

    /// The names of the events.
    fn event_names(&self) -> Vec<&str>;

    /// A description of the terms, in words.
    fn sum(&self) -> String;

    /// A description of the terms and the steps, in words.
    fn about(&self) -> String;

    /// Whether the steps have different lengths.
    fn has_steps_of_its_own(&self) -> bool {
        false
    }

    /// This scene without events.
    fn unwatched(self) -> Self;
}
