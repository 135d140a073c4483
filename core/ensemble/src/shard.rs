//! Shards: the recorded rows and the outcome of a chunk, as an Arrow IPC file.

use std::collections::HashMap;
use std::io::{Cursor, Read};
use std::sync::Arc;

use arrow_array::builder::{Float64Builder, ListBuilder};
use arrow_array::cast::AsArray as _;
use arrow_array::types::{Float64Type, UInt8Type, UInt64Type};
use arrow_array::{ArrayRef, Float64Array, RecordBatch, UInt8Array, UInt64Array};
use arrow_ipc::reader::{FileReader, StreamReader};
use arrow_ipc::writer::FileWriter;
use arrow_schema::{ArrowError, DataType, Field, Schema};
use serde::{Deserialize, Serialize};

use crate::outcome::Outcome;

/// The status of a member at the time of a row; files have its number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// 0: the member is still running.
    Going,
    /// 1: the member has completed its steps.
    Finished,
    /// 2: the member has failed: its next step has no solution, or the function of a section has no value here.
    Stopped,
    /// 3: the member couldn't be constructed; its columns are NaN.
    Impossible,
    /// 4: the member has [left](crate::Section::until) within this step.
    Left,
}

impl Status {
    const ALL: [Self; 5] = [Self::Going, Self::Finished, Self::Stopped, Self::Impossible, Self::Left];
}

/// Recorded rows, column by column.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rows {
    /// The member of each row.
    pub member: Vec<u64>,
    /// The steps completed by then.
    pub step: Vec<u64>,
    /// The status of the member.
    pub status: Vec<Status>,
    /// The recorded columns.
    pub columns: Vec<Vec<f64>>,
    /// The recorded crossings, one element for each section of the plan.
    pub crossings: Vec<Crossings>,
}

/// The columns recorded where members cross one surface; files have a list for each row.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Crossings {
    /// The names of the columns.
    pub names: Vec<String>,
    /// The number of the first row after each crossing, which determines the member; empty without columns.
    pub row: Vec<usize>,
    /// The recorded values, by member and then by time.
    pub columns: Vec<Vec<f64>>,
}

impl Crossings {
    pub(crate) fn of_names(names: &[String]) -> Self {
        Self { names: names.to_vec(), row: vec![], columns: vec![vec![]; names.len()] }
    }

    /// Adds a crossing that belongs to this row.
    pub(crate) fn push(&mut self, row: usize, values: &[f64]) {
        if !self.columns.is_empty() {
            self.row.push(row);
        }
        self.columns.iter_mut().zip(values).for_each(|(column, value)| column.push(*value));
    }

    /// The number of crossings of each row.
    fn counts(&self, rows: usize) -> Vec<usize> {
        let mut counts = vec![0; rows];
        for row in &self.row {
            if let Some(count) = counts.get_mut(*row) {
                *count += 1;
            }
        }
        counts
    }

    /// A column as lists, one for each row.
    fn lists(&self, column: &[f64], rows: usize) -> ArrayRef {
        let item = Field::new(ITEM, DataType::Float64, false);
        let mut lists = ListBuilder::new(Float64Builder::with_capacity(column.len())).with_field(item);
        let mut left = column;
        for count in self.counts(rows) {
            let (own, others) = left.split_at(count.min(left.len()));
            lists.values().append_slice(own);
            lists.append(true);
            left = others;
        }
        Arc::new(lists.finish())
    }

    /// Reads the lists of a column; those of the first column determine the rows. `None` if others have other lengths.
    fn read(&mut self, place: usize, array: &ArrayRef, first_row: usize) -> Option<()> {
        let lists = array.as_list_opt::<i32>()?;
        let lengths = lists.value_offsets().windows(2).map(|ends| usize::try_from(ends[1] - ends[0]));
        if place == 0 {
            for (row, length) in lengths.enumerate() {
                self.row.extend(core::iter::repeat_n(first_row + row, length.ok()?));
            }
        } else {
            // Earlier crossings belong to the rows of other batches.
            let own = self.row.partition_point(|row| *row < first_row);
            let rows = lengths
                .enumerate()
                .flat_map(|(row, length)| core::iter::repeat_n(first_row + row, length.unwrap_or(usize::MAX)));
            if !rows.eq(self.row.get(own..)?.iter().copied()) {
                return None;
            }
        }
        // Values before the first list and after the last belong to no row.
        let (first, last) = (lists.value_offsets().first()?, lists.value_offsets().last()?);
        let range = usize::try_from(*first).ok()?..usize::try_from(*last).ok()?;
        let values = lists.values().as_primitive_opt::<Float64Type>()?.values().get(range)?;
        self.columns.get_mut(place)?.extend(values);
        Some(())
    }

