//! A table of a run: a row for each moment that is recorded, handed on in blocks to a file or to memory.

use alloc::borrow::ToOwned as _;
use alloc::boxed::Box;
use alloc::format;
use alloc::string::String;
use alloc::vec;
use alloc::vec::Vec;
use core::fmt;
use thiserror::Error;

use crate::groups::LieGroup;
use crate::mechanics::FactoredInertia;
use crate::motion::{Integrator, Moment, ScalarIn};
use crate::numbers::{Entries as _, real};

/// A column of a table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// Its name; no two of a table have the same.
    pub name: String,
    /// The unit of its numbers, and nothing where there is none or it depends on what was declared.
    pub unit: String,
}

/// What can't be written.
pub type SinkError = Box<dyn core::error::Error + Send + Sync>;

/// Where the rows of a [`Recorder`] go.
pub trait Sink {
    /// The columns, once and before all rows.
    ///
    /// # Errors
    ///
    /// The sink's own.
    fn begin(&mut self, columns: &[Column]) -> Result<(), SinkError>;

    /// Some rows, one after the other.
    ///
    /// # Errors
    ///
    /// The sink's own.
    fn write(&mut self, rows: &[f64]) -> Result<(), SinkError>;

    /// After the last row.
    ///
    /// # Errors
    ///
    /// The sink's own.
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

/// Why a table couldn't be written.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum RecordError {
    /// Two columns have one name.
    #[error("two columns are called `{name}`; give one of them another name")]
    SameName {
        /// The name.
        name: String,
    },
    /// A column was added behind the first row. The rows before it are in the table, which has ended with them.
    #[error("the column `{name}` was added behind the first row; add all columns before that")]
    Late {
        /// Its name.
        name: String,
    },
    /// What the rows are written to has failed.
    #[error("the table can't be written: {cause}")]
    Sink {
        /// Its error.
        #[source]
        cause: SinkError,
    },
}

type Quantity<'a, I> = Box<dyn FnMut(&Moment<'_, I>) -> f64 + 'a>;

/// Rows that are handed on at once, unless another number is asked for.
const ROWS_IN_A_BLOCK: usize = 1024;

/// Makes a row of each moment that it is shown, of named columns, and hands the rows on in blocks.
///
/// | columns | | unit on SO(3) and products of it |
/// |---|---|---|
/// | `t` | the time since the start | s |
/// | `q_w`, `q_x`, `q_y`, `q_z` | the attitude, body to space; of translations `x`, `y`, `z` in m; on other groups the matrix, `g_11`, `g_12`, … | 1 |
/// | `velocity_x`, … | the body velocity; on other groups `velocity_1`, … | rad/s |
/// | `momentum_x`, … | the body momentum | kg m²/s |
/// | `energy` | the energy | J |
/// | `defect` | how far the attitude has left the group | 1 |
///
/// On a product of groups a name has the place of its factor behind it: `q_w_1`, …, `velocity_x_1`, …, `velocity_x_2`.
/// Of the two quaternions of an attitude the one nearer to the row before is written. Other columns are
/// the user's [quantities](Self::quantity). [`Run`](crate::recording::Run) has an example.
///
/// Rows that are left when the recorder is dropped are written then, but an error is lost:
/// [`finish`](Self::finish) reports it. After an error the sink gets nothing more, and no end.
pub struct Recorder<'a, I: Integrator, S: Sink> {
    columns: Vec<Column>,
    shows_motion: bool,
    /// The numbers of the attitude in the row before.
    attitude: Vec<ScalarIn<I>>,
    inertia: Option<FactoredInertia<I::Group>>,
    quantities: Vec<Quantity<'a, I>>,
    /// Rows, and how many of their numbers are there.
    block: Vec<f64>,
    filled: usize,
    rows_in_a_block: usize,
    /// The numbers of a full block.
    full: usize,
    stage: Stage,
    /// Gone when the table has ended.
    sink: Option<S>,
}

/// How far a table is.
#[derive(Clone, Copy, PartialEq)]
enum Stage {
    /// The sink doesn't know the columns yet.
    Before,
    /// It has them.
    Begun,
    /// A column came after that, of this place, which it doesn't know.
    Late(usize),
    /// It has failed, and gets nothing more: rows behind a gap would look like a whole table.
    Failed,
}

