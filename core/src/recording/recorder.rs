//! A table of a run: a row for each recorded moment, written in blocks to a file or to memory.

use alloc::borrow::ToOwned as _;
use alloc::boxed::Box;
use alloc::format;
use alloc::string::String;
use alloc::vec;
use alloc::vec::Vec;
use core::fmt;
use thiserror::Error;

use crate::motion::{Factor, Integrator, Moment};
use crate::numbers::real;

/// A column of a table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// Name of the column; no two columns of a table have the same.
    pub name: String,
    /// Unit of the numbers; empty if there is none or if it depends on the declaration.
    pub unit: String,
}

impl Column {
    /// The columns of a motion on a group of these factors: the time, the attitude, velocity, momentum, energy and the
    /// distance from the group.
    #[must_use]
    pub fn of_motions(factors: &[Factor]) -> Vec<Self> {
        let components = || factors.iter().flat_map(|factor| &factor.components);
        let named = |quantity: &'static str, which: usize| {
            components().map(move |(name, units)| (format!("{quantity}_{name}"), units[which]))
        };
        // The unit of a velocity times a momentum.
        let energy = if components().all(|(_, units)| *units == ["rad/s", "kg m²/s"]) { "J" } else { "" };
        let attitude = factors.iter().flat_map(Factor::columns);
        let columns = [("t".to_owned(), "s")].into_iter().chain(attitude);
        let columns = columns.chain(named("velocity", 0)).chain(named("momentum", 1));
        let columns = columns.chain([("energy".to_owned(), energy), ("defect".to_owned(), "1")]);
        columns.map(|(name, unit)| Self { name, unit: unit.to_owned() }).collect()
    }
}

/// An error of a sink.
pub type SinkError = Box<dyn core::error::Error + Send + Sync>;

/// A destination for the rows of a [`Recorder`].
pub trait Sink {
    /// Takes the columns, once and before all rows.
    ///
    /// # Errors
    ///
    /// Errors of the sink.
    fn begin(&mut self, columns: &[Column]) -> Result<(), SinkError>;

    /// Takes some rows, one after the other.
    ///
    /// # Errors
    ///
    /// Errors of the sink.
    fn write(&mut self, rows: &[f64]) -> Result<(), SinkError>;

    /// Ends the table after the last row.
    ///
    /// # Errors
    ///
    /// Errors of the sink.
    fn end(&mut self) -> Result<(), SinkError>;
}

impl<S: Sink + ?Sized> Sink for &mut S {
    fn begin(&mut self, columns: &[Column]) -> Result<(), SinkError> {
        (**self).begin(columns)
    }

    fn write(&mut self, rows: &[f64]) -> Result<(), SinkError> {
        (**self).write(rows)
    }

    fn end(&mut self) -> Result<(), SinkError> {
        (**self).end()
    }
}

/// An error of writing a table.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum RecordError {
    /// Two columns have one name.
    #[error("two columns are called `{name}`; give one of them another name")]
    SameName {
        /// The name of both columns.
        name: String,
    },
    /// A column was added after the first row. The table has ended with the rows before it.
    #[error("the column `{name}` was added behind the first row; add all columns before that")]
    Late {
        /// Name of the column.
        name: String,
    },
    /// The sink has failed.
    #[error("the table can't be written: {cause}")]
    Sink {
        /// The error of the sink.
        #[source]
        cause: SinkError,
    },
}

type Quantity<'a, I> = Box<dyn FnMut(&Moment<'_, I>) -> f64 + 'a>;

/// Default number of rows in a block.
const ROWS_IN_A_BLOCK: usize = 1024;