    fn append(&mut self, mut other: Self, first_row: usize) {
        self.row.extend(other.row.iter().map(|row| first_row + row));
        self.columns.iter_mut().zip(&mut other.columns).for_each(|(column, other)| column.append(other));
    }
}

/// Arrow's name of the field within a list.
const ITEM: &str = "item";

impl Rows {
    pub(crate) fn of_columns(count: usize, crossings: Vec<Crossings>) -> Self {
        Self { member: vec![], step: vec![], status: vec![], columns: vec![vec![]; count], crossings }
    }

    pub(crate) fn push(&mut self, member: u64, step: u64, status: Status, row: impl Iterator<Item = f64>) {
        self.member.push(member);
        self.step.push(step);
        self.status.push(status);
        self.columns.iter_mut().zip(row).for_each(|(column, value)| column.push(value));
    }

    pub(crate) fn append(&mut self, mut other: Self) {
        let first_row = self.member.len();
        let crossings = self.crossings.iter_mut().zip(other.crossings);
        crossings.for_each(|(own, other)| own.append(other, first_row));
        self.member.append(&mut other.member);
        self.step.append(&mut other.step);
        self.status.append(&mut other.status);
        self.columns.iter_mut().zip(&mut other.columns).for_each(|(column, other)| column.append(other));
    }
}

/// The rows and the outcome of a chunk: one file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Shard {
    /// The [fingerprint](crate::Ensemble::fingerprint) of the plan.
    pub plan: u64,
    /// The number of the chunk.
    pub chunk: u64,
    /// The number of the chunk's members that are here: fewer than the chunk has if it is the last one.
    pub members: u64,
    /// A digest of the first member's recorded values at the start and after a [piece](crate::Ensemble::PIECE) of steps.
    pub sample: u64,
    /// The names of the columns.
    #[serde(skip)]
    pub names: Vec<String>,
    /// The rows, by member and then by time.
    #[serde(skip)]
    pub rows: Rows,
    /// The outcome of the chunk's members.
    pub outcome: Outcome,
}

/// The key of the schema's metadata that stores everything but the rows. A single key, as the order of several isn't
/// fixed.
const KEY: &str = "liestep-ensemble";
/// The first line of that text, a comment of TOML; another layout has another number.
const FORMAT: &str = "# format 4";

/// Arrow's magic bytes with their padding, before which there is nothing and behind which a stream begins.
const MAGIC: usize = 64;
/// The bytes before the schema: those, the mark of a message, and its length.
const BEFORE: usize = MAGIC + 8;

/// The length of a file's head, by its first bytes.
fn head_length(before: &[u8]) -> usize {
    let length = before.get(BEFORE - 4..BEFORE).and_then(|length| length.try_into().ok()).map_or(0, u32::from_le_bytes);
    BEFORE.saturating_add(usize::try_from(length).unwrap_or(usize::MAX))
}

/// The head of a file, which is all but its rows and its end.
pub(crate) fn head_of(file: &[u8]) -> &[u8] {
    file.get(..head_length(file)).unwrap_or(file)
}

/// Reads the head of a file, or as much of it as there is.
pub(crate) fn read_head(file: &mut impl Read, head: &mut Vec<u8>) -> std::io::Result<usize> {
    file.by_ref().take(BEFORE as u64).read_to_end(head)?;
    let left = head_length(head).saturating_sub(head.len());
    file.by_ref().take(left as u64).read_to_end(head)
}