impl<'a, I, S> Recorder<'a, I, S>
where
    I: Integrator,
    ScalarIn<I>: Into<f64>,
    S: Sink,
{
    /// A table of all columns above, of motions that this integrator steps.
    pub fn new(integrator: &I, sink: S) -> Self {
        let mut recorder = Self::bare(integrator, sink);
        let (attitude, components) = (I::Group::named_numbers(), I::Group::named_components());
        recorder.attitude = vec![real(0.0); attitude.len()];
        recorder.inertia = integrator.factored_inertia();
        recorder.shows_motion = true;
        let named = |quantity: &'static str, which: usize| {
            components.iter().map(move |(name, units)| (format!("{quantity}_{name}"), units[which]))
        };
        // A product of a velocity and a momentum.
        let energy = if components.iter().all(|(_, units)| *units == ["rad/s", "kg m²/s"]) { "J" } else { "" };
        let columns = attitude.into_iter().chain(named("velocity", 0)).chain(named("momentum", 1));
        let columns = columns.chain([("energy".to_owned(), energy), ("defect".to_owned(), "1")]);
        recorder.columns.extend(columns.map(|(name, unit)| Column { name, unit: unit.to_owned() }));
        recorder
    }

    /// A table of the time, and of what else is added to it.
    pub fn bare(_: &I, sink: S) -> Self {
        Self {
            columns: vec![Column { name: "t".to_owned(), unit: "s".to_owned() }],
            shows_motion: false,
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

    /// A further column, with its unit; before the first row. Later it ends the table with the rows that there are, and
    /// each further row is an error.
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

    /// Hands on `rows` rows at once, by default 1024: with one, each row is written when it is recorded.
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
    /// [`RecordError`] with the first row where two columns have one name or the table can't be begun, and later where a
    /// column was added or a full block of rows can't be written. After an error of the sink each further row is one, too.
    pub fn record(&mut self, now: &Moment<'_, I>) -> Result<(), RecordError> {
        let end = self.filled + self.columns.len();
        // The block is empty before the table has begun, and after it has failed.
        if self.block.len() < end {
            self.make_room(end)?;
        }
        let Some((time, own)) = self.block[self.filled..end].split_first_mut() else { return Err(unreachable()) };
        *time = now.time().into();
        if self.shows_motion {
            let behind = match (<&mut [_; 4]>::try_from(self.attitude.as_mut_slice()), own.split_first_chunk_mut()) {
                // Quickly where the compiler knows the length: of four numbers, as a quaternion has.
                (Ok(numbers), Some((places, behind))) => {
                    now.attitude.write_numbers(numbers);
                    *places = numbers.map(Into::into);
                    behind
                }
                _ => write_attitude(&now.attitude, &mut self.attitude, own),
            };
            let (velocity, energy) = now.integrator().velocity_and_energy(now, self.inertia.as_ref());
            let mut places = behind[..2 * <I::Group as LieGroup>::DIMENSION + 2].iter_mut();
            let mut write = |number: ScalarIn<I>| places.next().map_or((), |place| *place = number.into());
            velocity.each(&mut write);
            now.momentum.each(&mut write);
            write(energy);
            write(now.attitude.defect());
        }
        if !self.quantities.is_empty() || end >= self.full {
            return self.end_row(now, end);
        }
        self.filled = end;
        Ok(())
    }

    /// What stands last in a row that ends here, and what comes after the last of a block.
    #[inline(never)]
    fn end_row(&mut self, now: &Moment<'_, I>, end: usize) -> Result<(), RecordError> {
        let places = &mut self.block[end - self.quantities.len()..end];
        places.iter_mut().zip(&mut self.quantities).for_each(|(place, quantity)| *place = quantity(now));
        self.filled = end;
        if end >= self.full { self.flush() } else { Ok(()) }
    }

    /// A block as long as this, and longer as more rows come: of very many rows that are asked for there may be few. The
    /// table begins with the first.
    #[cold]
    #[inline(never)]
    fn make_room(&mut self, end: usize) -> Result<(), RecordError> {
        self.begin()?;
        if self.block.len() < end {
            self.block.resize(end.max(2 * self.block.len()).min(self.full.max(end)), 0.0);
        }
        Ok(())
    }

    /// Writes what is left, and returns what was written to.
    ///
    /// # Errors
    ///
    /// [`RecordError`] where it can't be written.
    pub fn finish(mut self) -> Result<S, RecordError> {
        self.flush()?;
        let mut sink = self.sink.take().ok_or_else(unreachable)?;
        sink.end().map_err(|cause| RecordError::Sink { cause })?;
        Ok(sink)
    }
}

impl<I: Integrator, S: Sink> Recorder<'_, I, S> {
    /// Hands on the rows that there are.
    ///
    /// # Errors
    ///
    /// [`RecordError`] where they can't be written.
    pub fn flush(&mut self) -> Result<(), RecordError> {
        self.begin()?;
        let sink = self.sink.as_mut().ok_or_else(unreachable)?;
        let rows = &self.block[..core::mem::take(&mut self.filled)];
        let written = if rows.is_empty() { Ok(()) } else { sink.write(rows) };
        written.map_err(|cause| self.failed(cause))
    }

    /// Hands on the columns, if that hasn't been done.
    fn begin(&mut self) -> Result<(), RecordError> {
        match self.stage {
            Stage::Begun => return Ok(()),
            Stage::Failed => return Err(RecordError::Sink { cause: "it has failed before".into() }),
            Stage::Late(column) => {
                // The rows have the columns that the sink knows, and no more come.
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

/// Writes the numbers of an attitude over those of the row before and into a row; returns what is behind them there.
#[inline(never)]
fn write_attitude<'a, G: LieGroup<Scalar: Into<f64>>>(
    attitude: &G,
    numbers: &mut [G::Scalar],
    row: &'a mut [f64],
) -> &'a mut [f64] {
    attitude.write_numbers(numbers);
    let (places, behind) = row.split_at_mut(numbers.len());
    places.iter_mut().zip(numbers).for_each(|(place, number)| *place = (*number).into());
    behind
}

/// The sink is there until the recorder is gone, and a row has the time at least.
fn unreachable() -> RecordError {
    RecordError::Sink { cause: "the table is finished".into() }
}

impl<I: Integrator, S: Sink> Drop for Recorder<'_, I, S> {
    fn drop(&mut self) {
        // An error can't be reported from here.
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