/// Records moments as rows of named columns, and writes the rows to a sink in blocks.
///
/// | columns | | unit on SO(3) and products of it |
/// |---|---|---|
/// | `t` | the time since the start | s |
/// | `q_w`, `q_x`, `q_y`, `q_z` | the attitude, body to space; of translations `x`, `y`, `z` in m; on other groups the matrix, `g_11`, `g_12`, … | 1 |
/// | `velocity_x`, … | the body velocity; on other groups `velocity_1`, … | rad/s |
/// | `momentum_x`, … | the body momentum | kg m²/s |
/// | `energy` | the energy | J |
/// | `defect` | the distance of the attitude from the group | 1 |
///
/// On a product of groups a name ends with the place of its factor: `q_w_1`, …, `velocity_x_1`, …, `velocity_x_2`. An
/// attitude has two quaternions; the one nearer to the row before is written. Other columns are the user's
/// [quantities](Self::quantity). [`Run`](crate::recording::Run) has an example.
///
/// Rows that are left when the recorder is dropped are written then, but an error is lost: [`finish`](Self::finish)
/// reports it. After an error nothing more is written to the sink, and it isn't ended.
pub struct Recorder<'a, I: Integrator, S: Sink> {
    columns: Vec<Column>,
    /// The columns of the attitude in the row before.
    attitude: Vec<I::Scalar>,
    /// The inertia by which motions are written; none where they aren't.
    inertia: Option<I::Inertia>,
    quantities: Vec<Quantity<'a, I>>,
    /// The current block, of which `filled` numbers are recorded.
    block: Vec<f64>,
    filled: usize,
    rows_in_a_block: usize,
    /// Length of a full block.
    full: usize,
    stage: Stage,
    /// The sink; none when the table has ended.
    sink: Option<S>,
}

/// The state of a table.
#[derive(Clone, Copy, PartialEq)]
enum Stage {
    /// The columns haven't been written.
    Before,
    /// The columns have been written.
    Begun,
    /// A column with this number was added after the columns had been written.
    Late(usize),
    /// The sink has failed, and nothing more is written: rows after a gap would look like a complete table.
    Failed,
}

