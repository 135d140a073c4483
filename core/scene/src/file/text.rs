//! The text of a file, and titles for display.

use std::fs::File;
use std::io::{self, Read as _};
use std::path::Path;

use serde::{Deserialize as _, Deserializer};

use crate::file::mistake::{Mistake, visible};

/// Most bytes of a scene, which has a few hundred. A larger file is no scene, and may have no end.
const MOST_BYTES: u64 = 1 << 20;

/// The text of a file.
pub(crate) fn text(path: &Path) -> Result<String, Mistake> {
    let bytes = beginning(path).map_err(|cause| Mistake::unreadable(path, &cause))?;
    if bytes.len() as u64 > MOST_BYTES {
        return Err(Mistake::too_large(path, MOST_BYTES));
    }
    String::from_utf8(bytes).map_err(|error| Mistake::not_text(path, &error))
}

/// The bytes of the file, up to one more than the most.
fn beginning(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    File::open(path)?.take(MOST_BYTES + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Checks a name that is the prefix of columns, or that of one.
pub(crate) fn check_name(of: &str, name: &str) -> Result<(), String> {
    let is_plain = !name.is_empty() && name.chars().all(|letter| letter.is_alphanumeric() || "_-".contains(letter));
    if is_plain {
        return Ok(());
    }
    let like = |letter: char| if letter.is_alphanumeric() || letter == '-' { letter } else { '_' };
    let plain: String = name.chars().map(like).collect();
    let advice = if plain.is_empty() { String::new() } else { format!(": write `{plain}`") };
    Err(format!("the `name` of {of} has letters, digits, - and _ only, as keys and columns are made with it{advice}"))
}

/// A title, or the name of the file where there is none.
pub(crate) fn or_name(title: String, path: &Path) -> String {
    if title.is_empty() { path.file_stem().map_or(title, |name| one_line(&name.to_string_lossy())) } else { title }
}

/// A text in one line with its control characters written out.
fn one_line(text: &str) -> String {
    visible(text).replace('\n', "\\n").replace('\t', "\\t")
}

/// A title in one line with its control characters written out. A terminal would obey them, and SVG doesn't allow them.
pub(crate) fn title<'de, D: Deserializer<'de>>(deserializer: D) -> Result<String, D::Error> {
    String::deserialize(deserializer).map(|title| one_line(&title))
}
