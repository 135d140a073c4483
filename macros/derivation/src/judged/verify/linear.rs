//! Linear equations in the field, where pivots are exactly zero or not.

use super::number::Number as _;
use super::residue::Residue;

/// A reduced echelon form: rows with the columns of their pivots, which are one, and zero in the other rows.
#[derive(Default)]
pub(super) struct Subspace(Vec<(usize, Vec<Residue>)>);

fn without(row: &mut [Residue], at: usize, unit: &[Residue]) {
    let share = row[at];
    row.iter_mut().zip(unit).for_each(|(entry, &unit)| *entry = *entry - share * unit);
}

impl Subspace {
    /// Adds a row; false if it depends on the rows before.
    pub(super) fn extend(&mut self, mut row: Vec<Residue>) -> bool {
        for (at, unit) in &self.0 {
            without(&mut row, *at, unit);
        }
        let Some(at) = row.iter().position(|entry| *entry != Residue::ZERO) else { return false };
        let scale = Residue::ONE / row[at];
        for entry in &mut row {
            *entry = *entry * scale;
        }
        self.0.iter_mut().for_each(|(_, other)| without(other, at, &row));
        self.0.push((at, row));
        true
    }

    /// A basis of the null space of the rows.
    pub(super) fn null_space(&self, dimension: usize) -> Vec<Vec<Residue>> {
        let free = (0..dimension).filter(|column| self.0.iter().all(|(at, _)| at != column));
        let vector = |free: usize| {
            let entry = |column: usize| match self.0.iter().find(|(at, _)| *at == column) {
                Some((_, row)) => -row[free],
                None if column == free => Residue::ONE,
                None => Residue::ZERO,
            };
            (0..dimension).map(entry).collect()
        };
        free.map(vector).collect()
    }
}

/// Whether a square matrix, row by row, has an inverse.
pub(super) fn is_regular(entries: &[Residue], size: usize) -> bool {
    let mut rows = Subspace::default();
    entries.chunks(size).all(|row| rows.extend(row.to_vec()))
}
