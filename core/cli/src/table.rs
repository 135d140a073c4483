//! A table of numbers, as it is printed.

use std::fmt::Write as _;

/// The most rows that are printed, and the most columns of letters.
const ROWS: usize = 40;
const WIDTH: usize = 110;

/// The head and the rows of a table in aligned columns, as many as are read at one sight; the others are in the file of this
/// name.
pub(crate) fn printed(head: &[&str], rows: &[Vec<String>], file: &str) -> String {
    let shown = &rows[..rows.len().min(ROWS)];
    let widths = (0..head.len()).map(|column| {
        let cells = shown.iter().filter_map(|row| row.get(column)).map(|cell| cell.chars().count());
        cells.chain([head[column].chars().count()]).max().unwrap_or_default() + 2
    });
    let widths: Vec<usize> = widths.collect();
    let ends = widths.iter().scan(0, |end, width| {
        *end += width;
        Some(*end)
    });
    let columns = ends.take_while(|end| *end <= WIDTH).count().max(1);
    let line = |cells: &mut dyn Iterator<Item = &str>| {
        let mut padded = String::new();
        for (cell, width) in cells.zip(&widths[..columns]) {
            let _ = write!(padded, "{cell:>width$}");
        }
        padded.trim_end().to_owned() + "\n"
    };
    let mut text = line(&mut head.iter().copied());
    text.extend(shown.iter().map(|row| line(&mut row.iter().map(String::as_str))));
    let (more_rows, more_columns) = (rows.len() - shown.len(), head.len() - columns);
    let more = [(more_rows, "rows"), (more_columns, "columns")].into_iter().filter(|(count, _)| *count > 0);
    let more: Vec<_> = more.map(|(count, what)| format!("{count} more {what}")).collect();
    if !more.is_empty() {
        let _ = writeln!(text, "  {} are in {file}", more.join(" and "));
    }
    text
}

/// A number with the digits that are read in a table.
pub(crate) fn digits(number: f64) -> String {
    let rounded = format!("{number:.5e}").parse().unwrap_or(number);
    let size = f64::abs(rounded);
    if size == 0.0 || (1e-4..1e7).contains(&size) { format!("{rounded}") } else { format!("{rounded:e}") }
}