impl Shard {
    /// The bytes of the file, which are reproducible.
    pub(crate) fn to_bytes(&self) -> Result<Vec<u8>, ArrowError> {
        let mut fields = vec![
            Field::new("member", DataType::UInt64, false),
            Field::new("step", DataType::UInt64, false),
            Field::new("status", DataType::UInt8, false),
        ];
        fields.extend(self.names.iter().map(|name| Field::new(name, DataType::Float64, false)));
        for (section, crossings) in self.rows.crossings.iter().enumerate() {
            let list = DataType::new_list(DataType::Float64, false);
            let metadata = HashMap::from([(KEY.to_owned(), section.to_string())]);
            let field = |name: &String| Field::new(name, list.clone(), false).with_metadata(metadata.clone());
            fields.extend(crossings.names.iter().map(field));
        }
        let summary = toml::to_string(self).map_err(|error| ArrowError::ExternalError(Box::new(error)))?;
        let metadata = HashMap::from([(KEY.to_owned(), format!("{FORMAT}\n{summary}"))]);
        let schema = Arc::new(Schema::new_with_metadata(fields, metadata));
        let Rows { member, step, status, columns, crossings } = &self.rows;
        let mut arrays: Vec<ArrayRef> = vec![
            Arc::new(UInt64Array::from(member.clone())),
            Arc::new(UInt64Array::from(step.clone())),
            Arc::new(status.iter().map(|status| Some(*status as u8)).collect::<UInt8Array>()),
        ];
        arrays.extend(columns.iter().map(|column| Arc::new(Float64Array::from(column.clone())) as ArrayRef));
        for crossings in crossings {
            arrays.extend(crossings.columns.iter().map(|column| crossings.lists(column, member.len())));
        }
        let mut bytes = Vec::new();
        let mut writer = FileWriter::try_new(&mut bytes, &schema)?;
        writer.write(&RecordBatch::try_new(schema, arrays)?)?;
        writer.finish()?;
        drop(writer);
        Ok(bytes)
    }

    /// Reads a shard without its rows from the head of a file; otherwise as [`of_bytes`](Self::of_bytes).
    pub(crate) fn of_head(head: &[u8]) -> Result<Option<Self>, String> {
        let stream = head.get(MAGIC..).unwrap_or_default();
        let reader = StreamReader::try_new(stream, None).map_err(|error| error.to_string())?;
        Self::of_schema(&reader.schema())
    }

    /// Reads the bytes of a file by [`to_bytes`](Self::to_bytes), or says why they are none; `None` if another version
    /// of the format wrote them.
    pub(crate) fn of_bytes(bytes: &[u8]) -> Result<Option<Self>, String> {
        let reader = FileReader::try_new(Cursor::new(bytes), None).map_err(|error| error.to_string())?;
        let Some(mut shard) = Self::of_schema(&reader.schema())? else { return Ok(None) };
        for batch in reader {
            shard
                .append(&batch.map_err(|error| error.to_string())?)
                .ok_or("its columns are of other types or lengths")?;
        }
        Ok(Some(shard))
    }

    /// A shard without rows.
    fn of_schema(schema: &Schema) -> Result<Option<Self>, String> {
        let summary = schema.metadata().get(KEY).ok_or("it has no summary of a chunk")?;
        if summary.lines().next() != Some(FORMAT) {
            return Ok(None);
        }
        let unread = |error: toml::de::Error| format!("its summary can't be read: {}", error.message());
        let mut shard: Self = toml::from_str(summary).map_err(unread)?;
        shard.rows = Rows::of_columns(0, vec![Crossings::default(); shard.outcome.passages.len()]);
        for field in schema.fields().iter().skip(3) {
            let name = field.name().clone();
            let Some(section) = field.metadata().get(KEY) else {
                shard.names.push(name);
                shard.rows.columns.push(vec![]);
                continue;
            };
            let crossings = section.parse().ok().and_then(|section: usize| shard.rows.crossings.get_mut(section));
            let crossings = crossings.ok_or_else(|| format!("the column `{name}` is of no section"))?;
            crossings.names.push(name);
            crossings.columns.push(vec![]);
        }
        Ok(Some(shard))
    }

