//! Reading a file: its text, its tables, and then the tables that make several scenes of one.

use std::path::Path;

use toml::de::{DeTable, DeValue};

use crate::file::document::scene;
use crate::file::mistake::{Mistake, SpanMessage, place_of};
use crate::file::scene::SceneFile;
use crate::file::system::System;
use crate::file::tables::{Document, span};
use crate::file::text::text;
use crate::file::{ensemble, sweep};

/// The scene of a file: one body, or several.
#[derive(Clone)]
pub enum Scene {
    /// One body, from a table `[body]`.
    Body(Box<SceneFile>),
    /// Several bodies, from tables `[[body]]`.
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
        Self::parse(path, &text(path)?)
    }

    /// Parses the scene of a text; `path` appears in messages.
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

/// Reads the file of a scene with one body; [`Scene::read`] also reads files of several bodies.
///
/// # Errors
///
/// The first [`Mistake`] in it.
pub fn read(path: impl AsRef<Path>) -> Result<SceneFile, Mistake> {
    let path = path.as_ref();
    parse(path, &text(path)?)
}

/// Parses the scene of a text; `path` appears in messages.
///
/// # Errors
///
/// The first [`Mistake`] in it.
pub fn parse(path: impl AsRef<Path>, text: &str) -> Result<SceneFile, Mistake> {
    let path = path.as_ref();
    let located = |(span, message): SpanMessage| Mistake::at(path, place_of(text, &span), message);
    let mut document = DeTable::parse(text).map_err(|error| Mistake::of_toml(path, text, &error))?;
    if has_several(document.get_ref()) {
        let message = "the file has several bodies, and ensembles are of one body: `liestep run` runs it".to_owned();
        return Err(located((span(&document, &["body"]), message)));
    }
    let [sweep, drawn] = ["sweep", "ensemble"].map(|table| document.get_mut().remove(table));
    let read = |document: &Document<'_>| scene(path, text, document);
    let mut file = read(&document)?;
    if let Some(table) = sweep {
        file.sweep = Some(sweep::read(&document, &table, &located, &read)?);
    }
    if let Some(table) = drawn {
        file.ensemble = Some(ensemble::read((path, text), &document, &table, &file)?);
    }
    Ok(file)
}

/// Whether the document lists several bodies.
fn has_several(document: &DeTable<'_>) -> bool {
    document.get("body").is_some_and(|body| matches!(body.get_ref(), DeValue::Array(_)))
}
