//! The memory of a method from step to step, as numbers.

use core::fmt::Debug;

use crate::motion::state::ElapsedTime;
use crate::numbers::{Coordinates, History, Polynomial, Real, replaced};
use crate::solving::{Guess, WarmStart};

/// The memory of a [`Plan`](crate::motion::Plan) from step to step, as numbers for a checkpoint.
pub trait Kept<T: Real>: Copy + Debug + PartialEq {
    /// A memory of the same type with other numbers.
    ///
    /// `number` is called with each number of this memory, in a fixed order, and returns its replacement. The number of
    /// calls doesn't depend on the numbers. Returns `None` if the replacements aren't valid for this type.
    fn with_numbers(&self, number: &mut dyn FnMut(T) -> T) -> Option<Self>;

    /// Visits all numbers, in the order of [`with_numbers`](Self::with_numbers).
    fn each(&self, visit: &mut dyn FnMut(T)) {
        let _ = self.with_numbers(&mut |number| {
            visit(number);
            number
        });
    }

    /// Whether the lanes of this memory can be made a step of the length `h` together. A memory of a single body always can.
    fn is_in_step(&self, _h: T) -> bool {
        true
    }

    /// The memory for a next step that is longer by this ratio: increments are proportional to the step.
    #[must_use]
    fn scaled(&self, _ratio: T) -> Self {
        *self
    }
}

impl<T: Real> Kept<T> for () {
    fn with_numbers(&self, _: &mut dyn FnMut(T) -> T) -> Option<Self> {
        Some(())
    }
}

impl<T: Real> Kept<T> for ElapsedTime<T> {
    fn with_numbers(&self, number: &mut dyn FnMut(T) -> T) -> Option<Self> {
        Some(Self { sum: number(self.sum), carry: number(self.carry) })
    }
}

/// The memory of a plan around another: that of the inner plan, and its own.
impl<T: Real, A: Kept<T>, B: Kept<T>> Kept<T> for (A, B) {
    fn with_numbers(&self, number: &mut dyn FnMut(T) -> T) -> Option<Self> {
        // Both are visited even if the first is invalid: the number of calls doesn't depend on the values.
        let (first, second) = (self.0.with_numbers(number), self.1.with_numbers(number));
        Some((first?, second?))
    }

    fn is_in_step(&self, h: T) -> bool {
        self.0.is_in_step(h) && self.1.is_in_step(h)
    }

    fn scaled(&self, ratio: T) -> Self {
        (self.0.scaled(ratio), self.1.scaled(ratio))
    }
}

impl<T: Real, V: Coordinates<T>> Kept<T> for Guess<V> {
    fn with_numbers(&self, number: &mut dyn FnMut(T) -> T) -> Option<Self> {
        Some(Self { half: replaced(&self.half, number), next: replaced(&self.next, number) })
    }

    fn scaled(&self, ratio: T) -> Self {
        Self { half: self.half * ratio, next: self.next * ratio }
    }
}

impl<T: Real, V: Coordinates<T>, H: History<T, V>> Kept<T> for WarmStart<V, H> {
    fn with_numbers(&self, number: &mut dyn FnMut(T) -> T) -> Option<Self> {
        Some(Self { guess: self.guess.with_numbers(number)?, history: self.history.with_numbers(number)? })
    }

    fn scaled(&self, ratio: T) -> Self {
        Self { guess: self.guess.scaled(ratio), history: self.history.scaled(ratio) }
    }
}

impl<T: Real, V: Coordinates<T>> Kept<T> for Polynomial<V> {
    fn with_numbers(&self, number: &mut dyn FnMut(T) -> T) -> Option<Self> {
        History::with_numbers(self, number)
    }

    fn scaled(&self, ratio: T) -> Self {
        History::scaled(self, ratio)
    }
}

#[cfg(test)]
mod tests {
    use super::Kept as _;
    use crate::numbers::Polynomial;
    use crate::solving::WarmStart;
    use alloc::vec::Vec;
    use nalgebra::Vector2;

    type Memory = WarmStart<Vector2<f64>, Polynomial<Vector2<f64>>>;

    /// A memory from half the increment, a guess, the number of increments, and their differences.
    fn read(increments: f64) -> Option<Memory> {
        let mut numbers = [1.0, 2.0, 3.0, 4.0, increments].into_iter().chain((0..14).map(f64::from));
        Memory::of(Vector2::zeros()).with_numbers(&mut |_| numbers.next().unwrap())
    }

    #[test]
    fn a_memory_is_its_numbers() {
        let mut numbers = Vec::new();
        read(3.0).unwrap().each(&mut |number| numbers.push(number));
        let mut again = numbers.iter().copied();
        assert_eq!(read(0.0).unwrap().with_numbers(&mut |_| again.next().unwrap()), read(3.0));
        assert_eq!((numbers.len(), again.next()), (19, None));
        let mut three = numbers[..6].iter().copied();
        let short = WarmStart::<Vector2<f64>>::of(Vector2::zeros());
        let short = short.with_numbers(&mut |_| three.next().unwrap()).unwrap();
        let mut again = Vec::new();
        short.each(&mut |number| again.push(number));
        assert_eq!(again, numbers[..6]);
    }

    #[test]
    fn a_count_that_is_none_is_refused() {
        for count in [2.5, -1.0, 9.0, 9.2e18, f64::NAN] {
            assert_eq!(read(count), None, "{count}");
        }
        assert!(read(8.0).is_some());
    }
}
