//! The means of an oscillation at the beginning and at the end of a run.

/// The greater of two sizes, NaN if one of them is.
pub fn greater(a: f64, b: f64) -> f64 {
    if a.is_nan() || b <= a { a } else { b }
}

/// A count of steps as a number.
#[allow(clippy::cast_precision_loss)] // far below 2⁵³
pub fn float(count: u64) -> f64 {
    count as f64
}

/// The mean and the extremes of an oscillating quantity over a window of steps.
///
/// The mean is weighted by `sin²`: with equal weights the incomplete oscillations at both ends would dominate it.
#[derive(Clone, Copy)]
pub struct Window {
    length: u64,
    done: u64,
    weighted: f64,
    weights: f64,
    pub lowest: f64,
    pub highest: f64,
}

impl Window {
    pub fn new(length: u64) -> Self {
        let (lowest, highest) = (f64::INFINITY, f64::NEG_INFINITY);
        Self { length, done: 0, weighted: 0.0, weights: 0.0, lowest, highest }
    }

    pub fn add(&mut self, value: f64) {
        let weight = (std::f64::consts::PI * (float(self.done) + 0.5) / float(self.length)).sin().powi(2);
        self.done += 1;
        self.weights += weight;
        self.weighted += weight * value;
        self.lowest = self.lowest.min(value);
        self.highest = self.highest.max(value);
    }

    pub fn mean(&self) -> f64 {
        self.weighted / self.weights
    }
}

/// The first and the last tenth of a run.
pub struct Tenths {
    steps: u64,
    pub first: Window,
    pub last: Window,
}

impl Tenths {
    pub fn new(steps: u64) -> Self {
        Self { steps, first: Window::new(steps / 10), last: Window::new(steps / 10) }
    }

    /// Adds the quantity after the step of this number, from one; it is evaluated only inside of the two windows.
    pub fn after(&mut self, step: u64, value: impl FnOnce() -> f64) {
        if step <= self.steps / 10 {
            self.first.add(value());
        } else if step > self.steps - self.steps / 10 {
            self.last.add(value());
        }
    }

    /// The drift of the mean between the two tenths.
    pub fn drift(&self) -> f64 {
        (self.last.mean() - self.first.mean()).abs()
    }

    /// The drift of the extremes, relative to the distance between them.
    pub fn extremes(&self) -> f64 {
        let moved = (self.last.lowest - self.first.lowest).abs().max((self.last.highest - self.first.highest).abs());
        moved / (self.first.highest - self.first.lowest)
    }
}
