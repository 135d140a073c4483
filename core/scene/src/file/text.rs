//! The text of a file, and texts that are shown.

use std::fs::File;
use std::io::{self, Read as _};
use std::path::Path;

use serde::{Deserialize as _, Deserializer};

use crate::file::mistake::{Mistake, visible};

/// A scene is a few hundred bytes; more than this is another file, and may have no end.
const MOST_BYTES: u64 = 1 << 20;

/// What is in a file.
pub(crate) fn text(path: &Path) -> Result<String, Mistake> {
    let bytes = beginning(path).map_err(|cause| Mistake::unreadable(path, &cause))?;
    if bytes.len() as u64 > MOST_BYTES {
        return Err(Mistake::too_large(path, MOST_BYTES));
    }
    String::from_utf8(bytes).map_err(|error| Mistake::not_text(path, &error))
}

/// The file up to one byte more than the most.
fn beginning(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    File::open(path)?.take(MOST_BYTES + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// A title in one line with its control characters written out: a terminal would obey them, and SVG has no room for them.
pub(crate) fn title<'de, D: Deserializer<'de>>(deserializer: D) -> Result<String, D::Error> {
    String::deserialize(deserializer).map(|title| visible(&title).replace('\n', "\\n").replace('\t', "\\t"))
}
