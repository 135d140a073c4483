//! Increments that have been, to guess the next one.

use nalgebra::SimdBool as _;

use crate::numbers::{Coordinates, Mask, Real};

/// Of increments at equal times eight tell the next to some `(h ω)⁸` for the fastest frequency `ω` in them. Each more
/// would double the roundings in the guess, and gains little where `h ω` is near one.
pub(crate) const DIFFERENCES: usize = 7;

/// What increments are continued by to guess the next one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Continued {
    /// The parabola through three.
    Parabola,
    /// The polynomial through as many as are known, where an iteration is expensive.
    Polynomial,
}

impl Continued {
    /// By what a solve of a Lagrangian costs.
    pub(crate) const fn for_jacobian(is_expensive: bool) -> Self {
        if is_expensive { Self::Polynomial } else { Self::Parabola }
    }
}

/// Half the coordinates of the last increment, and a guess of half the next ones.
#[derive(Clone, Copy, Debug, PartialEq, Lanes)]
pub struct Guess<V> {
    pub(crate) half: V,
    pub(crate) next: V,
}

impl<V: Copy> Guess<V> {
    /// Before the first step, of an estimate.
    pub(crate) fn of(half: V) -> Self {
        Self { half, next: half }
    }
}

/// The guess, but where the last increment is `far`: there it is that increment.
///
/// Those are the lanes in which coordinates are no longer near the identity at 3/2 of their length. Near the fold they
/// change too fast for a guess by what has been; a factor of 3/2 keeps well away from it. A selection without the branch
/// would lie on the way to the next iteration, and cost a tenth of a step.
#[hot]
fn near_of<T: Real, V: Coordinates<T>>(half: V, guess: V, far: Mask<T>) -> V {
    if far.any() { half.select(far, guess) } else { guess }
}

/// What a declared Lagrangian's step keeps for the next solve: a guess, and the last increments that it is made of.
#[derive(Clone, Copy, Debug, PartialEq, Lanes)]
pub struct Warm<V> {
    pub(crate) guess: Guess<V>,
    /// Of many increments where the Jacobian is expensive, elsewhere of the last three.
    pub(crate) history: History<V>,
}

impl<V: Copy> Warm<V> {
    /// Before the first step, of an estimate of half its coordinates.
    pub(crate) fn of<T: Real>(half: V) -> Self
    where
        V: Coordinates<T>,
    {
        Self { guess: Guess::of(half), history: History::new() }
    }

    /// Guesses the next increment by continuing the last ones, the latest of which has half these coordinates.
    #[hot]
    pub(crate) fn follow<T: Real>(&mut self, half: V, far: Mask<T>, continued: Continued)
    where
        V: Coordinates<T>,
    {
        let last = core::mem::replace(&mut self.guess.half, half);
        let next = match continued {
            Continued::Parabola => self.history.parabola(last, half),
            Continued::Polynomial => self.history.next(last, half),
        };
        self.guess.next = near_of(half, next, far);
    }

    /// After the first step: before it there was no increment but an estimate, which a parabola would go through.
    pub(crate) fn forget_the_estimate<T: Real>(&mut self, continued: Continued)
    where
        V: Coordinates<T>,
    {
        self.guess.next = self.guess.half;
        if continued == Continued::Parabola {
            self.history = History::new();
        }
    }

    /// The guess for the next solve, as a solve had better read it.
    ///
    /// A processor hands on what has just been stored to a load of the same place, but a load of two components that
    /// were stored apart waits until both stores are done. The compiler stores them and loads them in pairs, and in
    /// different ones if it may. With the last component loaded for itself they are the same; it was a tenth of a step
    /// of (3.13).
    #[hot]
    pub(crate) fn guess<T: Real>(&self, dimension: usize) -> V
    where
        V: Coordinates<T>,
    {
        if T::LANES > 1 {
            return self.guess.next;
        }
        let mut left = dimension;
        self.guess.next.zip(&self.guess.next, &mut |component, _| {
            left -= 1;
            if left == 0 { core::hint::black_box(component) } else { component }
        })
    }
}

/// The backward differences `∇ y, ∇² y, …` of the last increments `y`.
#[derive(Clone, Copy, Debug, PartialEq, Lanes)]
pub(crate) struct History<V> {
    pub(crate) differences: [V; DIFFERENCES],
    /// How many increments have been taken notice of; more than there are differences count as one more.
    #[shared]
    pub(crate) increments: usize,
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
    #[hot]
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
    #[hot]
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

#[cfg(test)]
mod tests {
    use super::{DIFFERENCES, History};
    use alloc::vec::Vec;
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
