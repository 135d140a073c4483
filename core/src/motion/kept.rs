//! What a method remembers from step to step, number by number.

use core::fmt::Debug;

use crate::motion::state::ElapsedTime;
use crate::numbers::{Coordinates, History, Real, replaced};
use crate::solving::{Guess, WarmStart};

/// What a [`Plan`](crate::motion::Plan) keeps from step to step, as numbers that a checkpoint stores.
pub trait Kept<T: Real>: Copy + Debug + PartialEq {
    /// A memory of the same kind with other numbers.
    ///
    /// `number` is called with each number of this memory, in a fixed order, and returns the one that takes its place. How
    /// often it is called doesn't depend on the numbers. `None` if the new ones can't be those of such a memory.
    fn with_numbers(&self, number: &mut dyn FnMut(T) -> T) -> Option<Self>;

    /// Visits all numbers, in the order of [`with_numbers`](Self::with_numbers).
    fn each(&self, visit: &mut dyn FnMut(T)) {
        let _ = self.with_numbers(&mut |number| {
            visit(number);
            number
        });
    }

    /// As kept for a next step that is longer by this ratio: increments are proportional to its length.
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

/// Of a plan around another: what that keeps, and what it keeps besides.
impl<T: Real, A: Kept<T>, B: Kept<T>> Kept<T> for (A, B) {
    fn with_numbers(&self, number: &mut dyn FnMut(T) -> T) -> Option<Self> {
        // Both are visited even if the first can't be: how many numbers there are doesn't depend on their values.
        let (first, second) = (self.0.with_numbers(number), self.1.with_numbers(number));
        Some((first?, second?))
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

#[cfg(test)]
mod tests {
    use super::Kept as _;
    use crate::numbers::Polynomial;
    use crate::solving::WarmStart;
    use alloc::vec::Vec;
    use nalgebra::Vector2;

    type Memory = WarmStart<Vector2<f64>, Polynomial<Vector2<f64>>>;

    /// Half the increment, a guess, how many increments there were, and their differences.
    fn read(increments: f64) -> Option<Memory> {
        let mut numbers = [1.0, 2.0, 3.0, 4.0, increments].into_iter().chain((0..14).map(f64::from));
        Memory::of(Vector2::zeros(), true).with_numbers(&mut |_| numbers.next().unwrap())
    }

    #[test]
    fn a_memory_is_its_numbers() {
        let mut numbers = Vec::new();
        read(3.0).unwrap().each(&mut |number| numbers.push(number));
        let mut again = numbers.iter().copied();
        assert_eq!(read(0.0).unwrap().with_numbers(&mut |_| again.next().unwrap()), read(3.0));
        assert_eq!((numbers.len(), again.next()), (19, None));
        let mut three = numbers[..6].iter().copied();
        let short = WarmStart::<Vector2<f64>>::of(Vector2::zeros(), false);
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
