//! Comma-separated values.

use core::fmt::Write as _;
use std::fs::File;
use std::io::{self, Write};
use std::path::Path;

use super::{Column, RecordError, Sink, SinkError};

/// A table as comma-separated values (RFC 4180, with line feeds): a line of names, then a line for each row.
///
/// Numbers have as few digits as tell them from all others, so that they are read back to the bit. What isn't a number is
/// `NaN`, `inf` and `-inf`, as Python, Julia and MATLAB read them. Units aren't written: they are in the documentation of
/// [`Recorder`](super::Recorder).
#[derive(Debug)]
pub struct Csv<W: Write> {
    writer: W,
    columns: usize,
    text: String,
}

impl Csv<File> {
    /// Writes to this file, in the place of what was there.
    ///
    /// # Errors
    ///
    /// Where the file can't be made.
    pub fn create(path: impl AsRef<Path>) -> io::Result<Self> {
        File::create(path).map(Self::new)
    }
}

impl<W: Write> Csv<W> {
    /// Writes to anything; a block of rows is written at once, so that it needn't be buffered.
    pub fn new(writer: W) -> Self {
        Self { writer, columns: 1, text: String::new() }
    }

    /// What was written to.
    ///
    /// # Errors
    ///
    /// Where it doesn't take what was written.
    pub fn into_inner(mut self) -> Result<W, RecordError> {
        self.writer.flush().map_err(|cause| RecordError::Sink { cause: cause.into() })?;
        Ok(self.writer)
    }

    fn write_text(&mut self) -> Result<(), SinkError> {
        let written = self.writer.write_all(self.text.as_bytes());
        self.text.clear();
        Ok(written?)
    }
}

impl<W: Write> Sink for Csv<W> {
    fn begin(&mut self, columns: &[Column]) -> Result<(), SinkError> {
        self.columns = columns.len().max(1);
        for (place, column) in columns.iter().enumerate() {
            self.text.push_str(if place == 0 { "" } else { "," });
            if column.name.contains([',', '"', '\n', '\r']) {
                write!(self.text, "\"{}\"", column.name.replace('"', "\"\""))?;
            } else {
                self.text.push_str(&column.name);
            }
        }
        self.text.push('\n');
        self.write_text()
    }

    fn write(&mut self, rows: &[f64]) -> Result<(), SinkError> {
        for row in rows.chunks_exact(self.columns) {
            for (place, number) in row.iter().enumerate() {
                let comma = if place == 0 { "" } else { "," };
                write!(self.text, "{comma}{number:?}")?;
            }
            self.text.push('\n');
        }
        self.write_text()
    }

    fn end(&mut self) -> Result<(), SinkError> {
        Ok(self.writer.flush()?)
    }
}
