//! Runs of [liestep](https://docs.rs/liestep) as Arrow IPC streams: columns of doubles with their units, which are read
//! without parsing, in Python by `pyarrow.ipc.open_stream(path).read_all()`, in Julia by `Arrow.Table(path)`, in R by
//! `arrow::read_ipc_stream(path)`.
//!
//! ```
//! use liestep::effects::RigidBody;
//! use liestep::nalgebra::Vector3;
//! use liestep::recording::Recorder;
//! use liestep::{NonstandardInertia, SO3, Stepper};
//! use liestep_arrow::ArrowStream;
//!
//! let body = RigidBody { J_d: NonstandardInertia::from_principal_moments(Vector3::new(1.0, 2.0, 2.5))? };
//! let stepper = Stepper::new(body, 0.01)?;
//! let mut state = stepper.start(SO3::identity(), Vector3::new(0.1, 2.0, 0.2))?;
//! let mut recorder = Recorder::new(&stepper, ArrowStream::new(Vec::new())); // or ArrowStream::create("body.arrows")?
//! stepper.observed(&mut state).every(10, |now| recorder.record(now)).until(100.0)?;
//! let bytes = recorder.finish()?.into_inner()?;
//! assert!(bytes.len() > 1000 * 13 * 8);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The unit of a column is in the metadata of its field, under `unit`.

use std::collections::HashMap;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;
use std::sync::Arc;

use arrow_array::{ArrayRef, Float64Array, RecordBatch};
use arrow_ipc::writer::StreamWriter;
use arrow_schema::{ArrowError, DataType, Field, Schema, SchemaRef};
use liestep::recording::{Column, RecordError, Sink, SinkError};

/// A sink that writes a table as an Arrow IPC stream, one record batch per block of rows.
///
/// Memory doesn't grow with the stream, and an interrupted run leaves every block that was written. An Arrow IPC file
/// ("Feather") would list all batches in its footer, and can't be read without it.
pub struct ArrowStream<W: Write> {
    stage: Stage<W>,
}

enum Stage<W: Write> {
    /// The writer, before the table's columns are known.
    Before(W),
    Writing(Box<StreamWriter<W>>, SchemaRef),
    Done(W),
    /// The stage after an error, and during a change.
    Failed,
}

impl ArrowStream<BufWriter<File>> {
    /// Creates a file, or replaces its contents.
    ///
    /// # Errors
    ///
    /// The file can't be created.
    pub fn create(path: impl AsRef<Path>) -> io::Result<Self> {
        Ok(Self::new(BufWriter::new(File::create(path)?)))
    }
}

impl<W: Write> ArrowStream<W> {
    /// Writes to any writer.
    pub fn new(writer: W) -> Self {
        Self { stage: Stage::Before(writer) }
    }

    /// The writer, after the end.
    ///
    /// # Errors
    ///
    /// The table is unfinished, or an error has ended it.
    pub fn into_inner(self) -> Result<W, RecordError> {
        match self.stage {
            Stage::Before(writer) | Stage::Done(writer) => Ok(writer),
            Stage::Writing(..) | Stage::Failed => Err(RecordError::Sink { cause: "the table isn't finished".into() }),
        }
    }
}

impl<W: Write> Sink for ArrowStream<W> {
    fn begin(&mut self, columns: &[Column]) -> Result<(), SinkError> {
        let Stage::Before(writer) = std::mem::replace(&mut self.stage, Stage::Failed) else { return Err(order()) };
        let fields = columns.iter().map(|column| {
            let unit = HashMap::from([("unit".to_owned(), column.unit.clone())]);
            Field::new(&column.name, DataType::Float64, false).with_metadata(unit)
        });
        let schema = Arc::new(Schema::new(fields.collect::<Vec<_>>()));
        self.stage = Stage::Writing(Box::new(StreamWriter::try_new(writer, &schema)?), schema);
        Ok(())
    }

    fn write(&mut self, rows: &[f64]) -> Result<(), SinkError> {
        let Stage::Writing(writer, schema) = &mut self.stage else { return Err(order()) };
        let width = schema.fields().len();
        if width == 0 {
            return Err(ArrowError::IpcError("rows of no columns aren't written".to_owned()).into());
        }
        let column = |place: usize| -> ArrayRef {
            Arc::new(rows.chunks_exact(width).map(|row| row[place]).collect::<Float64Array>())
        };
        let batch = RecordBatch::try_new(Arc::clone(schema), (0..width).map(column).collect());
        batch.and_then(|batch| writer.write(&batch))?;
        // A buffered block would be lost if the process were killed.
        Ok(writer.flush()?)
    }