impl<'a, I, S> Recorder<'a, I, S>
where
    I: Integrator,
    I::Scalar: Into<f64>,
    S: Sink,
{
    /// A recorder of all columns above, for motions of this integrator.
    pub fn new(integrator: &I, sink: S) -> Self {
        let mut recorder = Self::bare(integrator, sink);
        let factors = integrator.factors();
        recorder.attitude = vec![real(0.0); factors.iter().map(|factor| factor.kind.columns()).sum()];
        recorder.inertia = Some(integrator.inertia());
        recorder.columns = Column::of_motions(&factors);
        recorder
    }

    /// A recorder of the time and of added quantities.
    pub fn bare(_: &I, sink: S) -> Self {
        Self {
            columns: vec![Column { name: "t".to_owned(), unit: "s".to_owned() }],
            attitude: Vec::new(),
            inertia: None,
            quantities: Vec::new(),
            block: Vec::new(),
            filled: 0,
            rows_in_a_block: ROWS_IN_A_BLOCK,
            full: 0,
            stage: Stage::Before,
            sink: Some(sink),
        }
    }

    /// Adds a column, with its unit; before the first row. Later it ends the table with the rows before, and each
    /// further row is an error.
    #[must_use]
    pub fn quantity<T: Into<f64>>(
        mut self,
        name: impl Into<String>,
        unit: impl Into<String>,
        mut quantity: impl FnMut(&Moment<'_, I>) -> T + 'a,
    ) -> Self {
        self.columns.push(Column { name: name.into(), unit: unit.into() });
        self.quantities.push(Box::new(move |now| quantity(now).into()));
        if self.stage == Stage::Begun {
            self.stage = Stage::Late(self.columns.len() - 1);
            self.block.truncate(self.filled);
        }
        self
    }

    /// Writes blocks of `rows` rows, by default 1024: with one, each row is written when it is recorded.
    #[must_use]
    pub fn in_blocks_of(mut self, rows: usize) -> Self {
        self.rows_in_a_block = rows.max(1);
        if self.stage == Stage::Begun {
            self.full = self.numbers_in_a_block();
        }
        self
    }

    /// The columns.
    #[must_use]
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// Records a row.
    ///
    /// # Errors
    ///
    /// [`RecordError`] with the first row if two columns have one name or the sink refuses the columns, and later if a
    /// column was added or a full block of rows can't be written. After an error of the sink each further row is an
    /// error, too.
    pub fn record(&mut self, now: &Moment<'_, I>) -> Result<(), RecordError> {
        let end = self.filled + self.columns.len();
        // The block is empty before the first row, and after a failure.
        if self.block.len() < end {
            self.make_room(end)?;
        }
        let Some((time, own)) = self.block[self.filled..end].split_first_mut() else { return Err(unreachable()) };
        *time = now.time().into();
        if let Some(inertia) = &self.inertia {
            now.integrator().write(now, inertia, &mut self.attitude, own);
        }
        if !self.quantities.is_empty() || end >= self.full {
            return self.end_row(now, end);
        }
        self.filled = end;
        Ok(())
    }

    /// Records the quantities at the end of a row, and writes a full block.
    #[inline(never)]
    fn end_row(&mut self, now: &Moment<'_, I>, end: usize) -> Result<(), RecordError> {
        let places = &mut self.block[end - self.quantities.len()..end];
        places.iter_mut().zip(&mut self.quantities).for_each(|(place, quantity)| *place = quantity(now));
        self.filled = end;
        if end >= self.full { self.flush() } else { Ok(()) }
    }

    /// Enlarges the block to at least this length: it grows with the rows, as a block of very many rows may never be
    /// full. The first row begins the table.
    #[cold]
    #[inline(never)]
    fn make_room(&mut self, end: usize) -> Result<(), RecordError> {
        self.begin()?;
        if self.block.len() < end {
            self.block.resize(end.max(2 * self.block.len()).min(self.full.max(end)), 0.0);
        }
        Ok(())
    }

    /// Writes the remaining rows, ends the table, and returns the sink.
    ///
    /// # Errors
    ///
    /// [`RecordError`] if the rows can't be written.
    pub fn finish(mut self) -> Result<S, RecordError> {
        self.flush()?;
        let mut sink = self.sink.take().ok_or_else(unreachable)?;
        sink.end().map_err(|cause| RecordError::Sink { cause })?;
        Ok(sink)
    }
}

impl<I: Integrator, S: Sink> Recorder<'_, I, S> {
    /// Writes the recorded rows.
    ///
    /// # Errors
    ///
    /// [`RecordError`] if the rows can't be written.
    pub fn flush(&mut self) -> Result<(), RecordError> {
        self.begin()?;
        let sink = self.sink.as_mut().ok_or_else(unreachable)?;
        let rows = &self.block[..core::mem::take(&mut self.filled)];
        let written = if rows.is_empty() { Ok(()) } else { sink.write(rows) };
        written.map_err(|cause| self.failed(cause))
    }

    /// Writes the columns, once.
    fn begin(&mut self) -> Result<(), RecordError> {
        match self.stage {
            Stage::Begun => return Ok(()),
            Stage::Failed => return Err(RecordError::Sink { cause: "it has failed before".into() }),
            Stage::Late(column) => {
                // The rows so far have the columns that were written, and the table ends with them.
                let block = core::mem::take(&mut self.block);
                if let Some(mut sink) = self.sink.take() {
                    let rows = &block[..core::mem::take(&mut self.filled)];
                    let written = if rows.is_empty() { Ok(()) } else { sink.write(rows) };
                    written.and_then(|()| sink.end()).map_err(|cause| self.failed(cause))?;
                }
                return Err(RecordError::Late { name: self.columns[column].name.clone() });
            }
            Stage::Before => {}
        }
        let columns = &self.columns;
        let is_repeated = |place: usize| columns[..place].iter().any(|before| before.name == columns[place].name);
        if let Some(place) = (0..columns.len()).find(|&place| is_repeated(place)) {
            return Err(RecordError::SameName { name: columns[place].name.clone() });
        }
        let begun = self.sink.as_mut().ok_or_else(unreachable)?.begin(columns);
        begun.map_err(|cause| self.failed(cause))?;
        self.stage = Stage::Begun;
        self.full = self.numbers_in_a_block();
        Ok(())
    }

    fn numbers_in_a_block(&self) -> usize {
        self.rows_in_a_block.saturating_mul(self.columns.len())
    }

    fn failed(&mut self, cause: SinkError) -> RecordError {
        self.stage = Stage::Failed;
        self.block = Vec::new();
        RecordError::Sink { cause }
    }
}

/// An error that can't occur: the sink lives as long as the recorder, and a row has at least the time.
fn unreachable() -> RecordError {
    RecordError::Sink { cause: "the table is finished".into() }
}

impl<I: Integrator, S: Sink> Drop for Recorder<'_, I, S> {
    fn drop(&mut self) {
        // An error in `drop` can't be reported.
        if self.sink.is_some()
            && self.flush().is_ok()
            && let Some(sink) = &mut self.sink
        {
            let _ = sink.end();
        }
    }
}

impl<I: Integrator, S: Sink + fmt::Debug> fmt::Debug for Recorder<'_, I, S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Recorder").field("columns", &self.columns).field("sink", &self.sink).finish_non_exhaustive()
    }
}
