//! The vector instructions of the machine that the program runs on, whatever it was compiled for.

/// How wide the vector registers are that a step is worth compiling for.
///
/// Which of them there are is found out when the program runs, with the feature `dispatch`; without it, all is as
/// compiled. With debug assertions, too: their builds are to be done soon, and what vector instructions are for is
/// called there, not inlined. No digit depends on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Vectors {
    /// Those of the target that the program was compiled for: two `f64` by default.
    AsCompiled,
    /// Up to four `f64`: AVX2.
    Four,
    /// Up to eight `f64`: AVX-512, and AVX2 where there is but that.
    Eight,
}

/// What is worth compiling for several instruction sets.
///
/// All that [`run`](Self::run) calls has to be inlined into it, or is compiled for the target's common instructions
/// only. No instruction set changes a digit: the compiler neither fuses nor reorders operations on floating-point
/// numbers.
pub(crate) trait Kernel {
    type Output;

    /// The registers that it is worth compiling for. As a value of [`dispatch`], and not a constant, it would be compiled
    /// for all of them.
    const VECTORS: Vectors;

    /// Whether its numbers are lanes, whose vectors are put in memory and taken from there all the time.
    const IS_IN_LANES: bool = false;

    /// Does it; marked `#[inline(always)]` but for builds with debug assertions.
    fn run(self) -> Self::Output;
}

/// Does it with the best instructions that the machine has, up to those asked for, if the feature `dispatch` is on.
#[cfg(feature = "dispatch")]
#[hot]
pub(crate) fn dispatch<K: Kernel>(kernel: K) -> K::Output {
    use pulp::{Arch, Simd, WithSimd};

    struct Dispatch<K>(K);

    #[repr(align(64))]
    struct CacheLine {
        _bytes: [u8; 64],
    }

    impl<K: Kernel> WithSimd for Dispatch<K> {
        type Output = K::Output;

        #[hot]
        fn with_simd<S: Simd>(self, _: S) -> K::Output {
            // The frame that the kernel is inlined into begins at a multiple of 64 bytes for it. Its vectors stand at
            // multiples of 32 bytes from there; elsewhere every other one would lie across two cache lines, and one of
            // them across two pages, whose stores take up to a third of a step.
            if const { K::IS_IN_LANES } {
                let line = core::mem::MaybeUninit::<CacheLine>::uninit();
                core::hint::black_box(&line);
            }
            self.0.run()
        }
    }

    // A branch on a constant leaves the others uncompiled; a `match` doesn't.
    if const { cfg!(debug_assertions) || matches!(K::VECTORS, Vectors::AsCompiled) } {
        return kernel.run();
    }
    #[cfg(target_arch = "x86_64")]
    if const { matches!(K::VECTORS, Vectors::Four) } {
        return match pulp::x86::V3::try_new() {
            Some(four) => Simd::vectorize(four, Dispatch(kernel)),
            None => kernel.run(),
        };
    }
    Arch::new().dispatch(Dispatch(kernel))
}

/// Does it with the instructions that it was compiled for.
#[cfg(not(feature = "dispatch"))]
#[hot]
pub(crate) fn dispatch<K: Kernel>(kernel: K) -> K::Output {
    let _ = (K::VECTORS, K::IS_IN_LANES);
    kernel.run()
}