    fn end(&mut self) -> Result<(), SinkError> {
        let Stage::Writing(writer, _) = std::mem::replace(&mut self.stage, Stage::Failed) else { return Err(order()) };
        // The end-of-stream marker is written first.
        self.stage = Stage::Done(writer.into_inner()?);
        if let Stage::Done(writer) = &mut self.stage {
            writer.flush()?;
        }
        Ok(())
    }
}

/// The error of calls out of order.
fn order() -> SinkError {
    ArrowError::IpcError("the table isn't begun, or is finished".to_owned()).into()
}

impl<W: Write> std::fmt::Debug for ArrowStream<W> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ArrowStream").finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use super::ArrowStream;
    use arrow_array::cast::AsArray as _;
    use arrow_array::types::Float64Type;
    use arrow_ipc::reader::StreamReader;
    use liestep::effects::RigidBody;
    use liestep::nalgebra::Vector3;
    use liestep::recording::{Background, Column, Recorder, Sink as _, Table};
    use liestep::{NonstandardInertia, SO3, Stepper};
    use std::io::{self, Write};
    use std::sync::{Arc, Mutex};

    /// The columns read back equal those of a table in memory to the bit, with names and units.
    #[test]
    fn what_is_written_is_read() {
        let J_d = NonstandardInertia::from_principal_moments(Vector3::new(1.0, 2.0, 2.5)).unwrap();
        let stepper = Stepper::new(RigidBody { J_d }, 0.01).unwrap();
        let mut state = stepper.start(SO3::identity(), Vector3::new(0.1, 2.0, 0.2)).unwrap();
        let mut table = Recorder::new(&stepper, Table::new());
        let mut stream = Recorder::new(&stepper, Background::new(ArrowStream::new(Vec::new()))).in_blocks_of(7);
        let run = stepper.observed(&mut state).every(3, |now| table.record(now)).every(3, |now| stream.record(now));
        run.steps(100).unwrap();
        let table = table.finish().unwrap();
        let bytes = stream.finish().unwrap().into_inner().unwrap().into_inner().unwrap();

        let reader = StreamReader::try_new(bytes.as_slice(), None).unwrap();
        let schema = reader.schema();
        for (field, column) in schema.fields().iter().zip(table.columns()) {
            assert_eq!((field.name(), &field.metadata()["unit"]), (&column.name, &column.unit));
        }
        let batches: Vec<_> = reader.map(Result::unwrap).collect();
        assert_eq!(batches.iter().map(arrow_array::RecordBatch::num_rows).collect::<Vec<_>>(), [7, 7, 7, 7, 6]);
        for column in table.columns() {
            let read = batches.iter().flat_map(|batch| {
                let column = batch.column_by_name(&column.name).unwrap().as_primitive::<Float64Type>();
                column.values().to_vec()
            });
            assert!(read.eq(table.column(&column.name).unwrap()), "{}", column.name);
        }
    }

    /// The bytes that have reached the file.
    #[derive(Clone, Default)]
    struct FileBytes(Arc<Mutex<Vec<u8>>>);

    impl Write for FileBytes {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            self.0.lock().unwrap().write(bytes)
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    /// Every block is flushed, as the process may be killed.
    #[test]
    fn each_block_is_there_before_the_end() {
        let file = FileBytes::default();
        let mut stream = ArrowStream::new(io::BufWriter::with_capacity(1 << 20, file.clone()));
        stream.begin(&[Column { name: "t".to_owned(), unit: "s".to_owned() }]).unwrap();
        for block in 1..4 {
            stream.write(&[0.0, 0.5]).unwrap();
            let bytes = file.0.lock().unwrap().clone();
            let batches: Vec<_> = StreamReader::try_new(bytes.as_slice(), None).unwrap().map(Result::unwrap).collect();
            assert_eq!(batches.len(), block);
        }
    }

    #[test]
    fn a_table_of_no_columns_has_no_rows() {
        let mut stream = ArrowStream::new(Vec::new());
        stream.begin(&[]).unwrap();
        assert!(stream.write(&[]).is_err() && stream.write(&[1.0]).is_err());
        stream.end().unwrap();
    }

    #[test]
    fn rows_come_after_the_columns() {
        assert!(ArrowStream::new(Vec::new()).write(&[1.0]).is_err());
        assert!(ArrowStream::new(Vec::new()).end().is_err());
        assert_eq!(ArrowStream::new(vec![1]).into_inner().unwrap(), vec![1]);
    }
}
