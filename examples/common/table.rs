//! Aligned columns for the terminal.

/// The rows below each other, the first column left and the others right aligned, with a rule below the first row.
pub fn aligned(rows: &[Vec<String>]) -> String {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |column: usize| {
        rows.iter().filter_map(|row| row.get(column)).map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let mut lines: Vec<String> = rows
        .iter()
        .map(|row| {
            let cells = row.iter().zip(&widths).enumerate();
            let cells = cells.map(|(i, (cell, &w))| if i == 0 { format!("{cell:<w$}") } else { format!("{cell:>w$}") });
            cells.collect::<Vec<_>>().join("  ")
        })
        .collect();
    let rule = widths.iter().map(|&w| "─".repeat(w)).collect::<Vec<_>>().join("  ");
    lines.insert(lines.len().min(1), rule);
    lines.join("\n")
}

/// A measured number with two digits, or the words "not finite".
pub fn number(value: f64) -> String {
    if value.is_finite() { format!("{value:.1e}") } else { "not finite".to_owned() }
}

/// A number in its usual notation, without the rounding errors of the last digits.
pub fn short(value: f64) -> String {
    // Debug has an exponent in place of many zeros, but also appends `.0` to integers.
    let text = format!("{:?}", format!("{value:.9e}").parse::<f64>().unwrap_or(value));
    text.strip_suffix(".0").map(str::to_owned).unwrap_or(text)
}
