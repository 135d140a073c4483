//! Structure-preserving integrators from declared reduced Lagrangians.
//!
//! Annotate a struct with its reduced discrete Lagrangian `l_d(F, w)` on a Lie group. [`lagrangian`] derives the momentum
//! maps, the diamond term, the momentum equation and its Newton Jacobian when your crate is compiled. [`Stepper`] makes
//! an integrator of them: attitudes stay rotations, momentum maps are conserved, energy doesn't drift.
//!
//! ```
//! use liestep::nalgebra::{UnitQuaternion, Vector3};
//! use liestep::{NonstandardInertia, SO3, Stepper, lagrangian};
//!
//! /// A heavy top.
//! #[lagrangian(
//!     group = SO3,
//!     advected(w = up),
//!     l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)
//!         - 0.5 * h * m * g * w.dot(&(rho + F * rho)),
//! )]
//! struct HeavyTop {
//!     J_d: NonstandardInertia, // about the pivot, kg m²
//!     m: f64,                  // kg
//!     g: f64,                  // m/s²
//!     rho: Vector3<f64>,       // the centre of mass, body frame, m
//!     up: Vector3<f64>,        // the vertical, in space; w is the same vector seen from the body
//! }
//!
//! let J_d = NonstandardInertia::from_diagonal(Vector3::new(2.0, 2.0, 1.0))?;
//! let top = HeavyTop { J_d, m: 1.0, g: 9.81, rho: Vector3::z(), up: Vector3::z() };
//! let stepper = Stepper::new(top, 0.01)?; // s
//! let attitude = UnitQuaternion::from_scaled_axis(Vector3::new(0.8, 0.0, 0.0));
//! let mut state = stepper.start(attitude, Vector3::new(0.5, 2.0, 12.0))?; // rad/s, body frame
//! let vertical = state.momentum_along(&Vector3::z());
//! stepper.run(&mut state, 10_000)?;
//! assert!((state.momentum_along(&Vector3::z()) - vertical).abs() < 1e-11);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # What do you want to do?
//!
//! | | |
//! |---|---|
//! | simulate a body with gravity, a spring, drag, … | [`effects`]: bodies and what acts on them; they add with `+` |
//! | declare a Lagrangian or a force of your own | [`lagrangian`], [`force`](macro@force) |
//! | move two to four bodies that turn together, without the effects or a splitting | [`lagrangian`] and [`force`](macro@force) with `group(F_1 = SO3, F_2 = SO3)` |
//! | move many bodies that feel each other's attitudes and positions | [`mechanics::Placed`]: terms on one body or on two, put at places ([`Each`](mechanics::Each), [`On`](mechanics::On), [`Along`](mechanics::Along), [`Between`](mechanics::Between), [`Pairs`](mechanics::Pairs), [`Coupled`](mechanics::Coupled)) |
//! | step over the oscillations of stiff rods | [`mechanics::Coupled`] |
//! | start a rod or a spherical pendulum by its direction | [`NonstandardInertia::pointing`] |
//! | move a chain of links on ball joints | [`methods::Chain`]; with other potentials [`Stepper::linked`](motion::Stepper#method.linked) |
//! | hold bodies together by joints, loops among them | [`Stepper::jointed`](motion::Stepper#method.jointed); joints of your own by [`constraint`](macro@constraint) |
//! | begin with the continuous Lagrangian `l(ξ, w)` | [`lagrangian`] with `l = …`, [`mechanics::ContinuousLagrangian`] |
//! | hand the equations of motion to an ODE solver, or integrate them on any matrix group, of one body | [`motion::RightHandSide`], [`methods::CotangentGauss`] |
//! | step, run, force, save and resume a motion | [`Stepper`], [`State`] |
//! | record a run, stop it, be called at given times | [`Stepper::observed`](motion::Stepper#method.observed), [`recording::Recorder`] |
//! | read a motion between its steps | [`motion::Integrator::state_at`] |
//! | be more accurate | [`methods`]: orders 4 to 16 |
//! | say how accurate, and not how | [`accuracy`] |
//! | measure errors, orders and costs | [`accuracy::convergence`], [`accuracy::work_precision`] |
//! | go on where a step has no solution, or lose less to rounding | [`with`] |
//! | move on another group, or on one of your own | [`groups`], [`laws`] |
//! | use `f32`, SIMD lanes, dual numbers | [`numbers::Real`] |
//! | know how a motion depends on its start and its parameters; Lyapunov exponents | [`gradients`] |
//! | know what is conserved, and what left and right mean here | [`conventions::guarantees`], [`conventions`] |
//! | read from the beginning: first program, effects, groups, accuracy, hard cases, recording, … | [`guide`] |
//! | come from the thesis' equations to a program | [`guide::thesis`] |
//! | find an equation of the thesis | [`conventions::equations`] |
//! | step by a method of your own | [`motion::Plan`], [`Stepper::with_plan`] |
//! | work without the macro | [`mechanics::DiscreteLagrangian`] |
//!
//! # Features
//!
//! | feature | |
//! |---|---|
//! | `dispatch` (default) | lanes, systems, chains, splittings and collocation take the vector instructions that the machine is found to have; no digit depends on it |
//! | `std` (default) | tables as files and in threads of their own: [`recording::Csv`], [`recording::Background`] |
//! | `libm` | in the place of `std` on targets without a standard library, which need an allocator: roots and sines are those of the crate `libm`, and so may differ in their last bit |
//! | `glam033`, `mint` | nalgebra's vectors, matrices and rotations are converted from and to those of glam 0.33 and of mint; attitudes by way of `UnitQuaternion` |
//! | `serde` | [`Stepper::checkpoint`](motion::Stepper#method.checkpoint): files that a run goes on from, bit for bit |
//!
//! # How it is built
//!
//! A folder of the sources is a room, and each room's page is one of the modules below. Rooms import each other in one
//! direction, which `tests/rooms.rs` checks:
//!
//! ```text
//! error, numbers ← groups ← mechanics ← {effects, solving} ← motion ← gradients ← methods
//! methods ← {recording, with, accuracy};  groups ← laws
//! ```

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
pub use liestep_macros::{constraint, force, lagrangian};
pub use mechanics::NonstandardInertia;
pub use motion::{State, StateOf, Stepper};
pub use nalgebra;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
