//! Signals: quantities by their values at times.

use thiserror::Error;

/// The values between the times of a [`Signal`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Between {
    /// A value holds until the next time, and the last one on.
    Steps,
    /// Values lie on straight lines; after the last time there is none.
    Lines,
}

/// A quantity of one or several numbers over time, by its values at times.
///
/// Its mean over a step is exact, so that a force has its impulse wherever its corners lie between steps. Before the first
/// time there is no value, and by [`Between::Lines`] none after the last.
///
/// # Examples
///
/// ```
/// use liestep_late::{Between, Signal};
///
/// // On from 0.7 s to 2.2 s.
/// let torque = Signal::new(vec![0.0, 0.7, 2.2], vec![0.0, 2.0, 0.0], Between::Steps)?;
/// let mut mean = [0.0];
/// torque.mean([0.4, 0.4], &mut mean);
/// assert!((mean[0] - 0.5).abs() < 1e-15);
/// # Ok::<(), liestep_late::SignalError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Signal {
    times: Vec<f64>,
    values: Vec<f64>,
    width: usize,
    between: Between,
}

/// The reason why times and values are no signal.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SignalError {
    /// There is no time, or by lines one only.
    #[error("a signal has a time at least, and by lines two")]
    TooFew,
    /// A time isn't after the one before.
    #[error("the times of a signal increase, and that of number {number} doesn't")]
    NotIncreasing {
        /// The number of the time, from one.
        number: usize,
    },
    /// The values aren't as many as the times, or as a multiple of them.
    #[error("a signal has a value for each time: {times} times, and {values} numbers of values")]
    Length {
        /// The number of times.
        times: usize,
        /// The number of numbers of all values.
        values: usize,
    },
    /// A time or a value isn't finite.
    #[error("a time or a value of a signal isn't finite")]
    NonFinite,
}

/// The rounding of times, relative to the signal's length, by which a step may reach beyond its ends.
const ROUNDING: f64 = 1e-12;

impl Signal {
    /// The signal of increasing times, s, and of the numbers of all values, one value after the other.
    ///
    /// # Errors
    ///
    /// See [`SignalError`].
    pub fn new(times: Vec<f64>, values: Vec<f64>, between: Between) -> Result<Self, SignalError> {
        if times.is_empty() || between == Between::Lines && times.len() < 2 {
            return Err(SignalError::TooFew);
        }
        if !times.iter().chain(&values).all(|number| number.is_finite()) {
            return Err(SignalError::NonFinite);
        }
        if let Some(before) = times.windows(2).position(|pair| pair[0] >= pair[1]) {
            return Err(SignalError::NotIncreasing { number: before + 2 });
        }
        let width = values.len() / times.len();
        if width == 0 || width * times.len() != values.len() {
            return Err(SignalError::Length { times: times.len(), values: values.len() });
        }
        Ok(Self { times, values, width, between })
    }

    /// The number of numbers of a value.
    #[must_use]
    pub const fn width(&self) -> usize {
        self.width
    }

    /// The values, one after the other.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The first time with a value, and the last one, s.
    #[must_use]
    pub fn ends(&self) -> [f64; 2] {
        let last = self.times[self.times.len() - 1];
        [self.times[0], if self.between == Between::Steps { f64::INFINITY } else { last }]
    }

    /// A time within the ends up to rounding; none outside.
    fn within(&self, time: f64) -> Option<f64> {
        let [first, last] = self.ends();
        let rounding = ROUNDING * (self.times[self.times.len() - 1] - first).max(time.abs());
        (time >= first - rounding && time <= last + rounding).then(|| time.clamp(first, last))
    }

    /// The number of the last time up to this one, with another one behind it if values are on lines.
    fn piece(&self, time: f64) -> usize {
        let most = self.times.len() - usize::from(self.between == Between::Lines);
        self.times.partition_point(|&own| own <= time).clamp(1, most) - 1
    }

    /// A component on the piece of this number.
    fn on(&self, piece: usize, time: f64, component: usize) -> f64 {
        let value = |at: usize| self.values[at * self.width + component];
        if self.between == Between::Steps {
            return value(piece);
        }
        let share = (time - self.times[piece]) / (self.times[piece + 1] - self.times[piece]);
        value(piece) * (1.0 - share) + value(piece + 1) * share
    }

    /// Writes the value at a time, s; NaN where there is none.
    pub fn at(&self, time: f64, value: &mut [f64]) {
        let Some(time) = self.within(time) else { return value.fill(f64::NAN) };
        let piece = self.piece(time);
        value.iter_mut().enumerate().for_each(|(component, number)| *number = self.on(piece, time, component));
    }

    /// Adds to the derivatives of a scalar by all values those by the mean over a step of this start and length, s; by the value at
    /// the start, where the length is zero.
    pub fn slopes(&self, [start, length]: [f64; 2], by_mean: &[f64], by_values: &mut [f64]) {
        let end = start + length;
        let (Some(from), Some(to)) = (self.within(start.min(end)), self.within(start.max(end))) else { return };
        let next = |piece: usize| self.times.get(piece + 1).copied().unwrap_or(f64::INFINITY);
        let mut add = |piece: usize, time: f64, weight: f64| {
            let share = if self.between == Between::Steps {
                0.0
            } else {
                (time - self.times[piece]) / (self.times[piece + 1] - self.times[piece])
            };
            for (at, part) in [(piece, 1.0 - share), (piece + 1, share)].into_iter().filter(|(_, part)| *part != 0.0) {
                let own = by_values.iter_mut().skip(at * self.width).zip(by_mean);
                own.for_each(|(sum, slope)| *sum += slope * weight * part);
            }
        };
        let (mut piece, mut begin) = (self.piece(from), from);
        if from >= to {
            return add(piece, from, 1.0);
        }
        while begin < to {
            let close = next(piece).min(to);
            add(piece, begin + (close - begin) * 0.5, (close - begin) / (to - from));
            (piece, begin) = (piece + 1, close);
        }
    }

    /// Writes the mean over a step of this start and length, s; NaN where there is none.
    pub fn mean(&self, [start, length]: [f64; 2], value: &mut [f64]) {
        let end = start + length;
        let (Some(from), Some(to)) = (self.within(start.min(end)), self.within(start.max(end))) else {
            return value.fill(f64::NAN);
        };
        let first = self.piece(from);
        let next = |piece: usize| self.times.get(piece + 1).copied().unwrap_or(f64::INFINITY);
        if to <= next(first) || from >= to {
            let middle = from + (to - from) * 0.5;
            return value.iter_mut().enumerate().for_each(|(at, number)| *number = self.on(first, middle, at));
        }
        value.fill(0.0);
        let (mut piece, mut begin) = (first, from);
        while begin < to {
            let close = next(piece).min(to);
            let middle = begin + (close - begin) * 0.5;
            let share = (close - begin) / (to - from);
            value.iter_mut().enumerate().for_each(|(at, number)| *number += self.on(piece, middle, at) * share);
            (piece, begin) = (piece + 1, close);
        }
    }
}
