//! The end of a run, as a row for the table of a sweep.

use crate::file::column::Column;
use crate::file::scene::SceneFile;
use crate::file::system::System;
use crate::run::make::Run;

impl SceneFile {
    /// The names of the numbers of [`end`](Self::end).
    #[must_use]
    pub fn end_names(&self) -> Vec<String> {
        let columns = self.columns().iter().flat_map(Column::names);
        let columns = std::iter::once("t")
            .chain(columns)
            .chain(["greatest_energy_error", "greatest_momentum_error"])
            .map(str::to_owned);
        let events = self.events().flat_map(|name| [format!("{name}_times"), format!("{name}_first")]);
        columns.chain(events).collect()
    }

    /// The time and the scene's columns at the end of a run; the greatest deviations of energy and angular momentum in
    /// space from their start; each event's count, and the time of its first, s, or NaN.
    ///
    /// The greatest deviations are those of the [samples](Run::samples), which are all steps of a run of up to 20 000;
    /// NaN where a sample has no value.
    #[must_use]
    pub fn end(&self, run: &Run) -> Vec<f64> {
        let (Some(first), Some(last)) = (run.samples().first(), run.samples().last()) else { return Vec::new() };
        let of_errors: Vec<Column> = Column::of_group(&self.group)
            .into_iter()
            .filter(|column| ["energy-error", "momentum-error"].contains(&column.key()))
            .collect();
        let mut greatest = [0.0_f64; 2];
        for sample in run.samples() {
            let errors = Column::row(&of_errors, first, sample);
            for (greatest, value) in greatest.iter_mut().zip(errors) {
                // `max` would ignore a NaN.
                *greatest = if greatest.is_nan() || value.is_nan() { f64::NAN } else { greatest.max(value.abs()) };
            }
        }
        let columns = std::iter::once(last.time).chain(Column::row(self.columns(), first, last));
        columns.chain(greatest).chain(run.counts(self.event.len())).collect()
    }
}

impl System {
    /// The names of the numbers of [`end`](Self::end).
    #[must_use]
    pub fn end_names(&self) -> Vec<String> {
        let columns = std::iter::once("t".to_owned()).chain(self.columns().into_iter().map(|column| column.name));
        let events = self.events().flat_map(|name| [format!("{name}_times"), format!("{name}_first")]);
        columns.chain(std::iter::once("greatest_energy_error".to_owned())).chain(events).collect()
    }

    /// The time and the columns at the end of a run, the greatest deviation of the energy from its start, and each event's count
    /// and first time, see [`SceneFile::end`].
    #[must_use]
    pub fn end(&self, run: &Run) -> Vec<f64> {
        let (Some(first), Some(last)) = (run.samples().first(), run.samples().last()) else { return Vec::new() };
        let errors = run.samples().iter().map(|sample| (sample.energy - first.energy).abs());
        // `max` would ignore a NaN.
        let greatest = errors.fold(0.0_f64, |most, error| if error <= most { most } else { error });
        let columns = std::iter::once(last.time).chain(Column::row(&self.columns, first, last));
        columns.chain(std::iter::once(greatest)).chain(run.counts(self.events().count())).collect()
    }
}

impl Run {
    /// The count of each event and the time of its first, s, or NaN.
    fn counts(&self, events: usize) -> impl Iterator<Item = f64> {
        (0..events).flat_map(|number| {
            let mut times = self.times(number);
            let first = times.next();
            #[allow(clippy::cast_precision_loss)] // a million at most
            let count = (times.count() + usize::from(first.is_some())) as f64;
            [count, first.unwrap_or(f64::NAN)]
        })
    }
}
