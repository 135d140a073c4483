//! Distances, slopes, and the means of an oscillation.

use nalgebra::{Dim, Matrix, RawStorage};

/// `|a − b| / |b|` in the Euclidean (Frobenius) norm.
pub(crate) fn relative<R: Dim, C: Dim, A: RawStorage<f64, R, C>, B: RawStorage<f64, R, C>>(
    a: &Matrix<f64, R, C, A>,
    b: &Matrix<f64, R, C, B>,
) -> f64 {
    let squared: f64 = a.iter().zip(b.iter()).map(|(a, b)| (a - b).powi(2)).sum();
    (squared / b.iter().map(|b| b * b).sum::<f64>()).sqrt()
}

/// The greater of two sizes, NaN if one of them is.
pub(crate) fn greater(a: f64, b: f64) -> f64 {
    if a.is_nan() || b <= a { a } else { b }
}

/// A count of steps as a number.
#[allow(clippy::cast_precision_loss)] // far below 2⁵³
pub(crate) fn float(count: u64) -> f64 {
    count as f64
}

/// The whole number of steps `h` in the time `t`.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // small positive numbers
pub(crate) fn steps_in(t: f64, h: f64) -> u64 {
    (t / h).round() as u64
}

/// The exponent of `y ∝ x^k` by least squares in logarithms; NaN below two points.
#[allow(clippy::cast_precision_loss)] // a handful of points
pub(crate) fn exponent(points: &[(f64, f64)]) -> f64 {
    let points: Vec<_> = points.iter().map(|(x, y)| (x.ln(), y.ln())).collect();
    let count = points.len() as f64;
    let (x, y) = points.iter().fold((0.0, 0.0), |(x, y), point| (x + point.0 / count, y + point.1 / count));
    let covariance: f64 = points.iter().map(|point| (point.0 - x) * (point.1 - y)).sum();
    covariance / points.iter().map(|point| (point.0 - x).powi(2)).sum::<f64>()
}

/// The steps `coarsest`, `coarsest/2`, … of four halvings.
pub(crate) fn four_halvings(coarsest: f64) -> [f64; 5] {
    [1.0, 0.5, 0.25, 0.125, 0.0625].map(|fraction| coarsest * fraction)
}

/// Mean and extremes of an oscillating quantity over a window of steps.
///
/// The mean is weighted by `sin²`: with equal weights the oscillations that the two ends cut would make up most of it.
#[derive(Clone, Copy)]
pub(crate) struct Window {
    length: u64,
    done: u64,
    weighted: f64,
    weights: f64,
    pub(crate) lowest: f64,
    pub(crate) highest: f64,
}

impl Window {
    pub(crate) fn new(length: u64) -> Self {
        let (lowest, highest) = (f64::INFINITY, f64::NEG_INFINITY);
        Self { length, done: 0, weighted: 0.0, weights: 0.0, lowest, highest }
    }

    pub(crate) fn add(&mut self, value: f64) {
        let weight = (std::f64::consts::PI * (float(self.done) + 0.5) / float(self.length)).sin().powi(2);
        self.done += 1;
        self.weights += weight;
        self.weighted += weight * value;
        self.lowest = self.lowest.min(value);
        self.highest = self.highest.max(value);
    }

    pub(crate) fn mean(&self) -> f64 {
        self.weighted / self.weights
    }
}

/// The first and the last tenth of a run.
pub(crate) struct Tenths {
    steps: u64,
    pub(crate) first: Window,
    pub(crate) last: Window,
}

impl Tenths {
    pub(crate) fn new(steps: u64) -> Self {
        Self { steps, first: Window::new(steps / 10), last: Window::new(steps / 10) }
    }

    /// The quantity after the step of this number, from one; computed only where it counts.
    pub(crate) fn after(&mut self, step: u64, value: impl FnOnce() -> f64) {
        if step <= self.steps / 10 {
            self.first.add(value());
        } else if step > self.steps - self.steps / 10 {
            self.last.add(value());
        }
    }

    /// How far the mean has moved.
    pub(crate) fn drift(&self) -> f64 {
        (self.last.mean() - self.first.mean()).abs()
    }

    /// How much the extremes have moved, relative to the distance between them.
    pub(crate) fn extremes(&self) -> f64 {
        let moved = (self.last.lowest - self.first.lowest).abs().max((self.last.highest - self.first.highest).abs());
        moved / (self.first.highest - self.first.lowest)
    }
}