    fn append(&mut self, batch: &RecordBatch) -> Option<()> {
        let [member, step, status, columns @ ..] = batch.columns() else { return None };
        let first_row = self.rows.member.len();
        self.rows.member.extend(member.as_primitive_opt::<UInt64Type>()?.values());
        self.rows.step.extend(step.as_primitive_opt::<UInt64Type>()?.values());
        for status in status.as_primitive_opt::<UInt8Type>()?.values() {
            self.rows.status.push(*Status::ALL.get(usize::from(*status))?);
        }
        let (columns, lists) = columns.split_at_checked(self.rows.columns.len())?;
        for (column, more) in self.rows.columns.iter_mut().zip(columns) {
            column.extend(more.as_primitive_opt::<Float64Type>()?.values());
        }
        let mut lists = lists.iter();
        for crossings in &mut self.rows.crossings {
            for place in 0..crossings.columns.len() {
                crossings.read(place, lists.next()?, first_row)?;
            }
        }
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use super::{Crossings, FORMAT, Rows, Shard, Status};
    use crate::outcome::{Outcome, Passages};
    use crate::reduce::Moments;

    /// Two columns of one section are refused if their lists differ in length.
    #[test]
    fn columns_of_a_section_have_lists_of_the_same_lengths() {
        let lists = |row: Vec<usize>| {
            let crossings = Crossings { names: vec!["t".to_owned()], row, columns: vec![vec![1.0, 2.0, 3.0]] };
            crossings.lists(&crossings.columns[0], 4)
        };
        let (own, other) = (lists(vec![0, 2, 2]), lists(vec![0, 0, 2]));
        for (second, expected) in [(&own, Some(())), (&other, None)] {
            let mut crossings = Crossings { columns: vec![vec![]; 2], ..Crossings::default() };
            // The second batch follows four rows of the first.
            for first_row in [0, 4] {
                assert_eq!(crossings.read(0, &own, first_row), Some(()));
                assert_eq!(
                    crossings.read(1, if first_row == 0 { &own } else { second }, first_row),
                    expected.or((first_row == 0).then_some(()),)
                );
            }
            assert_eq!(crossings.row, [0, 2, 2, 4, 6, 6]);
        }
    }

    #[test]
    fn two_crossings_of_a_member_are_read_as_they_were_written() {
        let crossings =
            Crossings { names: vec!["t".to_owned()], row: vec![0, 0, 1], columns: vec![vec![0.5, 0.75, 1.0]] };
        let mut rows = Rows::of_columns(0, vec![crossings]);
        rows.push(3, 10, Status::Going, core::iter::empty());
        rows.push(3, 20, Status::Finished, core::iter::empty());
        let passages = vec![Passages { times: 3, first: Moments::NONE }];
        let shard = Shard {
            plan: u64::MAX,
            chunk: 2,
            members: 1,
            sample: 5,
            names: vec![],
            rows,
            outcome: Outcome { passages, ..Outcome::default() },
        };
        assert_eq!(Shard::of_bytes(&shard.to_bytes().unwrap()), Ok(Some(shard)));
    }

    /// A later version's file isn't damaged: its chunk must not be recomputed in its place.
    #[test]
    fn another_format_is_told_from_what_cannot_be_read() {
        let shard = Shard {
            plan: 1,
            chunk: 2,
            members: 0,
            sample: 0,
            names: vec!["x".to_owned()],
            rows: Rows::of_columns(1, vec![]),
            outcome: Outcome::default(),
        };
        let bytes = shard.to_bytes().unwrap();
        assert_eq!(Shard::of_bytes(&bytes), Ok(Some(shard)));
        let mut later = bytes.clone();
        // The format is at the beginning and in the footer.
        for (place, part) in bytes.windows(FORMAT.len()).enumerate() {
            if part == FORMAT.as_bytes() {
                later[place + FORMAT.len() - 1] = b'9';
            }
        }
        assert_eq!(Shard::of_bytes(&later), Ok(None));
        assert!(Shard::of_bytes(b"ARROW1").is_err());
    }
}
