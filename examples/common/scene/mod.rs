//! Scenes from files: `read → choose → run → picture`.

mod choose;
mod effects;
mod file;
mod mistake;
mod picture;
mod quantity;
mod run;
mod start;

use std::fs;
use std::path::Path;

pub(crate) use choose::run;
pub(crate) use file::SceneFile;
pub(crate) use mistake::Mistake;
pub(crate) use picture::picture;
pub(crate) use run::{summary, table};

/// Reads a scene file.
pub(crate) fn read(path: &Path) -> Result<SceneFile, Mistake> {
    let text = fs::read_to_string(path).map_err(|cause| Mistake::unreadable(path, &cause))?;
    parse(path, &text)
}

/// The scene that a text describes; `path` is for messages.
pub(crate) fn parse(path: &Path, text: &str) -> Result<SceneFile, Mistake> {
    let file: SceneFile = toml::from_str(text).map_err(|error| Mistake::of_toml(path, text, &error))?;
    match file.excess() {
        Some(span) => {
            let message = format!("a scene has at most {} effects beside the body", choose::MOST_EFFECTS);
            Err(Mistake::at(path, text, &span, message))
        }
        None => Ok(file),
    }
}
