//! Scenes from files: `read → choose → run → picture`.

mod choose;
mod effects;
mod file;
mod mistake;
mod picture;
mod quantity;
mod refused;
mod run;
mod start;

use std::fs::File;
use std::io::{self, Read as _};
use std::path::Path;

pub(crate) use choose::run;
pub(crate) use file::SceneFile;
pub(crate) use mistake::Mistake;
pub(crate) use picture::picture;
pub(crate) use run::table;

/// A scene is a few hundred bytes; more than this is another file, and may have no end.
const MOST_BYTES: u64 = 1 << 20;

/// Reads a scene file.
pub(crate) fn read(path: &Path) -> Result<SceneFile, Mistake> {
    let bytes = beginning(path).map_err(|cause| Mistake::unreadable(path, &cause))?;
    if bytes.len() as u64 > MOST_BYTES {
        return Err(Mistake::too_large(path, MOST_BYTES));
    }
    let text = String::from_utf8(bytes).map_err(|error| Mistake::not_text(path, &error))?;
    parse(path, &text)
}

/// One byte more than the most, if there are so many.
fn beginning(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    File::open(path)?.take(MOST_BYTES + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// The scene that a text describes; `path` is for messages.
pub(crate) fn parse(path: &Path, text: &str) -> Result<SceneFile, Mistake> {
    let file: SceneFile = toml::from_str(text).map_err(|error| Mistake::of_toml(path, text, &error))?;
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
