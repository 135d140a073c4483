//! The end of a run, as a row for the table of a sweep.

use crate::file::column::Column;
use crate::file::scene::Scene;
use crate::run::make::Run;

impl Scene {
    /// The columns of the deviations from what is conserved.
    fn errors(&self) -> Vec<Column> {
        let mut all = self.file.all_columns();
        all.retain(|column| ["energy-error", "momentum-error"].contains(&column.key()));
        all
    }

    /// The names of the numbers of [`end`](Self::end).
    #[must_use]
    pub fn end_names(&self) -> Vec<String> {
        let columns = self.columns().iter().flat_map(Column::names).map(str::to_owned);
        let errors = self.errors();
        let greatest = errors.iter().flat_map(Column::names).map(|name| format!("greatest_{name}"));
        let events = self.events().flat_map(|name| [format!("{name}_times"), format!("{name}_first")]);
        std::iter::once("t".to_owned()).chain(columns).chain(greatest).chain(events).collect()
    }

    /// The time and the scene's columns at the end of a run; the greatest deviations of the energy, and of one body or a
    /// Lagrangian of the momentum in space, from their start; each event's count, and the time of its first, s, or NaN.
    ///
    /// The greatest deviations are those of the [samples](Run::samples), which are all steps of a run of up to 20 000;
    /// NaN where a sample has no value.
    #[must_use]
    pub fn end(&self, run: &Run) -> Vec<f64> {
        let (Some(first), Some(last)) = (run.samples().first(), run.samples().last()) else { return Vec::new() };
        let of_errors = self.errors();
        let mut greatest = vec![0.0_f64; of_errors.len()];
        for sample in run.samples() {
            let errors = Column::row(&of_errors, first, sample);
            for (greatest, value) in greatest.iter_mut().zip(errors) {
                // `max` would ignore a NaN.
                *greatest = if greatest.is_nan() || value.is_nan() { f64::NAN } else { greatest.max(value.abs()) };
            }
        }
        let columns = std::iter::once(last.time).chain(Column::row(self.columns(), first, last));
        columns.chain(greatest).chain(run.counts(self.events().count())).collect()
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
