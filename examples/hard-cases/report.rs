//! The table, for the terminal and as Markdown.

use std::fmt::Write as _;

use crate::row::{Effort, Row};
use crate::rows;

/// The table for the terminal: a line for each row, and below it the results of the others.
pub fn text(rows: &[Row]) -> String {
    let mut text = String::new();
    for row in rows {
        let verdict = if row.is_met { "met   " } else { "MISSED" };
        // Writing to a string can't fail.
        let _ = writeln!(text, "{:<3} {verdict}  {}: {}", row.id, row.case, row.criterion);
        for measured in &row.ours {
            let _ = writeln!(text, "              {measured}");
        }
        for measured in &row.others {
            let _ = writeln!(text, "            · {measured}");
        }
    }
    let missed: Vec<_> = rows.iter().filter(|row| !row.is_met).map(|row| row.id).collect();
    let _ = write!(text, "\n{} of {} rows are met", rows.len() - missed.len(), rows.len());
    if !missed.is_empty() {
        let _ = write!(text, "; missed: {}", missed.join(", "));
    }
    text.push_str(".\nWhat other methods do is marked ·");
    text
}

/// The table in Markdown.
pub fn markdown(rows: &[Row]) -> String {
    let mut text = "| | case | criterion | measured | others | |\n|---|---|---|---|---|---|\n".to_owned();
    for row in rows {
        let cells = [row.id, row.case, row.criterion, &row.ours.join("; "), &row.others.join("; ")];
        let cells = cells.map(|cell| cell.replace('|', "\\|"));
        let verdict = if row.is_met { "met" } else { "missed" };
        let _ = writeln!(text, "| {} | {verdict} |", cells.join(" | "));
    }
    text
}

/// Measures a row by its id, prints it, and panics where its criterion is missed.
pub fn assert_met(id: &str, effort: Effort) {
    let (_, measure) = rows::ALL.into_iter().find(|row| row.0 == id).expect("an id of the table");
    let row = measure(effort).unwrap_or_else(|failure| panic!("{id}: {failure}"));
    let (is_met, text) = (row.is_met, text(&[row]));
    println!("{text}");
    assert!(is_met, "{text}");
}
