//! The text of a model with those of the files that it includes.

use std::ops::Range;
use std::path::{Path, PathBuf};

use super::xml::{elements, parsed, place};
use crate::file::mistake::Mistake;
use crate::file::text::text;

/// The most bytes of a model with its parts.
const MOST_BYTES: usize = 1 << 23;

/// A model's text, in which elements `include` are replaced by what the file in them has inside of its root.
pub(super) struct Parts {
    text: String,
    files: Vec<PathBuf>,
    /// Pieces of files: the beginning of each in the text, the number of its file, and the piece's place there.
    pieces: Vec<(usize, usize, usize)>,
}

impl Parts {
    /// Reads a file and those that it includes, which are named from the folder of the first.
    pub(super) fn read(path: &Path) -> Result<Self, Mistake> {
        let mut parts = Self { text: String::new(), files: Vec::new(), pieces: Vec::new() };
        parts.add(path, path.parent().unwrap_or(Path::new("")), true)?;
        Ok(parts)
    }

    pub(super) fn text(&self) -> &str {
        &self.text
    }

    /// A mistake at a place of the text, in the file that has it.
    pub(super) fn mistake(&self, (row, column): (usize, usize), message: String) -> Mistake {
        let start = self.text.split_inclusive('\n').take(row - 1).map(str::len).sum::<usize>();
        let line = &self.text[start.min(self.text.len())..];
        let offset = start + line.char_indices().nth(column - 1).map_or(line.len(), |(at, _)| at);
        let piece = self.pieces.iter().rev().find(|(begin, _, _)| *begin <= offset);
        let Some(&(begin, file, at)) = piece.filter(|(_, file, _)| *file > 0 || self.files.len() > 1) else {
            let path = self.files.first().cloned().unwrap_or_default();
            return Mistake::at(&path, (row, column), message);
        };
        let path = &self.files[file];
        // The file was read a moment ago.
        let own = text(path).unwrap_or_default();
        let before = own.get(..at + offset - begin).unwrap_or("");
        let row = before.matches('\n').count() + 1;
        let column = before.rsplit('\n').next().unwrap_or("").chars().count() + 1;
        Mistake::at(path, (row, column), message)
    }

    /// Appends a file: all of it, or the inside of its root.
    fn add(&mut self, path: &Path, folder: &Path, is_whole: bool) -> Result<(), Mistake> {
        let own = text(path)?;
        let number = self.files.len();
        self.files.push(path.to_owned());
        let fail = |(place, message): ((usize, usize), String)| Mistake::at(path, place, message);
        let document = parsed(&own).map_err(fail)?;
        let root = document.root_element();
        let is_model = root.has_tag_name("mujoco") || !is_whole;
        let mut at =
            if is_whole { 0 } else { elements(&root).next().map_or(root.range().end, |first| first.range().start) };
        let end = if is_whole { own.len() } else { elements(&root).last().map_or(at, |last| last.range().end) };
        let includes = root.descendants().filter(|node| is_model && node.has_tag_name("include"));
        for include in includes {
            let Range { start, end } = include.range();
            self.piece(number, &own, at..start);
            at = end;
            let Some(file) = include.attribute("file") else {
                return Err(fail((place(&include), "an `include` has a `file`".to_owned())));
            };
            let inner = folder.join(file);
            if self.files.contains(&inner) {
                return Err(fail((place(&include), format!("`{file}` is included a second time"))));
            }
            if self.text.len() > MOST_BYTES {
                return Err(fail((
                    place(&include),
                    format!("a model with its parts has more than {MOST_BYTES} bytes"),
                )));
            }
            self.add(&inner, folder, false)?;
        }
        self.piece(number, &own, at..end);
        Ok(())
    }

    fn piece(&mut self, file: usize, own: &str, range: Range<usize>) {
        self.pieces.push((self.text.len(), file, range.start));
        self.text.push_str(&own[range]);
    }
}
