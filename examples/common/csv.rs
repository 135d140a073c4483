//! Series as comma-separated values: a line of names, then numbers to their last digit.

use std::fmt::Write as _;

/// One line for every row; the names contain neither commas nor quotes, and numbers need no quoting.
pub fn table<const N: usize>(names: [&str; N], rows: impl Iterator<Item = [f64; N]>) -> String {
    let mut text = names.join(",");
    text.push('\n');
    for row in rows {
        for (column, value) in row.into_iter().enumerate() {
            let comma = if column == 0 { "" } else { "," };
            // Writing to a string can't fail.
            let _ = write!(text, "{comma}{value:e}");
        }
        text.push('\n');
    }
    text
}
