//! Vector instructions that the machine has at run time, beyond those of the compilation's target.

/// Width of the vector registers for which a step is compiled.
///
/// The machine's registers are detected at run time with the feature `dispatch`; without it, the step uses those of the
/// target. So it does with debug assertions, whose builds are to compile fast, and call functions instead of inlining
/// them. No digit depends on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Vectors {
    /// The registers of the target that the program was compiled for: two `f64` by default.
    AsCompiled,
    /// Up to four `f64`: AVX2.
    Four,
    /// Up to eight `f64`: AVX-512, or AVX2 on a machine without it, and in a build with `--cfg liestep_256_bits`, which
    /// measures on one machine what the other costs.
    Eight,
}

/// A computation that is compiled for several instruction sets.
///
/// Every function that [`run`](Self::run) calls has to be inlined into it, or is compiled for the target's common
/// instructions only. No instruction set changes a digit: the compiler neither fuses nor reorders floating-point
/// operations.
pub(crate) trait Kernel {
    type Output;

    /// The registers to compile for. As an argument of [`dispatch`] instead of a constant, it would be compiled for all
    /// of them.
    const VECTORS: Vectors;

    /// Whether the kernel's numbers are lanes, whose vectors are stored and loaded all the time.
    const IS_IN_LANES: bool = false;

    /// Runs the computation; marked `#[inline(always)]` except in builds with debug assertions.
    fn run(self) -> Self::Output;
}

/// Runs a computation with the best instructions that the machine has, up to the requested ones, if the feature
/// `dispatch` is on.
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
            // A cache line on the stack aligns the frame into which the kernel is inlined to 64 bytes. Its vectors lie
            // at multiples of 32 bytes from there; otherwise every other one would lie across two cache lines, and one
            // of them across two pages, whose stores take up to a third of a step.
            if const { K::IS_IN_LANES } {
                let line = core::mem::MaybeUninit::<CacheLine>::uninit();
                core::hint::black_box(&line);
            }
            self.0.run()
        }
    }

    // A branch on a constant isn't compiled if it isn't taken; an arm of a `match` is.
    if const { cfg!(debug_assertions) || matches!(K::VECTORS, Vectors::AsCompiled) } {
        return kernel.run();
    }
    #[cfg(target_arch = "x86_64")]
    if const { matches!(K::VECTORS, Vectors::Four) || cfg!(liestep_256_bits) } {
        return match pulp::x86::V3::try_new() {
            Some(four) => Simd::vectorize(four, Dispatch(kernel)),
            None => kernel.run(),
        };
    }
    Arch::new().dispatch(Dispatch(kernel))
}

/// Runs a computation with the instructions of the target.
#[cfg(not(feature = "dispatch"))]
#[hot]
pub(crate) fn dispatch<K: Kernel>(kernel: K) -> K::Output {
    let _ = (K::VECTORS, K::IS_IN_LANES);
    kernel.run()
}
