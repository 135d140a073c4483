//! Reading a file: its text, its tables, and then the tables that make several scenes of one.

use std::path::Path;

use toml::de::DeTable;

use crate::file::document;
use crate::file::mistake::{Lines, Mistake, SpanMessage};
use crate::file::scene::Scene;
use crate::file::tables::Document;
use crate::file::text::text;
use crate::file::{ensemble, sweep};

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
        let (path, lines) = (path.as_ref(), Lines::of(text));
        let located = |(span, message): SpanMessage| Mistake::at(path, lines.place(span.start), message);
        let mut document = DeTable::parse(text).map_err(|error| Mistake::of_toml(path, text, &error))?;
        let [sweep, drawn] = ["sweep", "ensemble"].map(|table| document.get_mut().remove(table));
        let read = |document: &Document<'_>| document::scene(path, text, document).map(Self::from);
        let mut scene = read(&document)?;
        if let Some(table) = sweep {
            scene.sweep = Some(Box::new(sweep::read(&document, &table, &located, &read)?));
        }
        if let Some(table) = drawn {
            scene.ensemble = Some(Box::new(ensemble::read((path, text), &document, &table, &scene)?));
        }
        Ok(scene)
    }
}
