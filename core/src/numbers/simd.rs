//! The vector instructions of the machine that the program runs on, whatever it was compiled for.

/// What is worth compiling for several instruction sets.
///
/// All that [`run`](Self::run) calls has to be inlined into it, or is compiled for the target's common instructions
/// only. No instruction set changes a digit: the compiler neither fuses nor reorders operations on floating-point
/// numbers.
pub(crate) trait Kernel {
    type Output;

    /// Whether it is worth it. What isn't is compiled once: as an argument of [`dispatch`], all would be compiled for
    /// every instruction set, and tests took twice as long to build.
    const DISPATCHED: bool;

    /// Does it; marked `#[inline(always)]`.
    fn run(self) -> Self::Output;
}

/// Does it with the best instructions that the machine has, if that is worth it and the feature `dispatch` is on.
#[cfg(feature = "dispatch")]
#[inline(always)]
pub(crate) fn dispatch<K: Kernel>(kernel: K) -> K::Output {
    use pulp::{Arch, Simd, WithSimd};

    struct Dispatched<K>(K);

    impl<K: Kernel> WithSimd for Dispatched<K> {
        type Output = K::Output;

        #[inline(always)]
        fn with_simd<S: Simd>(self, _: S) -> K::Output {
            self.0.run()
        }
    }

    if K::DISPATCHED { Arch::new().dispatch(Dispatched(kernel)) } else { kernel.run() }
}

/// Does it with the instructions that it was compiled for.
#[cfg(not(feature = "dispatch"))]
#[inline(always)]
pub(crate) fn dispatch<K: Kernel>(kernel: K) -> K::Output {
    kernel.run()
}
