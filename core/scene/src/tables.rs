//! Numbers and tables as text.

use std::fmt::Write as _;

/// A number as a person would write it, without the rounding errors of the last digits.
pub(crate) fn short(value: f64) -> String {
    // Debug has an exponent where there would be many zeros, and a point where there needn't be one.
    let text = format!("{:?}", format!("{value:.9e}").parse::<f64>().unwrap_or(value));
    text.strip_suffix(".0").map(str::to_owned).unwrap_or(text)
}

/// Comma-separated values: names without commas or quotes, then numbers to their last digit.
pub(crate) fn csv(names: &[&str], rows: impl Iterator<Item = Vec<f64>>) -> String {
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
