//! Scenes from files: `read → choose → run → picture, page, table`.
//!
//! A file names a body, the effects on it, where the motion starts, the step or an accuracy, and what to draw and to
//! keep; those in `examples/scenes` show the keys, and [`SceneFile`] lists them. Files of several bodies are [`System`]s, and
//! [`Scene`] reads either. Numbers are in SI units, or texts with a
//! unit: `"30 deg"`. What is wrong in a file is reported with its line and column, as a [`Mistake`].
//!
//! ```
//! let text = r#"
//! title = "A wing nut in free flight"
//! [body]
//! moments = [1.0, 2.0, 2.5]
//! [start]
//! euler = [0, 0, 0]
//! velocity = [0.001, "2 rad/s", 0.001]
//! [run]
//! step = "20 ms"
//! duration = 80
//! "#;
//! let scene = liestep_scene::parse("wing-nut.toml", text)?;
//! let run = scene.run()?;
//! assert_eq!(run.samples().len(), 4001);
//! std::fs::write(std::env::temp_dir().join("wing-nut.html"), scene.page(&run))?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod body;
mod choose;
mod columns;
mod derivation;
mod document;
mod effects;
mod ensemble;
mod events;
mod file;
mod kinetic;
mod method;
mod mistake;
mod page;
mod picture;
mod quantity;
mod recording;
mod refused;
mod run;
mod start;
mod sweep;
mod switched;
mod system;
mod tables;

use std::fs::File;
use std::io::{self, Read as _};
use std::path::Path;

pub use columns::Column;
pub use derivation::{derivation, derived};
pub use document::parse;
pub use ensemble::{Drawn, Spread, Started};
pub use events::Happening;
pub use file::SceneFile;
pub use mistake::{Kind, Mistake};

pub use recording::Recording;
pub use run::{Run, Sample};
pub use sweep::Sweep;
pub use switched::Switched;
pub use system::{BodySample, Scene, System, SystemColumn, SystemRun, SystemSample};

/// A scene is a few hundred bytes; more than this is another file, and may have no end.
const MOST_BYTES: u64 = 1 << 20;

/// Reads the file of a scene with one body; [`Scene::read`] reads that of several, too.
///
/// # Errors
///
/// The first [`Mistake`] in it.
pub fn read(path: impl AsRef<Path>) -> Result<SceneFile, Mistake> {
    let path = path.as_ref();
    parse(path, &text(path)?)
}

/// What is in a file.
pub(crate) fn text(path: &Path) -> Result<String, Mistake> {
    let bytes = beginning(path).map_err(|cause| Mistake::unreadable(path, &cause))?;
    if bytes.len() as u64 > MOST_BYTES {
        return Err(Mistake::too_large(path, MOST_BYTES));
    }
    String::from_utf8(bytes).map_err(|error| Mistake::not_text(path, &error))
}

/// One byte more than the most, if there are so many.
fn beginning(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    File::open(path)?.take(MOST_BYTES + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}
