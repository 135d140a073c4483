//! Accuracy and cost: which method when, and how to measure it.
//!
//! Before: [several bodies](super::bodies). Next: [hard cases](super::hard_cases).
//!
//! # Which method
//!
//! * **If you know the error that you can afford, and the time**, ask:
//!   [`Stepper::for_accuracy`](crate::Stepper::for_accuracy) tries the methods, and chooses one with its step.
//! * **If a run is long and its invariants matter more than its phase**, take the scene's own step,
//!   [`Stepper::new`](crate::Stepper::new).
//! * **If errors are to be below 1e-3**, take a [composition](crate::methods::CompositionScheme) of that step,
//!   [`Stepper::composed`](crate::Stepper::composed). It works on every group.
//! * **If one body turns on SO(3) under a potential**, take a splitting with the
//!   [exact motion](crate::methods::ExactBody) of the body, [`Stepper::split`](crate::Stepper::split): it solves nothing.
//!   If its states are looked at seldom, take a processed one, [`Stepper::processed`](crate::Stepper::processed).
//! * **If ten digits and more are asked for, or steps come near the limit**, take
//!   [Gauss collocation](crate::methods::Gauss), [`Stepper::collocated`](crate::Stepper::collocated).
//! * **If nothing acts on the body**, take the exact motion: a splitting with no kick, over any time in one step.
//! * **If bodies are held by joints**, take [`Stepper::jointed`](crate::Stepper::jointed). If they hang in a row, each on
//!   the one before, take [`Stepper::linked`](crate::Stepper::linked).
//! * **If there is a continuous `l(ξ, w)` and no discrete one**, take [`CotangentGauss`](crate::methods::CotangentGauss).
//!
//! What a method needs may decide:
//!
//! * If the scene has a declared [`force`](macro@crate::force), take `new`: the others don't take it.
//! * If there is to be a checkpoint, or a force given at each step, don't take `CotangentGauss` or what `for_accuracy`
//!   returns: they go with recording and events alone.
//! * If the inertia depends on what is advected, or a rotor turns within the body, it can't be split: compose.
//!
//! [`methods`](crate::methods) is the table of what each needs and keeps.
//!
//! # The order is the declaration's
//!
//! A step is as accurate as its `l_d` is near the exact action: of order 2 where that is self-adjoint, as (3.13) is. Two
//! declarations of the same body, and a composition of the first:
//!
//! ```
//! use liestep::accuracy::{Reference, Refinement, RefinementError, convergence};
//! use liestep::effects::FourthOrderBody;
//! use liestep::mechanics::DiscreteLagrangian;
//! use liestep::methods::CompositionScheme;
//! use liestep::motion::Plan;
//! use liestep::prelude::*;
//!
//! /// Runs to 2 s by whatever makes the stepper of a step.
//! fn table<S, P>(stepper: impl Fn(f64) -> Result<Stepper<S, P>, SetupError>) -> Result<Refinement, RefinementError>
//! where
//!     S: DiscreteLagrangian<Scalar = f64, Group = SO3>,
//!     P: Plan<S>,
//! {
//!     let family = |h| {
//!         let stepper = stepper(h)?;
//!         let start = stepper.start(SO3::identity(), Vector3::new(0.3, 2.0, 0.2))?;
//!         Ok((stepper, start))
//!     };
//!     convergence(family, 2.0, [20, 40, 80, 160, 1280], Reference::Finest)
//! }
//!
//! let J = Inertia::from_principal_moments(Vector3::new(1.0, 2.0, 2.5))?;
//! let body = RigidBody { J_d: J.to_nonstandard() };
//! let own = table(|h| Stepper::new(body, h))?;
//! let declared = table(|h| Stepper::new(FourthOrderBody { J }, h))?;
//! let composed = table(|h| Stepper::composed(body, h, CompositionScheme::SUZUKI_4))?;
//! println!("{own}\n\n{declared}\n\n{composed}");
//! for (table, order) in [(own, 2.0), (declared, 4.0), (composed, 4.0)] {
//!     assert!((table.order_above(1e-13).ok_or("too few errors")? - order).abs() < 0.1, "{table}");
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! These declarations are in `examples/declarations/`, with full inertia tensors, and `tests/accuracy/higher_order.rs`
//! measures their orders against references of 25 digits and more. The costs are multiples of that of (3.13) at `h = 0.01 s`, from
//! `cargo bench --bench kinetic-terms`:
//!
//! | `l_d` | order | a step |
//! |---|---|---|
//! | (3.13) | 2 | 1 |
//! | Cayley kinetic term: no step limit was found | 2 | 1.7 |
//! | geodesic kinetic term | 2 | 1.9 |
//! | L4 | 4 | 3.8, at `h = 0.05 s` 6.2 |
//! | L6 | 6 | 8.2, at `h = 0.05 s` 14 |
//!
//! # Measuring
//!
//! Two functions make such tables of any integrator, on any group:
//!
//! | | |
//! |---|---|
//! | [`convergence`](crate::accuracy::convergence) | errors, ratios, orders and iterations; no clock, so the same each time |
//! | [`work_precision`](crate::accuracy::work_precision) | the same with times; `seconds_to(error)` reads a cost off it |
//!
//! Both take what makes a stepper for a step, with its start; the time; the numbers of steps; and a
//! [`Reference`](crate::accuracy::Reference), which is a state that is known or the finest run. `work_precision` also
//! takes an [`Effort`](crate::accuracy::Effort): after which length no longer run is made, and how long each is repeated.
//! [`to_csv`](crate::accuracy::Refinement::to_csv) and [`to_json`](crate::accuracy::Refinement::to_json) write what
//! `println!` shows. What isn't an integrator of this crate, a Runge–Kutta method for example, comes into the same tables by
//! [`Refinement::timed`](crate::accuracy::Refinement::timed). README's comparison with such methods is made by these:
//!
//! ```text
//! cargo run --release --example accuracy-cost              # a quarter of an hour: tables, figure, CSV, JSON
//! cargo run --release --example accuracy-cost -- --quick   # an overview within a minute
//! ```
//!
//! It also shows what a million steps leave of the invariants, and what Newton's iteration would lose if it stopped early.
//! With `-- --heyoka` a Taylor integrator is run beside, where Python has it (`pip install heyoka`).
//!
//! The highest orders drown in the rounding of a double; `tests/accuracy/many_digits` measures them with 32 digits.
//!
//! # Asking for an accuracy
//!
//! ```
//! use liestep::accuracy::{Accuracy, AccuracyError};
//! use liestep::prelude::*;
//!
//! let body = RigidBody { J_d: NonstandardInertia::from_principal_moments(Vector3::new(1.0, 2.0, 2.5))? };
//! let (attitude, velocity) = (SO3::identity(), Vector3::new(0.01, 2.0, 0.02));
//! let accuracy = Accuracy { tolerance: 1e-6, horizon: 20.0 }; // of attitude and velocity together, at 20 s
//! let stepper = Stepper::for_accuracy(body, accuracy, attitude, velocity)?;
//! let choice = stepper.choice();
//! println!("{choice}"); // method, step, error measured, and what the others would cost
//! assert!(choice.error <= 1e-6 && choice.trials < 60.0);
//! stepper.run(&mut stepper.start())?;
//!
//! // What can't be had is said, with what can.
//! let refused = Stepper::for_accuracy(body, Accuracy { tolerance: 1e-17, ..accuracy }, attitude, velocity);
//! assert!(matches!(refused, Err(AccuracyError::Unreachable { floor, .. }) if floor < 1e-9));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! In the tests the trials cost at most sixty times the run, and half of them at most twenty times (column `trials` of
//! `cargo run --release --example accuracy-cost -- --asked`). The step is then fixed: changing it from step to step would
//! lose the long-time behaviour of the energy.
//!
//! # Rounding
//!
//! An error that doesn't fall with the step is rounding's. It accumulates like a random walk, and compensated sums
//! make it smaller, the more the shorter the step:
//!
//! ```
//! use liestep::prelude::*;
//!
//! let J_d = DiagonalNonstandardInertia::from_principal_moments(Vector3::new(1.0, 2.0, 2.5))?;
//! let plain = Stepper::new(PrincipalBody { J_d }, 1e-4)?;
//! let compensated = Stepper::new(PrincipalBody { J_d }, 1e-4)?.compensated();
//! let velocity = Vector3::new(0.3, 2.0, 0.2);
//! let (mut one, mut other) = (plain.start(SO3::identity(), velocity)?, compensated.start(SO3::identity(), velocity)?);
//! let momentum = one.spatial_momentum();
//! plain.run(&mut one, 50_000)?;
//! compensated.run(&mut other, 50_000)?;
//! let [lost, kept] = [one.spatial_momentum(), other.spatial_momentum()].map(|after| (after - momentum).norm());
//! assert!(lost < 1e-12 && kept < 2e-14 && kept < 0.2 * lost, "{lost:e} {kept:e}");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! `cargo bench --bench methods` shows what it costs. Collocation compensates its own sums.
//!
//! # Where others are better
//!
//! Over a short time, with (3.13): it is a scheme of order 2 whose step costs as much as one of the classical
//! Runge–Kutta method (`cargo bench --bench heavy-top-step`), which is of order 4. The higher orders make up for that, but not
//! everywhere: README has the table, losses included.
