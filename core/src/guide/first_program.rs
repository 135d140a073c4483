//! A first program, line by line: a heavy top.
//!
//! Next: [effects and forces](super::effects). Who comes from the thesis may begin with [`thesis`](super::thesis).
//!
//! # A package
//!
//! ```toml
//! [dependencies]
//! liestep = { path = "../liestep/core" } # a clone beside your package
//! ```
//!
//! nalgebra comes with it, as [`liestep::nalgebra`](crate::nalgebra), so that the versions always fit. What most programs
//! need is in the [`prelude`](crate::prelude).
//!
//! # A scene of the library
//!
//! The shortest program adds effects of [`effects`](crate::effects) and steps:
//!
//! ```
//! use liestep::prelude::*;
//!
//! // Kilograms, metres, seconds; any other coherent units will do.
//! let body = RigidBody { J_d: NonstandardInertia::from_diagonal(Vector3::new(2.0, 2.0, 1.0))? };
//! let gravity = Gravity { m: 1.0, g: 9.81, rho: Vector3::z(), up: Vector3::z() };
//! let stepper = Stepper::new(body + gravity, 0.01_f64)?; // s
//!
//! let tilted = UnitQuaternion::from_scaled_axis(Vector3::new(0.8, 0.0, 0.0));
//! let mut state = stepper.start(tilted, Vector3::new(0.5, 2.0, 12.0))?;
//! let vertical = state.momentum_along(&Vector3::z());
//! for _ in 0..1000 {
//!     stepper.step(&mut state)?;
//! }
//! assert!((stepper.time(&state) - 10.0).abs() < 1e-12);
//! assert!((state.momentum_along(&Vector3::z()) - vertical).abs() < 1e-12);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! * The effects are generic over their scalar, so one number has to say which it is: `0.01_f64`. All of this goes with `f32`,
//!   too.
//! * `J_d` is the nonstandard inertia `∫ X Xᵀ dm` about the pivot, which the thesis writes its Lagrangians with. Of ordinary
//!   moments of inertia [`NonstandardInertia::from_principal_moments`](crate::NonstandardInertia::from_principal_moments)
//!   makes it. They are different types so that one can't be given for the other; see
//!   [`conventions`](crate::conventions#j_d-and-j-readings-a-and-b).
//! * `rho` is the centre of mass in the body, `up` the vertical in space.
//! * [`Stepper::new`](crate::Stepper::new) looks at the parameters and folds the constants of a step of 0.01 s. What can't
//!   be stepped is a [`SetupError`](crate::SetupError) that names the field.
//! * [`start`](crate::Stepper::start) takes an attitude, body to space, and a velocity in the body frame, rad/s. The momentum
//!   is `𝕀Ω`, without half a kick. A motion that is known by its momentum starts with
//!   [`start_with_momentum`](crate::Stepper::start_with_momentum).
//! * [`step`](crate::Stepper::step) solves the momentum equation (2.7) by Newton's method and goes on to the next state, or
//!   returns a [`StepError`](crate::StepError) and leaves the state alone. [`run`](crate::Stepper::run) makes many.
//!
//! # What a state tells
//!
//! | | | frame, unit |
//! |---|---|---|
//! | `state.attitude()` | `g`, an [`SO3`](crate::SO3) | body to space |
//! | `state.momentum()` | `μ` | body, kg m²/s |
//! | `state.advected()` | what the body sees: `w = g⁻¹·up` | body |
//! | `state.spatial_momentum()`, `state.momentum_along(&e)` | `g μ`, and a component of it | space, kg m²/s |
//! | `state.orthogonality_defect()` | `‖gᵀg − I‖` | 1 |
//! | `state.steps()` | steps since the start | |
//! | `stepper.velocity(&state)`, `stepper.energy(&state)` | `Ω`, `E` | body, rad/s; J |
//! | `stepper.time(&state)` | `n h` | s |
//!
//! Attitudes are read as a matrix (`attitude().matrix()`), as a quaternion (`attitude().to_quaternion()`, or by `into()` for
//! nalgebra's types) and as Euler angles (`attitude().euler_angles()`).
//!
//! # The same, declared
//!
//! A Lagrangian of one's own is a struct. This is the same top, in one declaration, as (3.13) has it:
//!
//! ```
//! use liestep::prelude::*;
//!
//! /// A heavy top.
//! #[lagrangian(
//!     group = SO3,
//!     advected(w = up),
//!     l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)
//!         - 0.5 * h * m * g * w.dot(&(rho + F * rho)),
//! )]
//! struct HeavyTop {
//!     J_d: NonstandardInertia,
//!     m: f64,
//!     g: f64,
//!     rho: Vector3<f64>,
//!     up: Vector3<f64>,
//! }
//!
//! let J_d = NonstandardInertia::from_diagonal(Vector3::new(2.0, 2.0, 1.0))?;
//! let (rho, up) = (Vector3::z(), Vector3::z());
//! let declared = Stepper::new(HeavyTop { J_d, m: 1.0, g: 9.81, rho, up }, 0.01)?;
//! let summed = Stepper::new(RigidBody { J_d } + Gravity { m: 1.0, g: 9.81, rho, up }, 0.01)?;
//!
//! let (attitude, velocity) = (SO3::from_euler_angles(0.0, 0.8, 0.0), Vector3::new(0.5, 2.0, 12.0));
//! let (mut one, mut other) = (declared.start(attitude, velocity)?, summed.start(attitude, velocity)?);
//! declared.run(&mut one, 1000)?;
//! summed.run(&mut other, 1000)?;
//! assert!((one.momentum() - other.momentum()).norm() < 1e-10);
//!
//! // What was derived is text, too; of a type alone it is its `DERIVATION`, of the trait `Effect`.
//! let diamond = "δl_d/δw ⋄ w = (h m g/2) (F rho wᵀ − w rhoᵀ Fᵀ + rho wᵀ − w rhoᵀ)^∨    [(2.1)]";
//! assert!(declared.derivation().contains(diamond));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! | in the declaration | |
//! |---|---|
//! | `group = SO3` | the group that `F` belongs to |
//! | `F` | the increment of a step, `g_{i+1} = g_i F` |
//! | `I`, `h` | the identity, the step in s |
//! | `advected(w = up)` | `w` is the field `up` as the body sees it, `g⁻¹·up`; the group carries it along |
//! | the other names | the fields of the struct |
//! | `l_d` | the action of a step: a kinetic part like `h⁻¹ (F − I)²`, and `−h` times a potential |
//!
//! The potential is taken half at either end: `w·ρ` at the beginning, `F⁻¹w·ρ = w·Fρ` at the end. That makes the step
//! self-adjoint, and of second order.
//!
//! The expression is ordinary Rust over nalgebra, and is compiled as the method `l_d` as it stands. From it the macro
//! derives both momentum maps, the diamond, the Legendre transforms, the momentum equation and its Newton Jacobian, as
//! straight-line code, when your crate is compiled. `cargo doc --open` shows them on the page of your struct. Which
//! functions may be used is on the page of [`lagrangian`](macro@crate::lagrangian); how they are made into code, in
//! [`inside`](super::inside).
//!
//! The letters `J_d`, `F`, `J` are those of the field. The macro keeps the compiler from complaining about them in the
//! struct; for variables of your own write `#![allow(non_snake_case)]`, or another name.
//!
//! # Mistakes
//!
//! A mistake in a declaration is an error of the compiler, at the smallest token that is wrong, which says what to write:
//!
//! ```text
//! error: `roh` isn't known here; did you mean `rho`?
//! error: a scalar can't be added to a vector of 3: take a `.dot(…)` or a component of the vector
//! ```
//!
//! What only a number shows (an inertia that no body has, a step without a solution) is a typed error when the program
//! runs: see [`hard_cases`](super::hard_cases).
//!
//! # Continuous Lagrangians
//!
//! A Lagrangian may be declared before it is discretised, as `l(Ω, w)` in the body velocity. The trapezoidal rule makes (3.13)
//! of the top's, so the steps are those above, to the bit:
//!
//! ```
//! use liestep::mechanics::ContinuousLagrangian;
//! use liestep::motion::RightHandSide;
//! use liestep::prelude::*;
//!
//! #[lagrangian(
//!     group = SO3,
//!     velocity = Omega,
//!     advected(w = up),
//!     l = 0.5 * (hat(Omega) * J_d * hat(Omega).transpose()).trace() - m * g * w.dot(&rho),
//!     discretise = trapezoid,
//! )]
//! #[derive(Clone)]
//! struct Top {
//!     J_d: NonstandardInertia,
//!     m: f64,
//!     g: f64,
//!     rho: Vector3<f64>,
//!     up: Vector3<f64>,
//! }
//!
//! let J_d = NonstandardInertia::from_diagonal(Vector3::new(2.0, 2.0, 1.0))?;
//! let top = Top { J_d, m: 1.0, g: 9.81, rho: Vector3::z(), up: Vector3::z() };
//!
//! let (torque, turn) = top.lie_poisson(&Vector3::new(1.5, 6.0, 48.0), &Vector3::z())?; // μ̇ and ẇ
//! assert!(torque.z.abs() < 1e-12 && turn.z == 0.0);
//! let equations = RightHandSide::new(top.clone())?; // for any ODE solver: equations.rate(&state, &mut rate)
//! let stepper = Stepper::new(top, 0.01)?; // the structure-preserving steps
//! assert_eq!(equations.lagrangian().m, stepper.scene().m);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The momentum, the diamond term, the Euler–Poincaré and Lie–Poisson equations and the Hamiltonian are derived, and
//! checked in exact arithmetic when your crate is compiled; so is the claim that `l` is the limit of the discretised one.
//! The kinetic part of `l`, or of an `l_d` as h → 0, needn't be quadratic in the velocity: then Newton's
//! iteration finds the velocity of a momentum.
//! The page of [`lagrangian`](macro@crate::lagrangian) lists the ways to discretise. That line may be left out:
//! [`CotangentGauss`](crate::methods::CotangentGauss) integrates any smooth `l` of one body, on any group. Scenes that are declared by
//! `l_d` have the continuous equations of their limit. The listings in [`thesis`](super::thesis) begin with `l`.
