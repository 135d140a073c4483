//! Histograms of an ensemble's columns: the table `ensemble.histogram`.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::file::mistake::SpanMessage;
use crate::file::quantity::{Any, in_si, ratio};
use crate::file::tables::measured;

/// The histogram of a column at the ends of an ensemble's members.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct EndHistogram {
    /// Name of the column.
    pub column: String,
    /// The ends of the range, in the unit of the column.
    pub range: Range<f64>,
    /// The ends of the range, in the unit of the file.
    pub written: [f64; 2],
    /// The unit of the file, or that of the column for numbers alone.
    pub unit: String,
    /// Number of equal parts of the range.
    pub parts: usize,
    pub(crate) span: Range<usize>,
}

/// Most parts of a histogram, each of which is a printed line.
const MOST_PARTS: usize = 1000;

const HISTOGRAM: &str = "a histogram is `{ from = …, to = …, count = … }`: the ends of its range, two numbers, or texts with the \
                         same unit, the second the larger, and how many parts it has, from 1 to 1000";

/// The histograms of a table, by their columns, in the order of the file.
pub(crate) fn read(table: &Spanned<DeValue<'_>>) -> Result<Vec<EndHistogram>, SpanMessage> {
    let wrong = || (table.span(), "`histogram` is a table of columns".to_owned());
    let columns = table.get_ref().as_table().ok_or_else(wrong)?;
    let of = |(column, value): (&Spanned<std::borrow::Cow<'_, str>>, &Spanned<DeValue<'_>>)| {
        let wrong = || (value.span(), HISTOGRAM.to_owned());
        let range = value.get_ref().as_table().filter(|range| range.len() == 3).ok_or_else(wrong)?;
        histogram(column.get_ref(), range, value.span()).ok_or_else(wrong)
    };
    let mut all = columns.iter().map(of).collect::<Result<Vec<_>, _>>()?;
    all.sort_by_key(|one| one.span.start);
    Ok(all)
}

impl EndHistogram {
    /// Gives ends without a unit that of the column. Returns a message where the file has a unit of another quantity.
    pub(crate) fn in_unit(&mut self, of_column: &str) -> Option<String> {
        // A gap combines a length with cosines.
        let own = of_column.split(',').next().unwrap_or_default();
        let known = if own == "1" { "" } else { own };
        if self.unit.is_empty() {
            known.clone_into(&mut self.unit);
            return None;
        }
        let fits = own.is_empty() || ratio(&self.unit, known).is_some();
        (!fits).then(|| match known {
            "" => format!("`{}` has no unit, and these ends are in `{}`", self.column, self.unit),
            known => format!("`{}` is in `{known}`, and these ends are in `{}`", self.column, self.unit),
        })
    }
}

fn histogram(column: &str, range: &DeTable<'_>, span: Range<usize>) -> Option<EndHistogram> {
    let end = |key: &str| measured(range.get(key)?.get_ref());
    let ((from, unit), (to, other)) = (end("from")?, end("to")?);
    let count = range.get("count")?.get_ref().as_integer()?;
    let parts = usize::from_str_radix(count.as_str(), count.radix()).ok()?;
    let [start, end] = [in_si::<Any>(from, &unit)?, in_si::<Any>(to, &unit)?];
    let is_range = unit == other && start < end && (end - start).is_finite() && (1..=MOST_PARTS).contains(&parts);
    let (column, written) = (column.to_owned(), [from, to]);
    is_range.then_some(EndHistogram { column, range: start..end, written, unit, parts, span })
}
