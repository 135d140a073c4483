//! Values at equal times, continued to the next one.

use core::fmt::Debug;

use crate::numbers::{Coordinates, Real, count, counted, flag, replaced};

/// What is remembered of values at equal times to guess the next one.
pub trait History<T: Real, V: Coordinates<T>>: Copy + Debug + PartialEq {
    /// Before the first value. [`Either`] is the polynomial if an iteration is expensive, and the parabola otherwise.
    fn none(is_expensive: bool) -> Self;

    /// Takes notice of the value `y` after `last`, and returns where the next one is expected.
    fn next(&mut self, last: V, y: V) -> V;

    /// Called after the first value. The value before it was an estimate, so the difference of the two is forgotten.
    fn forget_the_estimate(&mut self);

    /// A history with other numbers, as [`Kept::with_numbers`](crate::motion::Kept::with_numbers) makes a memory.
    fn with_numbers(&self, number: &mut dyn FnMut(T) -> T) -> Option<Self>;

    /// The history of the values times this.
    fn scaled(&self, ratio: T) -> Self;
}

/// The parabola through three values `y`, kept as `∇ y`.
///
/// Increments change by `O(h²)` from step to step, and their second differences by `O(h⁴)`: for (3.13) at common steps
/// Newton's iteration is left with an error that a second one, with the Jacobian of the first, brings to rounding.
///
/// The first increment of all has no difference to the one before, which counts as zero; the guess after the second is
/// that much worse.
#[derive(Clone, Copy, Debug, PartialEq, Lanes)]
pub struct Parabola<V> {
    difference: V,
}

impl<T: Real, V: Coordinates<T>> History<T, V> for Parabola<V> {
    fn none(_: bool) -> Self {
        Self { difference: V::zero() }
    }

    /// `y + ∇ y + ∇² y`.
    #[hot]
    fn next(&mut self, last: V, y: V) -> V {
        let difference = y - last;
        let before = core::mem::replace(&mut self.difference, difference);
        y + (difference + (difference - before))
    }

    /// Otherwise the parabola would go through the estimate.
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

/// Of increments at equal times eight tell the next to some `(h ω)⁸` for the fastest frequency `ω` in them. Each more
/// would double the roundings in the guess, and gains little where `h ω` is near one.
const DIFFERENCES: usize = 7;

/// The polynomial through as many values `y` as are known, kept as the backward differences `∇ y, ∇² y, …`: where an
/// iteration is expensive.
#[derive(Clone, Copy, Debug, PartialEq, Lanes)]
pub struct Polynomial<V> {
    differences: [V; DIFFERENCES],
    /// The number of values that were seen, at most one more than there are differences.
    #[shared]
    values: usize,
}

impl<T: Real, V: Coordinates<T>> History<T, V> for Polynomial<V> {
    fn none(_: bool) -> Self {
        Self { differences: [V::zero(); DIFFERENCES], values: 0 }
    }

    /// `y + ∇ y + ∇² y + …`.
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

    /// The first value has been compared with nothing.
    fn forget_the_estimate(&mut self) {}

    fn with_numbers(&self, number: &mut dyn FnMut(T) -> T) -> Option<Self> {
        let values = counted(number(count(self.values))).filter(|&values| values <= DIFFERENCES + 1)?;
        Some(Self { differences: self.differences.map(|difference| replaced(&difference, number)), values })
    }

    fn scaled(&self, ratio: T) -> Self {
        Self { differences: self.differences.map(|difference| difference * ratio), ..*self }
    }
}

/// One of both, as the program knows only when it runs.
#[derive(Clone, Copy, Debug, PartialEq, Lanes)]
pub struct Either<V> {
    #[shared]
    is_long: bool,
    parabola: Parabola<V>,
    polynomial: Polynomial<V>,
}

impl<T: Real, V: Coordinates<T>> History<T, V> for Either<V> {
    fn none(is_expensive: bool) -> Self {
        let (parabola, polynomial) = (Parabola::none(is_expensive), Polynomial::none(is_expensive));
        Self { is_long: is_expensive, parabola, polynomial }
    }

    #[hot]
    fn next(&mut self, last: V, y: V) -> V {
        if self.is_long { self.polynomial.next(last, y) } else { self.parabola.next(last, y) }
    }

    fn forget_the_estimate(&mut self) {
        // The polynomial has never used the estimate.
        self.parabola = Parabola::none(self.is_long);
    }

    fn with_numbers(&self, number: &mut dyn FnMut(T) -> T) -> Option<Self> {
        let is_long = flag(self.is_long, number)?;
        let parabola = self.parabola.with_numbers(number)?;
        Some(Self { is_long, parabola, polynomial: self.polynomial.with_numbers(number)? })
    }

    fn scaled(&self, ratio: T) -> Self {
        Self { parabola: self.parabola.scaled(ratio), polynomial: self.polynomial.scaled(ratio), ..*self }
    }
}

#[cfg(test)]
mod tests {
    use super::{DIFFERENCES, History as _, Parabola, Polynomial};
    use alloc::vec::Vec;
    use nalgebra::Vector1;

    /// A polynomial of as high a degree as there are differences goes on as it was; one of a higher degree doesn't.
    #[test]
    fn a_polynomial_is_continued() {
        let errors = [DIFFERENCES, DIFFERENCES + 1].map(|degree| {
            let value = |i: i32| Vector1::new((0.1 * f64::from(i)).powi(i32::try_from(degree).unwrap()));
            let mut history = Polynomial::none(true);
            let (mut last, mut guess) = (value(0), value(0));
            for i in 0..20 {
                guess = history.next(last, value(i));
                last = value(i);
            }
            (guess - value(20)).norm() / value(20).norm()
        });
        assert!(errors[0] < 1e-12 && errors[1] > 1e-9, "{errors:?}");
    }

    /// The parabola through three values goes on as it was; a cubic doesn't, by its third difference.
    #[test]
    fn a_parabola_is_continued() {
        for (cubic, missing) in [(0.0, 0.0), (1.0, 6.0)] {
            let value = |i: i32| {
                let i = f64::from(i);
                Vector1::new(3.0 - 2.0 * i + 5.0 * i * i + cubic * i * i * i)
            };
            let mut history = Parabola::none(false);
            let guesses: Vec<_> = (1..6).map(|i| history.next(value(i - 1), value(i))).collect();
            for (i, guess) in (2..).zip(&guesses).skip(1) {
                assert_eq!(value(i) - guess, Vector1::new(missing), "increment {i}");
            }
        }
    }

    /// At the beginning there is one point, then a line, a parabola and so on.
    #[test]
    fn it_starts_with_what_there_is() {
        let mut history = Polynomial::none(true);
        let nothing = Vector1::new(100.0);
        assert_eq!(history.next(nothing, Vector1::new(1.0)), Vector1::new(1.0));
        assert_eq!(history.next(Vector1::new(1.0), Vector1::new(4.0)), Vector1::new(7.0));
        assert_eq!(history.next(Vector1::new(4.0), Vector1::new(9.0)), Vector1::new(16.0));
    }
}
