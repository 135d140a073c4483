//! Runs of one method with ever shorter steps, as a table.

/// A run with one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measurement {
    /// The step `h`, s; the tolerance for a method that chooses its steps.
    pub step: f64,
    /// The error at the end of the run.
    pub error: f64,
    /// The iterations of a step on average, if they were counted: Newton's, or those of a fixed point.
    pub iterations: Option<f64>,
    /// The time of the run, s, if it was measured.
    pub seconds: Option<f64>,
}

/// The results of one method with ever shorter steps: [`convergence`](crate::convergence) runs it, and
/// [`work_precision`](crate::work_precision) also measures times.
///
/// Its text is a table, and [`to_csv`](Self::to_csv) and [`to_json`](Self::to_json) write the same columns; with the
/// feature `serde` it serialises as the latter does. Other errors, of another library for example, come in by
/// [`of`](Self::of) and [`timed`](Self::timed), and whole rows are collected.
///
/// | column | |
/// |---|---|
/// | `step` | `h`, s |
/// | `error` | at the end |
/// | `ratio` | the error before, divided by this one |
/// | `order` | the power of the step by which the error has fallen: `ln ratio / ln (h before / h)` |
/// | `iterations` | of a step on average |
/// | `seconds` | of the run |
///
/// A missing number is empty in CSV and `null` in JSON.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Refinement {
    rows: Vec<Measurement>,
}

/// The least number of points for a slope, so that it isn't that of a plateau's edge.
const FEWEST_POINTS: usize = 4;

impl Refinement {
    /// A refinement of steps and errors, in the order of the runs.
    ///
    /// # Examples
    ///
    /// The trapezoidal rule for `∫₀¹ eˣ dx`:
    ///
    /// ```
    /// use liestep_refinement::Refinement;
    ///
    /// let rule = |n: i32| {
    ///     let h = 1.0 / f64::from(n);
    ///     let inner: f64 = (1..n).map(|i| (f64::from(i) * h).exp()).sum();
    ///     (h, (h * (inner + 0.5 * (1.0 + 1_f64.exp())) - (1_f64.exp() - 1.0)).abs())
    /// };
    /// let refinement = Refinement::of([10, 20, 40, 80].map(rule));
    /// assert!((refinement.order_above(1e-14).ok_or("too few errors")? - 2.0).abs() < 0.01);
    /// # Ok::<(), &str>(())
    /// ```
    #[must_use]
    pub fn of(errors: impl IntoIterator<Item = (f64, f64)>) -> Self {
        let row = |(step, error)| Measurement { step, error, iterations: None, seconds: None };
        errors.into_iter().map(row).collect()
    }

    /// The rows, in the order of the runs.
    #[must_use]
    pub fn rows(&self) -> &[Measurement] {
        &self.rows
    }

    /// The ratio of the error before to its own, for each run but the first.
    pub fn ratios(&self) -> impl Iterator<Item = f64> + '_ {
        self.rows.windows(2).map(|pair| pair[0].error / pair[1].error)
    }

    /// The power of the step by which the error has fallen, for each run but the first.
    pub fn orders(&self) -> impl Iterator<Item = f64> + '_ {
        self.ratios().zip(self.rows.windows(2)).map(|(ratio, pair)| ratio.ln() / (pair[0].step / pair[1].step).ln())
    }

    /// The order: the slope of `ln error` over `ln h` by least squares, over the runs whose error is above the plateau
    /// of rounding, finite and not zero.
    ///
    /// `None` if fewer than four are, so that a slope isn't read off the edge of a plateau, or if all have one step.
    #[must_use]
    #[allow(clippy::cast_precision_loss, clippy::float_cmp)] // a handful of runs, and steps that are one to the last bit
    pub fn order_above(&self, plateau: f64) -> Option<f64> {
        let above = self.rows.iter().filter(|row| row.error > plateau);
        let logarithms = above.map(|row| (row.step.abs().ln(), row.error.ln()));
        let points: Vec<(f64, f64)> = logarithms.filter(|(x, y)| x.is_finite() && y.is_finite()).collect();
        if points.len() < FEWEST_POINTS || points.iter().all(|point| point.0 == points[0].0) {
            return None;
        }
        let count = points.len() as f64;
        let (x, y) = points.iter().fold((0.0, 0.0), |(x, y), point| (x + point.0 / count, y + point.1 / count));
        let covariance: f64 = points.iter().map(|point| (point.0 - x) * (point.1 - y)).sum();
        Some(covariance / points.iter().map(|point| (point.0 - x).powi(2)).sum::<f64>())
    }

    /// The least time in which the runs reach an error, s: that of a run, or of a point on the straight line between
    /// two runs, both axes logarithmic. `None` if no run comes so near, or no times were measured.
    #[must_use]
    pub fn seconds_to(&self, error: f64) -> Option<f64> {
        let reached = self.rows.iter().filter(|row| row.error <= error).filter_map(|row| row.seconds);
        let between = self.rows.windows(2).filter_map(|pair| {
            let [coarse, fine] = [pair[0], pair[1]];
            let crosses = coarse.error > error && fine.error <= error;
            let part = (coarse.error / error).ln() / (coarse.error / fine.error).ln();
            let [cheap, dear] = [coarse.seconds?, fine.seconds?];
            // An error of zero has no logarithm.
            (crosses && fine.error > 0.0).then(|| cheap * (dear / cheap).powf(part))
        });
        reached.chain(between).min_by(f64::total_cmp)
    }
}

/// Collects other rows, in the order of the runs.
impl FromIterator<Measurement> for Refinement {
    fn from_iter<R: IntoIterator<Item = Measurement>>(rows: R) -> Self {
        Self { rows: rows.into_iter().collect() }
    }
}
