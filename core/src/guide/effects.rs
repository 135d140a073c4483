//! Effects and forces: adding, and writing one's own.
//!
//! Before: [a first program](super::first_program). Next: [groups](super::groups).
//!
//! # Sums
//!
//! A scene is a sum. Lagrangians of one group add, and so do their momentum maps, diamonds, Jacobians and energies; forces
//! add to them. [`effects`](crate::effects) lists those of the library with their energies and torques. What isn't in the
//! sum isn't in the program: no flag, no field, no multiplication by zero, which
//! `cargo bench --bench scenes -- zero-cost` counts in instructions.
//!
//! A sum has to have a body, which gives it a kinetic part. A potential alone, terms of two groups, or the spatial
//! momentum of a heavy body don't compile, and the message says why.
//!
//! # A potential of one's own
//!
//! It is a Lagrangian without a kinetic part: `−h` times the potential, half of it at either end of the step, where the body
//! sees `w` and `F⁻¹·w`. A vector `ρ` of the body is measured by `w·ρ` at the beginning and by `(F⁻¹·w)·ρ = w·(Fρ)` at the end.
//!
//! A wire along the vertical that resists being bent, `V = ½ k (1 − a·w)²` with the direction `a` of the wire in the body:
//!
//! ```
//! use liestep::prelude::*;
//!
//! #[lagrangian(
//!     group = SO3,
//!     advected(w = up),
//!     l_d = -0.25 * h * k * ((1.0 - w.dot(&axis)).powi(2) + (1.0 - w.dot(&(F * axis))).powi(2)),
//! )]
//! #[derive(Clone, Copy)]
//! struct Wire {
//!     k: f64,             // N m
//!     axis: Vector3<f64>, // body frame
//!     up: Vector3<f64>,   // space
//! }
//!
//! let J_d = NonstandardInertia::from_diagonal(Vector3::new(2.0, 2.0, 1.0))?;
//! let gravity = Gravity { m: 1.0, g: 9.81, rho: Vector3::z(), up: Vector3::z() };
//! let wire = Wire { k: 30.0, axis: Vector3::z(), up: Vector3::z() };
//! let stepper = Stepper::new(RigidBody { J_d } + gravity + wire, 0.01)?;
//!
//! let mut state = stepper.start(SO3::from_euler_angles(0.0, 0.8, 0.0), Vector3::new(0.5, 0.0, 1.0))?;
//! let (energy, vertical) = (stepper.energy(&state), state.momentum_along(&Vector3::z()));
//! stepper.run(&mut state, 2000)?;
//! assert!((stepper.energy(&state) - energy).abs() < 1e-2 * energy.abs()); // it oscillates
//! assert!((state.momentum_along(&Vector3::z()) - vertical).abs() < 1e-11); // it is kept
//!
//! // The energy of the new term is at hand by itself, too.
//! let seen = Vector3::new(0.0, 0.6, 0.8);
//! assert!((wire.potential(&seen) - 0.5 * 30.0 * 0.04).abs() < 1e-14);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! `cargo how-to` tests a longer one, `examples/how-to-add-an-effect.rs`. A kinetic term of one's own is declared in the same
//! way; [`effects`](crate::effects) has five, and the table in [`accuracy`](super::accuracy) says what they cost.
//!
//! What is advected is a covector unless its type says otherwise: [`groups`](super::groups).
//!
//! # Forces
//!
//! What has no potential is declared by its virtual work in a step, the discrete Lagrange–d'Alembert principle
//! \[MW01\]. `eta` and `eta_next` are the virtual turns of the body at the two ends of the step, each in the body's axes
//! then. A torque that acts half at either end is `0.5 * h * torque.dot(&(eta + eta_next))`.
//!
//! A motor about an axis of the body, which with the axis of symmetry changes nothing else, and a brake:
//!
//! ```
//! use liestep::effects::Drag;
//! use liestep::prelude::*;
//!
//! #[force(group = SO3, work = 0.5 * h * torque * axis.dot(&(eta + eta_next)))]
//! struct Motor {
//!     torque: f64,        // N m
//!     axis: Vector3<f64>, // body frame
//! }
//!
//! let J_d = NonstandardInertia::from_diagonal(Vector3::new(2.0, 2.0, 1.0))?;
//! let motor = || Motor { torque: 0.5, axis: Vector3::z() };
//!
//! let driven = Stepper::new(RigidBody { J_d } + motor(), 0.01)?;
//! let mut state = driven.start(SO3::identity(), Vector3::new(0.0, 0.0, 1.0))?;
//! let before = state.momentum().z;
//! driven.run(&mut state, 200)?;
//! assert!((state.momentum().z - before - 0.5 * 2.0).abs() < 1e-12); // the impulse of 2 s
//!
//! // Against drag it comes to the speed at which they balance: torque / c.
//! let drag = Drag { c: 0.1, J: J_d.to_inertia() };
//! let braked = Stepper::new(RigidBody { J_d } + motor() + drag, 0.01)?;
//! let mut state = braked.start(SO3::identity(), Vector3::zeros())?;
//! braked.run(&mut state, 100_000)?;
//! assert!((braked.velocity(&state).z - 5.0).abs() < 0.02);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! On other groups `eta` has a component for each generator. On SE(3) `hat(eta) * p` is how far the body's point `p` goes, so
//! a thruster at `p` does the work `0.5 * h * f.dot(&(hat(eta + eta_next) * p))`:
//! `examples/declarations/flyer.rs`, and `cargo run --release --example driven` for what it looks like.
//!
//! However strong the damping of the library's forces is, no spin turns over, and with (3.13) the energy of a free body
//! never rises in a step. [`Drag`](crate::effects::Drag) says how that is done; a brake of one's own that takes half of its
//! impulse at either end does turn spins over once `c h` is larger than about twice the inertia.
//!
//! # What changes with time
//!
//! Declarations know no time. What changes is given to a step, and there are three ways:
//!
//! | | |
//! |---|---|
//! | a torque, anew each step | [`step_forced`](crate::Stepper::step_forced) |
//! | other values of what is advected, or of what the declaration names in `given(…)` | [`step_with`](crate::Stepper::step_with) |
//! | another scene from now on | [`adopt`](crate::Stepper::adopt) of another stepper |
//!
//! ```
//! use liestep::groups::Given;
//! use liestep::prelude::*;
//!
//! /// A wheel: `u` is the field `torque` until a step is given another value.
//! #[force(group = SO3, given(u = torque), work = 0.5 * h * u * (eta + eta_next)[2])]
//! struct Wheel {
//!     torque: f64,
//! }
//!
//! let J_d = NonstandardInertia::from_principal_moments(Vector3::new(2.0, 3.0, 4.0))?;
//! let stepper = Stepper::new(RigidBody { J_d } + Wheel { torque: 0.0 }, 0.01)?;
//! let mut state = stepper.start(SO3::identity(), Vector3::zeros())?;
//! for _ in 0..100 {
//!     // The middle of the step keeps the order of the method.
//!     let torque = stepper.time(&state) + 0.005;
//!     stepper.step_with(&mut state, &((), Given::scalar(torque)))?;
//! }
//! assert!((state.momentum().z - 0.5).abs() < 1e-14); // ∫ t dt
//!
//! // A control law, held over a step.
//! for _ in 0..1000 {
//!     let torque = stepper.velocity(&state) * -8.0;
//!     stepper.step_forced(&mut state, &torque)?;
//! }
//! assert!(stepper.velocity(&state).norm() < 1e-6);
//!
//! // Gravity sets in: attitude and momentum stay.
//! let heavy = RigidBody { J_d } + Gravity { m: 1.0, g: 9.81, rho: Vector3::x(), up: Vector3::z() };
//! let heavy = Stepper::new(heavy, 0.01)?;
//! let mut falling = heavy.adopt(&state);
//! assert_eq!(falling.momentum(), state.momentum());
//! heavy.run(&mut falling, 10)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The values of a sum are pairs, from the left: `((), Given::scalar(…))` for a body that sees nothing and a wheel. A scene
//! that names nothing as given has nothing of it in its program.
//!
//! # What it costs
//!
//! The costs of a step are from `cargo bench --bench scenes`, the instructions with `-- instructions` (asymmetric body in
//! principal axes, `h = 0.01 s`, one core of an Intel Xeon):
//!
//! | gravity | instructions a step | ns a step |
//! |---|---|---|
//! | absent | 579 | 56 |
//! | there, behind a run-time flag that is off | 634 | 60 |
//! | there, with `m = 0` | 677 | 63 |
//! | on | 677 | 64 |
//! | on, in one declaration with the body | 677 | 63 |
//! | on, behind a run-time flag | 659 | 71 |
//!
//! | body and | instructions a step | ns a step |
//! |---|---|---|
//! | torque | 598 | 61 |
//! | thrust | 598 | 61 |
//! | gravity | 677 | 64 |
//! | dipole | 663 | 66 |
//! | gravity gradient | 717 | 82 |
//! | spring | 777 | 110 |
//! | rotor (in one declaration: 815, 78) | 850 | 70 |
//! | drag | 751 | 76 |
//! | magnetic damping | 1774 | 160 |
