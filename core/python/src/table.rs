//! Columns of numbers that Rust, `NumPy` and Arrow read in one place of memory.

use std::collections::HashMap;
use std::sync::Arc;

use arrow_array::ffi_stream::FFI_ArrowArrayStream;
use arrow_array::{ArrayRef, Float64Array, RecordBatch, RecordBatchIterator};
use arrow_buffer::{Buffer, ScalarBuffer};
use arrow_schema::{ArrowError, DataType, Field, Schema};
use liestep::recording::{Column, Sink, SinkError};
use pyo3::exceptions::{PyIndexError, PyMemoryError};
use pyo3::prelude::*;
use pyo3::types::{PyCapsule, PyDict, PyTuple, PyType};

use crate::failure::Failure;

/// A table under construction, column by column in one block of memory: each column has room for all rows.
pub(crate) struct Columns {
    columns: Vec<Column>,
    numbers: Vec<f64>,
    /// The number of rows, and the most that fit.
    rows: usize,
    room: usize,
}

impl Columns {
    /// An empty table with room for these rows, if there is that much memory.
    pub(crate) const fn new(room: usize) -> Self {
        Self { columns: Vec::new(), numbers: Vec::new(), rows: 0, room }
    }

    /// A table of finished columns, all of one length.
    pub(crate) fn of(columns: Vec<(Column, Vec<f64>)>) -> Self {
        let rows = columns.first().map_or(0, |(_, numbers)| numbers.len());
        let (columns, numbers): (Vec<_>, Vec<_>) = columns.into_iter().unzip();
        Self { columns, numbers: numbers.concat(), rows, room: rows }
    }

    pub(crate) fn into_table(self) -> Table {
        let Self { columns, numbers, rows, room } = self;
        Table { columns, numbers: Buffer::from_vec(numbers), rows, room }
    }

    fn grow(&mut self) -> Result<(), SinkError> {
        let room = (2 * self.room).max(64);
        let mut numbers = block(self.columns.len(), room)?;
        for place in 0..self.columns.len() {
            let old = &self.numbers[place * self.room..place * self.room + self.rows];
            numbers[place * room..place * room + self.rows].copy_from_slice(old);
        }
        (self.numbers, self.room) = (numbers, room);
        Ok(())
    }
}

/// A block of zeros, which the system allocates when they are written to; or an error, if there is no such memory.
fn block(columns: usize, room: usize) -> Result<Vec<f64>, SinkError> {
    let numbers = columns.checked_mul(room).filter(|numbers| *numbers < (1 << 44));
    let message =
        || format!("a table of {columns} columns and {room} rows doesn't fit into memory: take a larger `every`");
    let numbers = numbers.ok_or_else(message)?;
    Vec::<f64>::new().try_reserve_exact(numbers).map_err(|_| message())?;
    Ok(vec![0.0; numbers])
}

impl Sink for Columns {
    fn begin(&mut self, columns: &[Column]) -> Result<(), SinkError> {
        self.numbers = block(columns.len(), self.room)?;
        self.columns = columns.to_vec();
        Ok(())
    }

    fn write(&mut self, rows: &[f64]) -> Result<(), SinkError> {
        let width = self.columns.len().max(1);
        while self.rows + rows.len() / width > self.room {
            self.grow()?;
        }
        for (place, column) in self.numbers.chunks_exact_mut(self.room.max(1)).enumerate() {
            let own = rows.iter().skip(place).step_by(width);
            column[self.rows..].iter_mut().zip(own).for_each(|(number, value)| *number = *value);
        }
        self.rows += rows.len() / width;
        Ok(())
    }

    fn end(&mut self) -> Result<(), SinkError> {
        Ok(())
    }
}

/// Columns of doubles, which never change: `NumPy` and Arrow look at them where they are.
#[pyclass(frozen, module = "liestep._native")]
pub(crate) struct Table {
    columns: Vec<Column>,
    numbers: Buffer,
    rows: usize,
    room: usize,
}

impl Table {
    pub(crate) fn column(&self, place: usize) -> ScalarBuffer<f64> {
        ScalarBuffer::new(self.numbers.clone(), place * self.room, self.rows)
    }

    pub(crate) fn named(&self, name: &str) -> Option<ScalarBuffer<f64>> {
        self.columns.iter().position(|column| column.name == name).map(|place| self.column(place))
    }

