//! The vector instructions of the machine that the program runs on, whatever it was compiled for.

use pulp::{Arch, Simd, WithSimd};

/// What is worth compiling for several instruction sets.
///
/// All that [`run`](Self::run) calls has to be inlined into it, or is compiled for the target's common instructions
/// only. No instruction set changes a digit: the compiler neither fuses nor reorders operations on floating-point
/// numbers.
pub(crate) trait Kernel {
    type Output;

    /// Does it; marked `#[inline(always)]`.
    fn run(self) -> Self::Output;
}

/// Does it with the best instructions there are, if that is asked for.
#[inline(always)]
pub(crate) fn dispatch<K: Kernel>(best: bool, kernel: K) -> K::Output {
    if best { Arch::new().dispatch(Dispatched(kernel)) } else { kernel.run() }
}

struct Dispatched<K>(K);

impl<K: Kernel> WithSimd for Dispatched<K> {
    type Output = K::Output;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> K::Output {
        self.0.run()
    }
}
