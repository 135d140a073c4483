//! A mistake in a scene file, with its place.

use std::fmt;
use std::io;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::string::FromUtf8Error;

/// What is wrong, and where.
#[derive(Debug)]
pub(crate) struct Mistake {
    path: PathBuf,
    /// Line and column, from one; none where there is no text.
    place: Option<(usize, usize)>,
    message: String,
}

impl Mistake {
    pub(crate) fn unreadable(path: &Path, cause: &io::Error) -> Self {
        Self { path: path.to_owned(), place: None, message: format!("cannot be read: {cause}") }
    }

    pub(crate) fn too_large(path: &Path, most: u64) -> Self {
        let message = format!("has more than {most} bytes, so it is no scene");
        Self { path: path.to_owned(), place: None, message }
    }

    /// At the first byte that belongs to no character.
    pub(crate) fn not_text(path: &Path, error: &FromUtf8Error) -> Self {
        let (before, _) = error.as_bytes().split_at(error.utf8_error().valid_up_to());
        let before = String::from_utf8_lossy(before);
        let place = Some(place(&before, before.len()));
        Self { path: path.to_owned(), place, message: "isn't a text in UTF-8".to_owned() }
    }

    pub(crate) fn of_toml(path: &Path, text: &str, error: &toml::de::Error) -> Self {
        let place = error.span().map(|span| place(text, span.start));
        Self { path: path.to_owned(), place, message: error.message().to_owned() }
    }

    pub(crate) fn at(path: &Path, text: &str, span: &Range<usize>, message: String) -> Self {
        Self { path: path.to_owned(), place: Some(place(text, span.start)), message }
    }
}

/// Line and column, in characters, of a byte.
fn place(text: &str, offset: usize) -> (usize, usize) {
    let before = text.get(..offset).unwrap_or(text);
    let line = before.rsplit('\n').next().unwrap_or("");
    (before.matches('\n').count() + 1, line.chars().count() + 1)
}

impl fmt::Display for Mistake {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:", self.path.display())?;
        if let Some((line, column)) = self.place {
            write!(f, "{line}:{column}:")?;
        }
        write!(f, " {}", self.message)
    }
}

impl std::error::Error for Mistake {}