    pub(crate) fn all(&self) -> impl Iterator<Item = (&str, ScalarBuffer<f64>)> {
        self.columns.iter().enumerate().map(|(place, column)| (column.name.as_str(), self.column(place)))
    }

    fn batch(&self) -> Result<RecordBatch, ArrowError> {
        let field = |column: &Column| {
            let unit = HashMap::from([("unit".to_owned(), column.unit.clone())]);
            Field::new(&column.name, DataType::Float64, false).with_metadata(unit)
        };
        let schema = Schema::new(self.columns.iter().map(field).collect::<Vec<_>>());
        let array = |place| -> ArrayRef { Arc::new(Float64Array::new(self.column(place), None)) };
        RecordBatch::try_new(Arc::new(schema), (0..self.columns.len()).map(array).collect())
    }
}

/// A column as it is pickled: its name, its unit and its numbers.
type ColumnData = (String, String, Vec<f64>);

#[pymethods]
impl Table {
    /// A table of columns of one length.
    #[new]
    fn new(columns: Vec<ColumnData>) -> PyResult<Self> {
        let length = columns.first().map_or(0, |(.., numbers)| numbers.len());
        if columns.iter().any(|(.., numbers)| numbers.len() != length) {
            return Err(Failure::Of("ColumnError", "the columns of a table are of one length".to_owned()).into());
        }
        let of = |(name, unit, numbers)| (Column { name, unit }, numbers);
        Ok(Columns::of(columns.into_iter().map(of).collect()).into_table())
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> (Bound<'py, PyType>, (Vec<ColumnData>,)) {
        let table = slf.get();
        let columns = table.columns.iter().enumerate();
        let of = |(place, column): (usize, &Column)| {
            (column.name.clone(), column.unit.clone(), table.column(place).to_vec())
        };
        (slf.get_type(), (columns.map(of).collect(),))
    }

    /// Names and units of the columns.
    #[getter]
    fn columns(&self) -> Vec<(String, String)> {
        self.columns.iter().map(|column| (column.name.clone(), column.unit.clone())).collect()
    }

    fn __len__(&self) -> usize {
        self.rows
    }

    /// The columns that `NumPy` makes an array of without a copy: one of them, or several side by side.
    fn view(slf: &Bound<'_, Self>, first: usize, count: Option<usize>) -> PyResult<View> {
        let own = slf.get();
        if first.checked_add(count.unwrap_or(1)).is_none_or(|end| end > own.columns.len()) {
            return Err(PyIndexError::new_err("there is no such column"));
        }
        Ok(View { table: slf.clone().unbind(), first, count })
    }

    /// The table as a stream of Arrow's C data interface.
    #[pyo3(signature = (requested_schema = None))]
    fn __arrow_c_stream__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyCapsule>> {
        // The request is ignored, as all columns are doubles.
        drop(requested_schema);
        let batch = self.batch().map_err(|error| PyMemoryError::new_err(error.to_string()))?;
        let schema = batch.schema();
        let stream = FFI_ArrowArrayStream::new(Box::new(RecordBatchIterator::new([Ok(batch)], schema)));
        PyCapsule::new_with_value(py, stream, c"arrow_array_stream")
    }
}

/// Some columns of a table, as `NumPy` asks for their place.
#[pyclass(frozen, module = "liestep._native")]
pub(crate) struct View {
    table: Py<Table>,
    first: usize,
    count: Option<usize>,
}

#[pymethods]
impl View {
    #[getter]
    fn __array_interface__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let table = self.table.get();
        let size = size_of::<f64>();
        let interface = PyDict::new(py);
        let address = table.numbers.as_ptr() as usize + self.first * table.room * size;
        interface.set_item("version", 3)?;
        interface.set_item("typestr", if cfg!(target_endian = "little") { "<f8" } else { ">f8" })?;
        interface.set_item("data", (address, true))?;
        let (shape, strides) = match self.count {
            None => (vec![table.rows], vec![size]),
            Some(count) => (vec![table.rows, count], vec![size, table.room * size]),
        };
        interface.set_item("shape", PyTuple::new(py, shape)?)?;
        interface.set_item("strides", PyTuple::new(py, strides)?)?;
        Ok(interface)
    }
}
