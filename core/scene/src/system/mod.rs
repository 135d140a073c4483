//! Several bodies from a file: those of its tables `[[body]]`, with what is between them.

mod columns;
mod file;
mod held;
mod picture;
mod run;
mod springs;

use std::path::Path;

use toml::de::{DeTable, DeValue};

pub use columns::SystemColumn;
pub use file::System;
pub use run::{BodySample, SystemRun, SystemSample};

use crate::document::parse;
use crate::file::SceneFile;
use crate::mistake::Mistake;

/// What a file has: one body, or several.
#[derive(Clone)]
pub enum Scene {
    /// With a table `[body]`.
    Body(Box<SceneFile>),
    /// With tables `[[body]]`.
    System(Box<System>),
}

impl Scene {
    /// Reads a file.
    ///
    /// # Errors
    ///
    /// The first [`Mistake`] in it.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, Mistake> {
        let path = path.as_ref();
        Self::parse(path, &crate::text(path)?)
    }

    /// The scene that a text describes; `path` is for messages.
    ///
    /// # Errors
    ///
    /// The first [`Mistake`] in it.
    pub fn parse(path: impl AsRef<Path>, text: &str) -> Result<Self, Mistake> {
        let path = path.as_ref();
        let document = DeTable::parse(text).map_err(|error| Mistake::of_toml(path, text, &error))?;
        if has_several(document.get_ref()) {
            System::parse(path, text).map(|system| Self::System(Box::new(system)))
        } else {
            parse(path, text).map(|scene| Self::Body(Box::new(scene)))
        }
    }
}

/// Whether its bodies are listed.
pub(crate) fn has_several(document: &DeTable<'_>) -> bool {
    document.get("body").is_some_and(|body| matches!(body.get_ref(), DeValue::Array(_)))
}
