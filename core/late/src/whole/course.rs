//! Parameters that change with time.

/// Numbers of all parameters as functions of the time since the start, s.
///
/// A function `Fn(f64, &mut [f64])` is one, whose mean over a step is its value in the middle.
pub trait Course {
    /// Writes the numbers at a time over those of the start; NaN where there are none.
    fn at(&self, time: f64, numbers: &mut [f64]);

    /// Writes the means of the numbers over a step of this start and length, s.
    fn over(&self, [start, length]: [f64; 2], numbers: &mut [f64]) {
        self.at(start + length * 0.5, numbers);
    }
}

impl<F: Fn(f64, &mut [f64])> Course for F {
    fn at(&self, time: f64, numbers: &mut [f64]) {
        self(time, numbers);
    }
}
