#![doc = include_str!("lib.md")]
#![no_std]

extern crate alloc;
#[macro_use(hot, InLanes, Lanes)]
extern crate liestep_macros;
#[cfg(any(feature = "std", test))]
extern crate std;

#[cfg(not(any(feature = "std", feature = "libm")))]
compile_error!(
    "without a standard library liestep takes its roots and sines from libm: turn on its feature `std` or `libm`"
);

// Expansions name this crate by its path from outside; our own documentation and tests do too.
extern crate self as liestep;

/// Roots and powers, which without a standard library are nalgebra's.
macro_rules! roots {
    () => {
        #[cfg(not(feature = "std"))]
        use nalgebra::ComplexField as _;
    };
}

// First, so that the page of `Stepper` begins with `new`, `start` and `step`.
#[macro_use]
pub mod motion;

mod error;
mod solving;

pub mod accuracy;
pub mod conventions;
pub mod effects;
pub mod gradients;
pub mod groups;
pub mod guide;
pub mod laws;
pub mod mechanics;
pub mod methods;
pub mod numbers;
pub mod prelude;
pub mod recording;
pub mod with;

#[doc(hidden)]
#[path = "private.rs"]
pub mod __private;

pub use error::{SetupError, StepError};
pub use groups::SO3;
pub use liestep_macros::{constraint, force, lagrangian, nonholonomic};
pub use mechanics::{Inertia, NonstandardInertia};
pub use motion::{State, StateOf, Stepper};
pub use nalgebra;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
