//! Linear equations of a few unknowns.

use super::Value;

/// A pivot this small, relative to the largest entry, is rounding.
const SMALLEST_PIVOT: f64 = 1e-10;

/// Gauss' elimination with complete pivoting: `A⁻¹ b`, none for a singular `A`.
pub(super) fn solve(a: &Value, b: &Value) -> Option<Value> {
    let size = a.rows;
    let mut rows: Vec<Vec<f64>> = (0..size)
        .map(|row| {
            (0..size).map(|column| a.at(row, column)).chain((0..b.columns).map(|column| b.at(row, column))).collect()
        })
        .collect();
    let largest = a.entries.iter().fold(0.0_f64, |largest, entry| largest.max(entry.abs()));
    // Where each unknown's equation has gone.
    let mut solved: Vec<(usize, usize)> = Vec::new();
    for _ in 0..size {
        let open = |at: &(usize, usize)| solved.iter().all(|done| done.0 != at.0 && done.1 != at.1);
        let places = (0..size).flat_map(|row| (0..size).map(move |column| (row, column))).filter(open);
        let (row, column) = places.max_by(|x, y| rows[x.0][x.1].abs().total_cmp(&rows[y.0][y.1].abs()))?;
        let pivot = rows[row].clone();
        // Not finite isn't regular either.
        if pivot[column].abs().partial_cmp(&(SMALLEST_PIVOT * largest)) != Some(std::cmp::Ordering::Greater) {
            return None;
        }
        for (at, other) in rows.iter_mut().enumerate().filter(|(at, _)| *at != row) {
            let _ = at;
            let factor = other[column] / pivot[column];
            for (entry, taken) in other.iter_mut().zip(&pivot) {
                *entry -= factor * taken;
            }
        }
        solved.push((row, column));
    }
    solved.sort_by_key(|&(_, column)| column);
    Some(Value::new(size, b.columns, |unknown, column| {
        let (row, _) = solved[unknown];
        rows[row][size + column] / rows[row][unknown]
    }))
}
