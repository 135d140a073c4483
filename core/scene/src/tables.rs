//! Numbers as text.

/// A number as a person would write it, without the rounding errors of the last digits.
pub(crate) fn short(value: f64) -> String {
    // Debug has an exponent where there would be many zeros, and a point where there needn't be one.
    let text = format!("{:?}", format!("{value:.9e}").parse::<f64>().unwrap_or(value));
    text.strip_suffix(".0").map(str::to_owned).unwrap_or(text)
}
