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
pub(crate) use run::table;

/// Reads a scene file.
pub(crate) fn read(path: &Path) -> Result<SceneFile, Mistake> {
    let text = fs::read_to_string(path).map_err(|cause| Mistake::unreadable(path, &cause))?;
    parse(path, &text)
}

/// The scene that a text describes; `path` is for messages.
pub(crate) fn parse(path: &Path, text: &str) -> Result<SceneFile, Mistake> {
    let file: SceneFile = toml::from_str(text).map_err(|error| Mistake::of_toml(path, text, &error))?;
    if let Some(span) = file.excess() {
        let message = format!("a scene has at most {} effects beside the body", choose::MOST_EFFECTS);
        return Err(Mistake::at(path, text, &span, message));
    }
    if let Some(span) = file.step_and_accuracy() {
        let message = "a run has either a `step` or an `accuracy`".to_owned();
        return Err(Mistake::at(path, text, &span, message));
    }
    if let Some((span, force)) = file.force_in_the_way() {
        let message =
            format!("an accuracy can be asked for in conservative scenes; {force} does work, so give a `step`");
        return Err(Mistake::at(path, text, &span, message));
    }
    Ok(file)
}
