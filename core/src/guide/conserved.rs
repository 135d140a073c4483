//! What is conserved, in numbers.
//!
//! Before: [hard cases](super::hard_cases). Next: [recording and events](super::recording).
//!
//! [`guarantees`](crate::conventions::guarantees) says what a step conserves, and under which conditions. Here are the
//! numbers, each checked by the listing below it.
//!
//! # A heavy symmetric top, 100 s
//!
//! The looping top of the thesis, `h = 0.01 s`, 10,000 steps. Largest deviations from the start, on the way:
//!
//! | quantity | deviation below | |
//! |---|---|---|
//! | attitude: `‖RᵀR − I‖` | 5e-14 | rounding |
//! | `e₃·RΠ`, relative | 2e-14 | rounding; (3.20) |
//! | `Π₃`, relative: the top is symmetric | 5e-14 | rounding |
//! | energy, relative, in the first tenth of the run | 3e-5 | the method: `h²` |
//! | energy, relative, in the last tenth | as in the first, within 2 % | it oscillates, and doesn't drift |
//! | energy with half of the step | a quarter, within 5 % | |
//! | there and back: 10,000 steps of `−h` | 1e-10 | rounding, as the motion magnifies it |
//!
//! ```
//! use liestep::prelude::*;
//!
//! /// Deviations of attitude, vertical and axial momentum, and of the energy in the first and in the last tenth.
//! fn deviations(h: f64, steps: u64) -> Result<[f64; 5], Box<dyn std::error::Error>> {
//!     let J_d = DiagonalNonstandardInertia::from_diagonal(Vector3::new(2.0, 2.0, 1.0))?;
//!     let top = PrincipalBody { J_d } + Gravity { m: 1.0, g: 9.81, rho: Vector3::z(), up: Vector3::z() };
//!     let stepper = Stepper::new(top, h)?;
//!     let (tilt, precession, nutation, spin): (f64, f64, f64, f64) = (0.8, 3.0, 0.5, 10.0);
//!     let velocity = Vector3::new(nutation, precession * tilt.sin(), spin + precession * tilt.cos());
//!     let start = stepper.start(SO3::exp(Vector3::x() * tilt), velocity)?;
//!
//!     let vertical = |state: &State<_, _, _>| state.momentum_along(&Vector3::z());
//!     let (energy, mut worst, mut state) = (stepper.energy(&start), [0.0_f64; 5], start);
//!     for step in 0..steps {
//!         stepper.step(&mut state)?;
//!         let tenth = if step < steps / 10 { 3 } else { 4 };
//!         let counts = tenth == 3 || step >= steps - steps / 10;
//!         let now = [
//!             (0, state.orthogonality_defect()),
//!             (1, (vertical(&state) / vertical(&start) - 1.0).abs()),
//!             (2, (state.momentum().z / start.momentum().z - 1.0).abs()),
//!             (tenth, if counts { (stepper.energy(&state) / energy - 1.0).abs() } else { 0.0 }),
//!         ];
//!         now.into_iter().for_each(|(place, deviation)| worst[place] = worst[place].max(deviation));
//!     }
//!
//!     let back = stepper.inverse()?;
//!     let mut returned = back.adopt(&state);
//!     back.run(&mut returned, steps)?;
//!     assert!((returned.attitude().matrix() - start.attitude().matrix()).norm() < 1e-10);
//!     Ok(worst)
//! }
//!
//! let [attitude, vertical, axial, first, last] = deviations(0.01, 10_000)?;
//! assert!(attitude < 5e-14 && vertical < 2e-14 && axial < 5e-14, "{attitude:e} {vertical:e} {axial:e}");
//! assert!(first < 3e-5 && (last / first - 1.0).abs() < 0.02, "{first:e} {last:e}");
//! let [.., halved] = deviations(0.005, 20_000)?;
//! assert!((last / halved / 4.0 - 1.0).abs() < 0.05, "{last:e} {halved:e}");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! After a million steps, of the length that reaches an error of 1e-4 after 10 s, `cargo run --release --example
//! accuracy-cost` has found of the same top:
//!
//! | method | energy | vertical momentum | `‖RᵀR − I‖` |
//! |---|---|---|---|
//! | (3.13) | 7.0e-9 | 2.3e-14 | 5.2e-14 |
//! | exact motion of the symmetric body, force gradient 4-4 (`h = 0.27 s`) | 1.5e-6 | 1.2e-12 | 1.7e-13 |
//! | RK4, quaternion brought back to unit length | 1.8e-5 | 3.7e-4 | 5.5e-16 |
//! | DOP853, fixed step | 2.8e-2 | 0.91 | 1.3 |
//!
//! `cargo run --release --example heavy-top` prints its deviations beside RK4's, whose energy drifts: its deviation is ten times as
//! large in the last tenth of a run of 200 s as in the first.
//!
//! # A free body
//!
//! With the kinetic term of (3.13) the energy of a free body is kept as well, and the momentum in space as a vector. An
//! asymmetric body that flips about its middle axis, `h = 0.01 s`, 10,000 steps:
//!
//! | quantity | deviation below |
//! |---|---|
//! | `RΠ`, relative | 2e-13 |
//! | energy, relative | 2e-13 |
//! | energy with [`CayleyBody`](crate::effects::CayleyBody), relative | 1e-3, and above 1e-6: it oscillates |
//!
//! ```
//! use liestep::effects::CayleyBody;
//! use liestep::mechanics::{DiscreteLagrangian, LeftInvariant, Regular};
//! use liestep::prelude::*;
//!
//! fn deviations<B>(body: B) -> Result<[f64; 2], Box<dyn std::error::Error>>
//! where
//!     B: DiscreteLagrangian<Scalar = f64, Group = SO3> + Regular + LeftInvariant,
//! {
//!     let stepper = Stepper::new(body, 0.01)?;
//!     let start = stepper.start(SO3::identity(), Vector3::new(0.01, 2.0, 0.02))?;
//!     let (momentum, energy) = (stepper.spatial_momentum(&start), stepper.energy(&start));
//!     let (mut worst, mut state) = ([0.0_f64; 2], start);
//!     for _ in 0..10_000 {
//!         stepper.step(&mut state)?;
//!         let lost = (stepper.spatial_momentum(&state) - momentum).norm() / momentum.norm();
//!         worst = [worst[0].max(lost), worst[1].max((stepper.energy(&state) / energy - 1.0).abs())];
//!     }
//!     Ok(worst)
//! }
//!
//! let J = Inertia::from_principal_moments(Vector3::new(1.0, 2.0, 2.5))?;
//! let [momentum, energy] = deviations(RigidBody { J_d: J.to_nonstandard() })?;
//! assert!(momentum < 2e-13 && energy < 2e-13, "{momentum:e} {energy:e}");
//! let [momentum, energy] = deviations(CayleyBody { J })?;
//! assert!(momentum < 2e-13 && energy > 1e-6 && energy < 1e-3, "{momentum:e} {energy:e}");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The bounds of traits say it in types: what has no [`LeftInvariant`](crate::mechanics::LeftInvariant), a heavy top for
//! example, has no `spatial_momentum` of its stepper, and the program doesn't compile.
//!
//! # What isn't
//!
//! The phase: a top that precesses a little too fast is ahead by an amount that grows with time, of order `h²`. It is what an
//! error of a long run consists of, and what a [higher order](super::accuracy) buys.
//!
//! The energy of a damped or driven scene isn't kept, of course; but it isn't wrong by a drift of the method's, and a
//! [force](super::effects#forces) of the library doesn't pump.
//!
//! # Longer, and against others
//!
//! | | |
//! |---|---|
//! | a million steps of every method, and of explicit Runge–Kutta methods | `cargo run --release --example accuracy-cost` |
//! | 10⁸ steps | `cargo test --release -p liestep-tests -- --ignored` |
//! | the Poisson structure, by the Jacobian of a step | `tests/common/structure/poisson.rs`, `tests/accuracy/poisson.rs` |
//! | the energy that a step keeps to order `h⁴` | [`guarantees`](crate::conventions::guarantees#conserved), `cargo cases --row T2` |
