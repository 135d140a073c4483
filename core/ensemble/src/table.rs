//! Tables from which members read their numbers.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use arrow_array::cast::AsArray as _;
use arrow_array::types::{
    Float32Type, Float64Type, Int8Type, Int16Type, Int32Type, Int64Type, UInt8Type, UInt16Type, UInt32Type, UInt64Type,
};
use arrow_array::{Array as _, ArrayRef};
use arrow_ipc::reader::FileReader;
use arrow_schema::{ArrowError, DataType};
use thiserror::Error;

use crate::Failure;
use liestep::numbers::Digest;

/// Columns of numbers by their names, with a row for each member.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    columns: BTreeMap<String, Vec<f64>>,
    rows: u64,
}

/// The reason why a file isn't a table of numbers.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum TableError {
    /// The file can't be read, or isn't Arrow IPC.
    #[error("{path} isn't an Arrow IPC file: {reason}")]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The reason.
        reason: String,
    },
    /// A cell of a column of numbers is empty.
    #[error("the column `{column}` has no number in row {row}; fill it, or leave the row out")]
    Empty {
        /// The column.
        column: String,
        /// The first such row, from zero.
        row: usize,
    },
    /// A whole number has more than 53 bits, and isn't a double.
    #[error(
        "the whole number in row {row} of the column `{column}` is beyond 2⁵³, so that a double hasn't all of its digits; write the column as text or in two"
    )]
    TooLarge {
        /// The column.
        column: String,
        /// The first such row, from zero.
        row: usize,
    },
    /// Two columns differ in length.
    #[error("the column `{column}` has another length than those before it")]
    Uneven {
        /// The column that differs.
        column: String,
    },
}

impl Table {
    /// A table of columns of one length.
    ///
    /// # Errors
    ///
    /// [`TableError::Uneven`] if they differ in length.
    pub fn new(columns: impl IntoIterator<Item = (String, Vec<f64>)>) -> Result<Self, TableError> {
        let mut table = Self { columns: BTreeMap::new(), rows: 0 };
        for (column, numbers) in columns {
            if !table.columns.is_empty() && table.rows != numbers.len() as u64 {
                return Err(TableError::Uneven { column });
            }
            table.rows = numbers.len() as u64;
            table.columns.insert(column, numbers);
        }
        Ok(table)
    }

    /// The columns of numbers of an Arrow IPC file, as polars and pandas write it: doubles, floats, and whole numbers of
    /// 8 to 64 bits. Others are left out.
    ///
    /// # Errors
    ///
    /// [`TableError`] if the file can't be read, a number is missing, or a whole number is beyond 2⁵³.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, TableError> {
        let path = path.as_ref();
        let unreadable = |reason: String| TableError::Unreadable { path: path.to_owned(), reason };
        let file = std::fs::File::open(path).map_err(|error| unreadable(error.to_string()))?;
        let reader = FileReader::try_new_buffered(file, None).map_err(|error| unreadable(error.to_string()))?;
        let names: Vec<String> = reader.schema().fields().iter().map(|field| field.name().clone()).collect();
        let mut columns: BTreeMap<String, Vec<f64>> = BTreeMap::new();
        for batch in reader {
            let batch = batch.map_err(|error: ArrowError| unreadable(error.to_string()))?;
            for (name, array) in names.iter().zip(batch.columns()) {
                let Some(numbers) = numbers(array) else { continue };
                let column = columns.entry(name.clone()).or_default();
                if let Some(row) = (0..array.len()).find(|&row| array.is_null(row)) {
                    return Err(TableError::Empty { column: name.clone(), row: column.len() + row });
                }
                if let Some(row) = first_too_large(array) {
                    return Err(TableError::TooLarge { column: name.clone(), row: column.len() + row });
                }
                column.extend(numbers);
            }
        }
        Self::new(columns)
    }

    /// The number of rows.
    #[must_use]
    pub fn rows(&self) -> u64 {
        self.rows
    }

    /// The numbers of the column of this name, if there is one.
    #[must_use]
    pub fn column(&self, name: &str) -> Option<&[f64]> {
        self.columns.get(name).map(Vec::as_slice)
    }

    pub(crate) fn cell(&self, column: &str, row: u64) -> Result<f64, Failure> {
        let numbers = self.column(column).ok_or_else(|| {
            let known: Vec<&str> = self.columns.keys().map(String::as_str).collect();
            Failure::Other(format!("the table has no column `{column}` but {}", known.join(", ")))
        })?;
        let number = usize::try_from(row).ok().and_then(|row| numbers.get(row));
        number.copied().ok_or_else(|| Failure::Other(format!("the table has no row {row} but {}", self.rows)))
    }

    pub(crate) fn digest(&self) -> u64 {
        let mut digest = Digest::default();
        for (name, numbers) in &self.columns {
            digest.text(name);
            for number in numbers {
                digest.number(number.to_bits());
            }
        }
        digest.value()
    }
}

