//! Increments that have been, to guess the next one.

use crate::numbers::{Coordinates, Real};

/// Of increments at equal times eight tell the next to some `(h ω)⁸` for the fastest frequency `ω` in them. Each more
/// would double the roundings in the guess, and gains little where `h ω` is near one.
pub(crate) const DIFFERENCES: usize = 7;

/// What increments are continued by to guess the next one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Continued {
    /// The line through two, for steps so long that a parabola strays farther.
    Line,
    /// The parabola through three.
    Parabola,
    /// The polynomial through as many as are known, where an iteration is dear.
    Polynomial,
}

impl Continued {
    /// By what a solve of a Lagrangian costs.
    pub(crate) const fn for_jacobian(is_dear: bool) -> Self {
        if is_dear { Self::Polynomial } else { Self::Parabola }
    }
}

/// The backward differences `∇ y, ∇² y, …` of the last increments `y`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct History<V> {
    differences: [V; DIFFERENCES],
    /// How many increments have been taken notice of; more than there are differences count as one more.
    increments: usize,
}

impl<V: Copy> History<V> {
    pub(crate) fn new<T: Real>() -> Self
    where
        V: Coordinates<T>,
    {
        Self { differences: [V::zero(); DIFFERENCES], increments: 0 }
    }

    /// Takes notice of the increment after `last`, and returns `y + ∇ y + ∇² y`: where the parabola through three of
    /// them goes next. Increments change by `O(h²)` from step to step, and their second differences by `O(h⁴)`: for
    /// (3.13) at common steps Newton's iteration is left with an error that a second one, with the Jacobian of the
    /// first, brings to rounding.
    ///
    /// The first increment of all has no difference to the one before, which counts as zero; the guess after the second
    /// is that much worse.
    #[inline(always)]
    pub(crate) fn parabola<T: Real>(&mut self, last: V, y: V) -> V
    where
        V: Coordinates<T>,
    {
        let difference = y - last;
        let before = core::mem::replace(&mut self.differences[0], difference);
        self.increments = 2;
        y + (difference + (difference - before))
    }

    /// Takes notice of the increment after `last`, and returns `y + ∇ y + ∇² y + …`: where the polynomial through all
    /// of them goes next.
    #[inline(always)]
    pub(crate) fn next<T: Real>(&mut self, last: V, y: V) -> V
    where
        V: Coordinates<T>,
    {
        let (mut difference, mut guess) = (y - last, y);
        for known in self.differences.iter_mut().take(self.increments) {
            guess = guess + difference;
            let before = core::mem::replace(known, difference);
            difference = difference - before;
        }
        self.increments = (self.increments + 1).min(DIFFERENCES + 1);
        guess
    }
}

#[cfg(feature = "serde")]
impl<V: Copy> History<V> {
    /// The differences that are known, after how many increments.
    pub(crate) fn parts(&self) -> (usize, &[V]) {
        (self.increments, self.differences.get(..self.increments.saturating_sub(1)).unwrap_or_default())
    }

    /// Of as many differences as [`parts`](Self::parts) gives for these increments.
    pub(crate) fn of<T: Real>(increments: usize, known: &[V]) -> Self
    where
        V: Coordinates<T>,
    {
        let mut history = Self { increments, ..Self::new() };
        history.differences.iter_mut().zip(known).for_each(|(place, &difference)| *place = difference);
        history
    }
}

#[cfg(test)]
mod tests {
    use super::{DIFFERENCES, History};
    use nalgebra::Vector1;

    /// A polynomial of as high a degree as there are differences goes on as it was; one of a higher degree doesn't.
    #[test]
    fn a_polynomial_is_continued() {
        let errors = [DIFFERENCES, DIFFERENCES + 1].map(|degree| {
            let value = |i: i32| Vector1::new((0.1 * f64::from(i)).powi(i32::try_from(degree).unwrap()));
            let mut history = History::new();
            let (mut last, mut guess) = (value(0), value(0));
            for i in 0..20 {
                guess = history.next(last, value(i));
                last = value(i);
            }
            (guess - value(20)).norm() / value(20).norm()
        });
        assert!(errors[0] < 1e-12 && errors[1] > 1e-9, "{errors:?}");
    }

    /// The parabola through three increments goes on as it was; a cubic doesn't, by its third difference.
    #[test]
    fn a_parabola_is_continued() {
        for (cubic, missing) in [(0.0, 0.0), (1.0, 6.0)] {
            let value = |i: i32| {
                let i = f64::from(i);
                Vector1::new(3.0 - 2.0 * i + 5.0 * i * i + cubic * i * i * i)
            };
            let mut history = History::new();
            let guesses: Vec<_> = (1..6).map(|i| history.parabola(value(i - 1), value(i))).collect();
            for (i, guess) in (2..).zip(&guesses).skip(1) {
                assert_eq!(value(i) - guess, Vector1::new(missing), "increment {i}");
            }
        }
    }

    /// At the beginning there is one point, then a line, a parabola and so on.
    #[test]
    fn it_starts_with_what_there_is() {
        let mut history = History::new();
        let nothing = Vector1::new(100.0);
        assert_eq!(history.next(nothing, Vector1::new(1.0)), Vector1::new(1.0));
        assert_eq!(history.next(Vector1::new(1.0), Vector1::new(4.0)), Vector1::new(7.0));
        assert_eq!(history.next(Vector1::new(4.0), Vector1::new(9.0)), Vector1::new(16.0));
    }
}
