//! The events of a run, as a table and in words.

use std::error::Error;

use liestep::recording::{self, Csv, Sink as _};

use crate::file::column::Column;
use crate::run::make::Run;

impl Run {
    /// The events as comma-separated values: name, 1 where the quantity rose and 0 where it fell, time, and these columns.
    pub(crate) fn event_table<'a>(
        &self,
        columns: &[Column],
        names: impl Iterator<Item = &'a str>,
    ) -> Result<String, Box<dyn Error + Send + Sync>> {
        let mut rows = Csv::new(Vec::new());
        let time = recording::Column { name: "t".to_owned(), unit: "s".to_owned() };
        rows.begin(&std::iter::once(time).chain(Column::listed(columns)).collect::<Vec<_>>())?;
        let first = self.samples().first();
        let mut before = first.cloned();
        for happening in self.happenings() {
            let mut now = happening.sample.clone();
            if let Some(before) = &before {
                now.follow(before);
            }
            let numbers = Column::row(columns, first.unwrap_or(&now), &now);
            rows.write(&std::iter::once(now.time).chain(numbers).collect::<Vec<_>>())?;
            before = Some(now);
        }
        let rows = String::from_utf8(rows.into_inner()?)?;
        let mut rows = rows.lines();
        let mut text = format!("event,rising,{}\n", rows.next().unwrap_or_default());
        let names: Vec<_> = names.collect();
        for (happening, row) in self.happenings().iter().zip(rows) {
            let name = names.get(happening.event).copied().unwrap_or_default();
            text.extend([name, if happening.rising { ",1," } else { ",0," }, row, "\n"]);
        }
        Ok(text)
    }

    /// A line for each event: how often it happened, and when first.
    pub(crate) fn events_in_words<'a>(&self, names: impl Iterator<Item = &'a str>) -> String {
        let line = |(number, name): (usize, &str)| {
            let mut times = self.times(number);
            let (first, others) = (times.next(), times.count());
            let when = first.map_or_else(String::new, |first| format!(", first at t = {first} s"));
            let ending = if self.ending == Some(number) { ", which ended the run" } else { "" };
            let often = match others + usize::from(first.is_some()) {
                1 => "once".to_owned(),
                count => format!("{count} times"),
            };
            format!("\n  {name}: {often}{when}{ending}")
        };
        names.enumerate().map(line).collect()
    }
}
