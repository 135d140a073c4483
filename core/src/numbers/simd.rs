//! The vector instructions of the machine that the program runs on, whatever it was compiled for.

use pulp::{Arch, Simd, WithSimd};

use crate::numbers::scalar::Real;

/// What is worth compiling for several instruction sets.
///
/// All that [`run`](Self::run) calls has to be inlined into it, or is compiled for the target's common instructions
/// only. No instruction set changes a digit: the compiler neither fuses nor reorders operations on floating-point
/// numbers.
pub(crate) trait Work {
    type Output;

    /// Does it; marked `#[inline(always)]`.
    fn run(self) -> Self::Output;
}

/// Does it with the best instructions there are.
#[inline(always)]
pub(crate) fn at_best<W: Work>(work: W) -> W::Output {
    Arch::new().dispatch(Dispatched(work))
}

/// The same, if the scalar has several lanes; a body alone gains nothing.
#[inline(always)]
pub(crate) fn at_best_in_lanes<T: Real, W: Work>(work: W) -> W::Output {
    if T::LANES > 1 { at_best(work) } else { work.run() }
}

struct Dispatched<W>(W);

impl<W: Work> WithSimd for Dispatched<W> {
    type Output = W::Output;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> W::Output {
        self.0.run()
    }
}
