//! The guess of the next increment, extrapolated from the last ones.

use nalgebra::SimdBool as _;

use crate::numbers::{Coordinates, History, Mask, Parabola, Real};

/// Half the coordinates of the last increment, and a guess of half the next ones.
#[derive(Clone, Copy, Debug, PartialEq, Lanes)]
pub struct Guess<V> {
    pub(crate) half: V,
    pub(crate) next: V,
}

impl<V: Copy> Guess<V> {
    /// The guess before the first step, from an estimate.
    pub(crate) fn of(half: V) -> Self {
        Self { half, next: half }
    }
}

/// The guess, or in lanes with a `far` last increment that increment.
///
/// Far lanes are those in which coordinates are no longer near the identity at 3/2 of their length. Near the fold they
/// change too fast for an extrapolation; a factor of 3/2 keeps well away from it. A selection without the branch would
/// lie on the way to the next iteration, and cost a tenth of a step.
#[hot]
fn near_of<T: Real, V: Coordinates<T>>(half: V, guess: V, far: Mask<T>) -> V {
    if far.any() { half.select(far, guess) } else { guess }
}

/// The memory of a declared Lagrangian's step for the next solve: a guess, and the history of increments behind it.
#[derive(Clone, Copy, Debug, PartialEq, Lanes)]
pub struct WarmStart<V, H = Parabola<V>> {
    pub(crate) guess: Guess<V>,
    pub(crate) history: H,
}

impl<V: Copy, H> WarmStart<V, H> {
    /// The memory before the first step, from an estimate of half its coordinates.
    pub(crate) fn of<T: Real>(half: V) -> Self
    where
        V: Coordinates<T>,
        H: History<T, V>,
    {
        Self { guess: Guess::of(half), history: H::none() }
    }

    /// Extrapolates the guess from the last increments, the latest of which has half these coordinates.
    #[hot]
    pub(crate) fn follow<T: Real>(&mut self, half: V, far: Mask<T>)
    where
        V: Coordinates<T>,
        H: History<T, V>,
    {
        let last = core::mem::replace(&mut self.guess.half, half);
        self.guess.next = near_of(half, self.history.next(last, half), far);
    }

    /// Discards the estimate after the first step: no increment was before it.
    pub(crate) fn forget_the_estimate<T: Real>(&mut self)
    where
        V: Coordinates<T>,
        H: History<T, V>,
    {
        self.guess.next = self.guess.half;
        self.history.forget_the_estimate();
    }

    /// The guess for the next solve, in a form that is loaded fast.
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
