//! A table in memory.

use alloc::vec::Vec;

use super::recorder::{Column, Sink, SinkError};

/// A table in memory, for runs whose rows are few: it is the only [`Sink`] that grows with the run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    columns: Vec<Column>,
    numbers: Vec<f64>,
}

impl Table {
    /// A table without columns and rows.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// The columns.
    #[must_use]
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// The rows.
    #[must_use]
    pub fn rows(&self) -> impl ExactSizeIterator<Item = &[f64]> {
        self.numbers.chunks_exact(self.columns.len().max(1))
    }

    /// The numbers of the column of this name.
    #[must_use]
    pub fn column(&self, name: &str) -> Option<impl ExactSizeIterator<Item = f64> + '_> {
        let place = self.columns.iter().position(|column| column.name == name)?;
        Some(self.rows().map(move |row| row[place]))
    }
}

impl Sink for Table {
    fn begin(&mut self, columns: &[Column]) -> Result<(), SinkError> {
        (self.columns, self.numbers) = (columns.to_vec(), Vec::new());
        Ok(())
    }

    fn write(&mut self, rows: &[f64]) -> Result<(), SinkError> {
        self.numbers.extend_from_slice(rows);
        Ok(())
    }

    fn end(&mut self) -> Result<(), SinkError> {
        Ok(())
    }
}
