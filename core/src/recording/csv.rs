//! Comma-separated values.

use alloc::string::String;
use core::fmt::Write as _;
use std::fs::File;
use std::io::{self, Write};
use std::path::Path;

use super::recorder::{Column, RecordError, Sink, SinkError};

/// A table as comma-separated values (RFC 4180, with line feeds): a line of names, then a line for each row.
///
/// Numbers have the fewest digits that identify them, so that they are read back to the bit. Infinities and NaN are
/// `NaN`, `inf` and `-inf`, as Python, Julia and MATLAB read them. Units aren't written: they are in the documentation
/// of [`Recorder`](super::Recorder).
#[derive(Debug)]
pub struct Csv<W: Write> {
    writer: W,
    columns: usize,
    text: String,
}

impl Csv<File> {
    /// Writes to this file, and replaces its content.
    ///
    /// # Errors
    ///
    /// If the file can't be created.
    pub fn create(path: impl AsRef<Path>) -> io::Result<Self> {
        File::create(path).map(Self::new)
    }
}

impl<W: Write> Csv<W> {
    /// Writes to any writer, one call for each block of rows, so that it needn't be buffered.
    pub fn new(writer: W) -> Self {
        Self { writer, columns: 1, text: String::new() }
    }

    /// Returns the writer.
    ///
    /// # Errors
    ///
    /// If the writer can't be flushed.
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
        let mut digits = zmij::Buffer::new();
        for row in rows.chunks_exact(self.columns) {
            for (place, &number) in row.iter().enumerate() {
                if place > 0 {
                    self.text.push(',');
                }
                if is_written_alike(number) {
                    self.text.push_str(digits.format_finite(number));
                } else {
                    write!(self.text, "{number:?}")?;
                }
            }
            self.text.push('\n');
        }
        self.write_text()
    }

    fn end(&mut self) -> Result<(), SinkError> {
        Ok(self.writer.flush()?)
    }
}

/// Whether the faster formatter has the same notation as the standard library; elsewhere its exponent is written
/// differently.
#[inline]
fn is_written_alike(number: f64) -> bool {
    let size = number.abs();
    size < 1e-5 || (1e-4..1e16).contains(&size)
}

#[cfg(test)]
mod tests {
    use super::{Column, Csv, Sink as _};
    use alloc::format;
    use alloc::string::String;
    use alloc::vec::Vec;

    /// Both formatters write the standard library's form to the bit: at the ends of their ranges, for numbers of all
    /// sizes, for infinities and NaN.
    #[test]
    fn numbers_are_written_as_debug_writes_them() {
        let ends = [0.0, 1e-5, 1e-4, 1e16].map(|end: f64| [end.next_down(), end, end.next_up()]);
        let others = [f64::MIN_POSITIVE, f64::MAX, f64::INFINITY, f64::NAN, 0.1, 1e15, 5e-324];
        let mut bits = 0x9e37_79b9_7f4a_7c15_u64;
        let random = core::iter::repeat_with(|| {
            bits ^= bits << 13;
            bits ^= bits >> 7;
            bits ^= bits << 17;
            f64::from_bits(bits)
        });
        let near_one = (1..10_000).map(|k| f64::from(k).sqrt() * 1e-7);
        let numbers: Vec<f64> = ends.as_flattened().iter().copied().chain(others).chain(near_one).collect();
        let numbers = numbers.into_iter().chain(random.take(100_000)).flat_map(|number| [number, -number]);
        let numbers: Vec<f64> = numbers.collect();
        let mut csv = Csv::new(Vec::new());
        csv.begin(&[Column { name: "x".into(), unit: String::new() }]).unwrap();
        csv.write(&numbers).unwrap();
        let text = String::from_utf8(csv.into_inner().unwrap()).unwrap();
        assert_eq!(text.lines().count(), numbers.len() + 1);
        for (written, number) in text.lines().skip(1).zip(&numbers) {
            let debug = format!("{number:?}");
            // Either of two texts of one length is right if both are as near: `1.0000076293945313` is 1 + 2⁻¹⁷, and so
            // is …312.
            let is_other = written.len() == debug.len() && written.parse() == Ok(*number);
            assert!(
                written == debug || is_other && written[..written.len() - 3] == debug[..debug.len() - 3],
                "{debug}"
            );
        }
    }
}
