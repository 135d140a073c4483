//! Extrapolation of values at equal times to the next one.

use core::fmt::Debug;

use crate::numbers::{Coordinates, Real, count, counted, replaced};

/// The memory of an extrapolation from values at equal times.
pub trait History<T: Real, V: Coordinates<T>>: Copy + Debug + PartialEq {
    /// The history before the first value.
    fn none() -> Self;

    /// Records the value `y` after `last`, and returns the extrapolated next one.
    fn next(&mut self, last: V, y: V) -> V;

    /// Discards the first difference. Called after the first value, as the value before it was an estimate.
    fn forget_the_estimate(&mut self);

    /// The history with other numbers, as [`Kept::with_numbers`](crate::motion::Kept::with_numbers) replaces those of a
    /// memory.
    fn with_numbers(&self, number: &mut dyn FnMut(T) -> T) -> Option<Self>;

    /// The history of the values multiplied by `ratio`.
    fn scaled(&self, ratio: T) -> Self;
}

/// The parabola through three values `y`, stored as `∇ y`.
///
/// Increments change by `O(h²)` from step to step, and their second differences by `O(h⁴)`. For (3.13) at common steps
/// Newton's first iteration leaves an error that a second one, with the Jacobian of the first, reduces to rounding.
///
/// The first increment has no earlier difference, which is taken as zero; the guess after the second increment is less
/// accurate for it.
#[derive(Clone, Copy, Debug, PartialEq, Lanes)]
pub struct Parabola<V> {
    difference: V,
}

impl<T: Real, V: Coordinates<T>> History<T, V> for Parabola<V> {
    fn none() -> Self {
        Self { difference: V::zero() }
    }

    /// The value `y + ∇ y + ∇² y`.
    #[hot]
    fn next(&mut self, last: V, y: V) -> V {
        let difference = y - last;
        let before = core::mem::replace(&mut self.difference, difference);
        y + (difference + (difference - before))
    }

    /// The parabola would pass through the estimate.
    fn forget_the_estimate(&mut self) {
        *self = Self { difference: V::zero() };
    }

    fn with_numbers(&self, number: &mut dyn FnMut(T) -> T) -> Option<Self> {
        Some(Self { difference: replaced(&self.difference, number) })
    }

    fn scaled(&self, ratio: T) -> Self {
        Self { difference: self.difference * ratio }
    }
}

/// Limit of the backward differences. Eight increments at equal times predict the next to some `(h ω)⁸` for their
/// fastest frequency `ω`. Each further one would double the rounding in the guess, and gains little if `h ω` is near
/// one.
const DIFFERENCES: usize = 7;

/// The polynomial through all known values `y`, stored as the backward differences `∇ y, ∇² y, …`, for expensive
/// iterations and smooth motions.
#[derive(Clone, Copy, Debug, PartialEq, Lanes)]
pub struct Polynomial<V> {
    differences: [V; DIFFERENCES],
    /// The number of recorded values, at most one more than there are differences.
    #[shared]
    values: usize,
}

impl<T: Real, V: Coordinates<T>> History<T, V> for Polynomial<V> {
    fn none() -> Self {
        Self { differences: [V::zero(); DIFFERENCES], values: 0 }
    }

    /// The value `y + ∇ y + ∇² y + …`.
    #[hot]
    fn next(&mut self, last: V, y: V) -> V {
        let (mut difference, mut guess) = (y - last, y);
        for known in self.differences.iter_mut().take(self.values) {
            guess = guess + difference;
            let before = core::mem::replace(known, difference);
            difference = difference - before;
        }
        self.values = (self.values + 1).min(DIFFERENCES + 1);
        guess
    }

    /// The first value has no difference.
    fn forget_the_estimate(&mut self) {}

    fn with_numbers(&self, number: &mut dyn FnMut(T) -> T) -> Option<Self> {
        let values = counted(number(count(self.values))).filter(|&values| values <= DIFFERENCES + 1)?;
        Some(Self { differences: self.differences.map(|difference| replaced(&difference, number)), values })
    }

    fn scaled(&self, ratio: T) -> Self {
        Self { differences: self.differences.map(|difference| difference * ratio), ..*self }
    }
}

#[cfg(test)]
mod tests {
    use super::{DIFFERENCES, History as _, Parabola, Polynomial};
    use alloc::vec::Vec;
    use nalgebra::Vector1;

    /// A polynomial of a degree up to the number of differences is extrapolated exactly; one of a higher degree isn't.
    #[test]
    fn a_polynomial_is_continued() {
        let errors = [DIFFERENCES, DIFFERENCES + 1].map(|degree| {
            let value = |i: i32| Vector1::new((0.1 * f64::from(i)).powi(i32::try_from(degree).unwrap()));
            let mut history = Polynomial::none();
            let (mut last, mut guess) = (value(0), value(0));
            for i in 0..20 {
                guess = history.next(last, value(i));
                last = value(i);
            }
            (guess - value(20)).norm() / value(20).norm()
        });
        assert!(errors[0] < 1e-12 && errors[1] > 1e-9, "{errors:?}");
    }

    /// A parabola is extrapolated exactly; a cubic is off by its third difference.
    #[test]
    fn a_parabola_is_continued() {
        for (cubic, missing) in [(0.0, 0.0), (1.0, 6.0)] {
            let value = |i: i32| {
                let i = f64::from(i);
                Vector1::new(3.0 - 2.0 * i + 5.0 * i * i + cubic * i * i * i)
            };
            let mut history = Parabola::none();
            let guesses: Vec<_> = (1..6).map(|i| history.next(value(i - 1), value(i))).collect();
            for (i, guess) in (2..).zip(&guesses).skip(1) {
                assert_eq!(value(i) - guess, Vector1::new(missing), "increment {i}");
            }
        }
    }

    /// The extrapolation begins with a constant, then a line, a parabola and so on.
    #[test]
    fn it_starts_with_what_there_is() {
        let mut history = Polynomial::none();
        let nothing = Vector1::new(100.0);
        assert_eq!(history.next(nothing, Vector1::new(1.0)), Vector1::new(1.0));
        assert_eq!(history.next(Vector1::new(1.0), Vector1::new(4.0)), Vector1::new(7.0));
        assert_eq!(history.next(Vector1::new(4.0), Vector1::new(9.0)), Vector1::new(16.0));
    }
}