/// The numbers of a column, if it has some.
#[allow(clippy::cast_precision_loss)] // `first_too_large` finds the numbers that would be rounded
fn numbers(array: &ArrayRef) -> Option<Vec<f64>> {
    Some(match array.data_type() {
        DataType::Float64 => array.as_primitive::<Float64Type>().values().to_vec(),
        DataType::Float32 => array.as_primitive::<Float32Type>().values().iter().map(|&n| f64::from(n)).collect(),
        DataType::Int64 => array.as_primitive::<Int64Type>().values().iter().map(|&n| n as f64).collect(),
        DataType::UInt64 => array.as_primitive::<UInt64Type>().values().iter().map(|&n| n as f64).collect(),
        DataType::Int8 => array.as_primitive::<Int8Type>().values().iter().map(|&n| f64::from(n)).collect(),
        DataType::UInt8 => array.as_primitive::<UInt8Type>().values().iter().map(|&n| f64::from(n)).collect(),
        DataType::Int16 => array.as_primitive::<Int16Type>().values().iter().map(|&n| f64::from(n)).collect(),
        DataType::UInt16 => array.as_primitive::<UInt16Type>().values().iter().map(|&n| f64::from(n)).collect(),
        DataType::Int32 => array.as_primitive::<Int32Type>().values().iter().map(|&n| f64::from(n)).collect(),
        DataType::UInt32 => array.as_primitive::<UInt32Type>().values().iter().map(|&n| f64::from(n)).collect(),
        _ => return None,
    })
}

/// The first row whose whole number may lose digits as a double.
fn first_too_large(array: &ArrayRef) -> Option<usize> {
    const LARGEST: u64 = 1 << f64::MANTISSA_DIGITS;
    match array.data_type() {
        DataType::Int64 => array.as_primitive::<Int64Type>().values().iter().position(|n| n.unsigned_abs() > LARGEST),
        DataType::UInt64 => array.as_primitive::<UInt64Type>().values().iter().position(|&n| n > LARGEST),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::{first_too_large, numbers};
    use arrow_array::{ArrayRef, Int8Array, Int64Array, StringArray, UInt16Array, UInt64Array};
    use std::sync::Arc;

    #[test]
    fn whole_numbers_are_read_while_doubles_have_them() {
        let read = |array: ArrayRef| (numbers(&array), first_too_large(&array));
        assert_eq!(read(Arc::new(Int8Array::from(vec![-128, 127]))), (Some(vec![-128.0, 127.0]), None));
        assert_eq!(read(Arc::new(UInt16Array::from(vec![65_535]))), (Some(vec![65_535.0]), None));
        let most = 1_i64 << 53;
        assert_eq!(read(Arc::new(Int64Array::from(vec![most, -most]))).1, None);
        assert_eq!(read(Arc::new(Int64Array::from(vec![0, -most - 1]))).1, Some(1));
        assert_eq!(read(Arc::new(UInt64Array::from(vec![u64::MAX]))).1, Some(0));
        assert_eq!(read(Arc::new(StringArray::from(vec!["1"]))), (None, None));
    }
}
