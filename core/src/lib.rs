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
/// Derives an integrator from a reduced Lagrangian, continuous or discrete.
///
/// ```
/// use liestep::nalgebra::{UnitQuaternion, Vector3};
/// use liestep::{Inertia, SO3, Stepper, lagrangian};
///
/// /// A heavy top, by its kinetic and its potential energy.
/// #[lagrangian(
///     group = SO3,
///     velocity = Omega,
///     advected(w = up),
///     l = 0.5 * Omega.dot(&(J * Omega)) - m * g * w.dot(&rho),
///     discretise = trapezoid(Cayley),
/// )]
/// struct Top {
///     J: Inertia,         // about the pivot, kg m²
///     m: f64,             // kg
///     g: f64,             // m/s²
///     rho: Vector3<f64>,  // the centre of mass, body frame, m
///     up: Vector3<f64>,   // the vertical, in space
/// }
///
/// let J = Inertia::from_principal_moments(Vector3::new(3.0, 3.0, 4.0))?;
/// let top = Top { J, m: 1.0, g: 9.81, rho: Vector3::z(), up: Vector3::z() };
/// let stepper = Stepper::new(top, 0.01)?; // s
/// let tilted = UnitQuaternion::from_scaled_axis(Vector3::new(0.5, 0.0, 0.0));
/// let mut state = stepper.start(tilted, Vector3::new(0.0, 0.0, 6.0))?; // rad/s
/// let energy = stepper.energy(&state);
/// stepper.run(&mut state, 1000)?;
/// assert!((stepper.energy(&state) - energy).abs() < 1e-2 * energy);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// The discrete Lagrangian itself is declared by `l_d = …` instead, as on the first page of this library.
pub use liestep_macros::lagrangian;
pub use liestep_macros::{constraint, force, nonholonomic};
pub use mechanics::{Inertia, NonstandardInertia};
pub use motion::{State, StateOf, Stepper};
pub use nalgebra;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
