//! Gradients: how a motion depends on its start and on its parameters.
//!
//! Before: [recording and events](super::recording). Next: [ensembles](super::ensembles).
//!
//! # What there is
//!
//! A declaration with the word `gradients`, as the library's effects have it, knows the derivatives of its steps: on any
//! group, in sums, with forces, through compositions, and through splittings, with force gradients and processed ones too,
//! with a declared flow, with [`SymmetricBody`](crate::methods::SymmetricBody) or with
//! [`ExactBody`](crate::methods::ExactBody). They are those of the discrete map, to rounding, not of the continuous equations.
//!
//! | you ask | |
//! |---|---|
//! | how one number at the end depends on everything | [`adjoint`](crate::gradients::Linearised::adjoint) |
//! | how everything at the end depends on a few numbers | [`step`](crate::gradients::Linearised::step) with a [`Tangent`](crate::gradients::Tangent) |
//! | the state transition matrix | [`Tangent::transition`](crate::gradients::Tangent::transition) |
//! | Lyapunov exponents | [`lyapunov_exponents`](crate::gradients::Linearised::lyapunov_exponents) |
//!
//! [`gradients`](crate::gradients) has the formulas, and the coordinates: a change of the state is `(ζ, δμ)`, with
//! `g ← g exp ζ̂`.
//!
//! # The adjoint
//!
//! How high a top stands after a second, and how that changes with its mass. The derivative is compared with a
//! difference:
//!
//! ```
//! use liestep::gradients::{Cotangent, Tape};
//! use liestep::prelude::*;
//!
//! let J_d = NonstandardInertia::from_diagonal(Vector3::new(2.0, 2.0, 1.0))?;
//! let up = Vector3::z();
//! let top = |m| Stepper::new(RigidBody { J_d } + Gravity { m, g: 9.81, rho: Vector3::z(), up }, 0.01);
//! let (attitude, momentum) = (SO3::exp(Vector3::x() * 0.5), Vector3::new(0.3, 0.0, 48.0));
//! let height = |m| -> Result<f64, Box<dyn std::error::Error>> {
//!     let stepper = top(m)?;
//!     let mut state = stepper.start_with_momentum(attitude, momentum)?;
//!     stepper.run(&mut state, 100)?;
//!     Ok((state.attitude().matrix() * Vector3::z()).dot(&up))
//! };
//!
//! let stepper = top(1.0)?;
//! let linear = stepper.linearised()?;
//! let mut state = stepper.start_with_momentum(attitude, momentum)?;
//! let gradient = linear.adjoint(&mut state, 100, Tape::All, |n, motion| {
//!     // w·e₃ of the vertical w in the body changes by −(ζ × w)·e₃ = −ζ·(w × e₃).
//!     let (_, w) = motion.advected();
//!     let height = Cotangent { attitude: -w.cross(&Vector3::z()), ..Cotangent::zero() };
//!     if n == 100 { height } else { Cotangent::zero() }
//! })?;
//! let mass = linear.numbers(1, "m").ok_or("no such field")?.start; // of the second term
//! let difference = (height(1.0 + 1e-5)? - height(1.0 - 1e-5)?) / 2e-5;
//! assert!((gradient.parameters[mass] - difference).abs() < 1e-8 * (1.0 + difference.abs()));
//! println!("by the start: {:?}", gradient.start);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The closure is asked for the derivative of what is added up at each step, so sums along the motion (a fit, a running
//! cost) are as simple as a number at the end. A whole gradient takes two plain steps for each step of a heavy top
//! (`cargo bench --bench gradients`): beside the step itself one linear system, and the chain rule from both momenta back,
//! which costs a few times what they cost themselves; a parameter more is a few operations more. It needs the states on the
//! way: a [`Tape`](crate::gradients::Tape) keeps all or checkpoints, and where `l_d` is self-adjoint
//! [`backwards`](crate::gradients::Linearised::backwards) keeps nothing and goes back by steps of `−h`.
//!
//! # The transition matrix and chaos
//!
//! ```
//! use liestep::prelude::*;
//!
//! let J_d = NonstandardInertia::from_diagonal(Vector3::new(2.0, 1.0, 0.6))?;
//! let gravity = Gravity { m: 1.0, g: 9.81, rho: Vector3::new(0.3, 0.2, 0.6), up: Vector3::z() };
//! let stepper = Stepper::new(RigidBody { J_d } + gravity, 0.01_f64)?;
//! let linear = stepper.linearised()?;
//! let mut state = stepper.start(SO3::exp(Vector3::x() * 1.5), Vector3::new(0.5, 1.0, 2.0))?;
//!
//! let mut tangent = linear.tangent(&[]);
//! for _ in 0..100 {
//!     linear.step(&mut state, &mut tangent)?;
//! }
//! // The matrix is symplectic, so it keeps volumes: its determinant is one.
//! let [[a, b], [c, d]] = tangent.transition();
//! let blocks = [a, b, c, d];
//! let whole = liestep::nalgebra::Matrix6::from_fn(|i, j| blocks[2 * (i / 3) + j / 3][(i % 3, j % 3)]);
//! assert!((whole.determinant() - 1.0).abs() < 1e-9);
//!
//! // So the exponents add up to nothing, over any time. Over a long one they come in pairs ±λ.
//! let exponents = linear.lyapunov_exponents(&mut state, 2_000, 20)?;
//! assert!(exponents[0] > 0.1 && exponents.iter().sum::<f64>().abs() < 1e-12);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A step of the matrix takes 2.8 plain ones (`cargo bench --bench gradients`): the second derivatives, and for each of six
//! columns five products by a 3 × 3 matrix, of four columns at once where the machine has vectors of four.
//!
//! After a time of `10/λ` derivatives tell nothing of a motion that isn't known to `e⁻¹⁰`; that isn't a fault of the
//! derivatives.
//!
//! # Fitting
//!
//! `cargo run --release --example calibrate` finds a top's inertia from the readings of a gyroscope, with the Jacobian from
//! these tangents in a solver of another crate. It says by the rank of that Jacobian what the readings can't show.
//!
//! # Other ways
//!
//! A scene that is generic over its scalar may be given dual numbers, [`numbers::Real`](crate::numbers::Real). That goes
//! through everything, remedies too.
