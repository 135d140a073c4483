//! Refinements as tables, as CSV and as JSON.

use std::fmt::{self, Write as _};

use crate::table::{Measurement, Refinement};

/// The columns, and their names in tables.
const COLUMNS: [(&str, &str); 6] = [
    ("step", "h, s"),
    ("error", "error"),
    ("ratio", "ratio"),
    ("order", "order"),
    ("iterations", "iterations"),
    ("seconds", "time, µs"),
];

type Row = [Option<f64>; COLUMNS.len()];

impl Refinement {
    fn lines(&self) -> impl Iterator<Item = Row> + '_ {
        let none = std::iter::once(None);
        let ratios = none.clone().chain(self.ratios().map(Some));
        let orders = none.chain(self.orders().map(Some));
        self.rows().iter().zip(ratios.zip(orders)).map(|(row, (ratio, order))| {
            let Measurement { step, error, iterations, seconds } = *row;
            [Some(step), Some(error), ratio, order, iterations, seconds]
        })
    }

    /// A line of names, then a line for each run. Numbers have as few digits as distinguish them from all others.
    #[must_use]
    pub fn to_csv(&self) -> String {
        let mut text = COLUMNS.map(|(name, _)| name).join(",");
        text.push('\n');
        for line in self.lines() {
            for (place, number) in line.into_iter().enumerate() {
                text.push_str(if place == 0 { "" } else { "," });
                if let Some(number) = number {
                    // Writing to a string can't fail.
                    let _ = write!(text, "{number:?}");
                }
            }
            text.push('\n');
        }
        text
    }

    /// An array with an object for each run. Numbers that aren't finite are `null`, as JSON has no other word for them.
    #[must_use]
    pub fn to_json(&self) -> String {
        let mut text = String::from("[");
        for (place, line) in self.lines().enumerate() {
            text.push_str(if place == 0 { "{" } else { ",{" });
            for (place, ((name, _), number)) in COLUMNS.iter().zip(line).enumerate() {
                text.push_str(if place == 0 { "" } else { "," });
                // Writing to a string can't fail.
                let _ = match number.filter(|number| number.is_finite()) {
                    Some(number) => write!(text, "\"{name}\":{number:?}"),
                    None => write!(text, "\"{name}\":null"),
                };
            }
            text.push('}');
        }
        text.push(']');
        text
    }
}

/// Serialises as [`Refinement::to_json`] does.
#[cfg(feature = "serde")]
impl serde::Serialize for Refinement {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        struct Line(Row);

        impl serde::Serialize for Line {
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                serializer.collect_map(COLUMNS.iter().map(|(name, _)| name).zip(self.0))
            }
        }

        serializer.collect_seq(self.lines().map(Line))
    }
}

/// Writes a table; empty columns are left out.
impl fmt::Display for Refinement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let lines: Vec<Row> = self.lines().collect();
        let is_there = |column: usize| column < 2 || lines.iter().any(|line| line[column].is_some());
        for (column, (_, heading)) in COLUMNS.iter().enumerate().filter(|(column, _)| is_there(*column)) {
            write!(f, " {heading:>width$}", width = width(column))?;
        }
        for line in &lines {
            writeln!(f)?;
            for (column, number) in line.iter().enumerate().filter(|(column, _)| is_there(*column)) {
                let cell = number.map_or_else(|| "–".to_owned(), |number| cell(column, number));
                write!(f, " {cell:>width$}", width = width(column))?;
            }
        }
        Ok(())
    }
}

fn width(column: usize) -> usize {
    // A space precedes each column; the longest heading has ten letters.
    if column == 4 { 11 } else { 9 }
}

fn cell(column: usize, number: f64) -> String {
    match column {
        0 => format!("{number:.3e}"),
        1 => format!("{number:.2e}"),
        5 => format!("{:.1}", 1e6 * number),
        _ => format!("{number:.2}"),
    }
}
