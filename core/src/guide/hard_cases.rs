//! Hard cases: what can go wrong, how it is said, and the ways out.
//!
//! Before: [accuracy and cost](super::accuracy). Next: [what is conserved](super::conserved).
//!
//! # When
//!
//! | | what you get |
//! |---|---|
//! | a declaration that means nothing | an error of the compiler at the token, with what to write |
//! | parameters or a start that can't be used | [`SetupError`](crate::SetupError), from `new` and `start` |
//! | a step without a solution | [`StepError`](crate::StepError), from `step` and `run`; the state is what it was |
//! | an accuracy that can't be had | [`AccuracyError`](crate::accuracy::AccuracyError) |
//! | a run that is observed and can't go on | [`RunError`](crate::recording::RunError), with the time |
//! | a file that can't be written, a checkpoint of another scene | [`RecordError`](crate::recording::RecordError), `with::CheckpointError` (feature `serde`) |
//!
//! No input makes the library panic, hang, or go on with NaN. What is read off a state may be NaN where there is nothing to
//! read: the velocity and the energy of a momentum that no velocity has, which an `l` that isn't quadratic in the velocity
//! may lead to. A step solves for increments, and doesn't need them. Errors are enums that aren't exhaustive, with the numbers
//! that one needs, and their text says what to do.
//!
//! # A step that is too long
//!
//! The momentum equation of (3.13) about a principal axis reads `sin θ = hΩ`: beyond a quarter turn a step there is no
//! solution, and before that there is a second one, `π − θ`, which isn't meant. A step takes the first, or says that
//! there is none. Toys and wheels spin that fast:
//!
//! ```
//! use liestep::effects::CayleyBody;
//! use liestep::motion::Remedy;
//! use liestep::prelude::*;
//!
//! let J = Inertia::from_principal_moments(Vector3::new(1.0, 2.0, 2.5))?;
//! let body = RigidBody { J_d: J.to_nonstandard() };
//! let (h, velocity) = (0.1, Vector3::new(0.0, 25.0, 0.0)); // 2.5 rad a step
//! let stepper = Stepper::new(body, h)?;
//! let mut state = stepper.start(SO3::identity(), velocity)?;
//! let before = state;
//! let Err(StepError::BeyondSolvable { largest, turn, .. }) = stepper.step(&mut state) else { panic!("it stepped") };
//! assert_eq!(state, before);
//! assert!((largest - 0.04).abs() < 1e-5 && (turn - 2.5).abs() < 1e-12); // sin θ = hΩ ≤ 1
//!
//! // 1. A step that is short enough.
//! assert!(Stepper::new(body, 0.9 * largest)?.step(&mut state).is_ok());
//!
//! // 2. The same step where there is one, and in equal parts where there isn't.
//! let patient = Stepper::new(body, h)?.or_substeps(8);
//! let mut state = patient.start(SO3::identity(), velocity)?;
//! assert_eq!(patient.step(&mut state)?.remedy, Some(Remedy::Substeps(4)));
//!
//! // 3. A kinetic term that has a solution at every step.
//! let cayley = Stepper::new(CayleyBody { J }, h)?;
//! let mut state = cayley.start(SO3::identity(), velocity)?;
//! assert!(cayley.step(&mut state).is_ok());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A step that divides itself isn't constant, so over many the energy may drift; the report of each step says what was
//! done. [`Stepper::max_step`](crate::Stepper::max_step) is the limit from a state, before it is tried, and
//! [`guarantees`](crate::conventions::guarantees#solvability) proves the conditions. A splitting with the exact motion of the
//! body ([accuracy](super::accuracy)) has no such limit either.
//!
//! # A body that isn't one
//!
//! ```
//! use liestep::prelude::*;
//!
//! // Moments that violate the triangle inequality, a body without extent, a number that isn't one.
//! assert!(NonstandardInertia::from_principal_moments(Vector3::new(1.0, 1.0, 3.0)).is_err());
//! let point = DiagonalNonstandardInertia::from_diagonal(Vector3::zeros());
//! assert!(point.is_err() || matches!(point.map(|J_d| Stepper::new(PrincipalBody { J_d }, 0.01)), Ok(Err(_))));
//!
//! let body = RigidBody { J_d: NonstandardInertia::from_diagonal(Vector3::new(2.0, 2.0, 1.0))? };
//! let gravity = Gravity { m: f64::NAN, g: 9.81, rho: Vector3::z(), up: Vector3::z() };
//! let refused = Stepper::new(body + gravity, 0.01).map(|_| ()).unwrap_err();
//! assert_eq!(refused, SetupError::Parameter { field: "m", cause: "is not finite" });
//! assert!(matches!(Stepper::new(body, f64::INFINITY), Err(SetupError::InvalidStep { .. })));
//! // A matrix that is no rotation doesn't become an attitude.
//! assert!(SO3::try_from(Matrix3::identity() * 1.1).is_err());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Rods and discs are bodies: what lacks is a direction without any inertia. A sign that is wrong in a declared kinetic term
//! is [`SetupError::NegativeKinetic`](crate::SetupError::NegativeKinetic), before the first step.
//!
//! # Things that aren't errors
//!
//! | | what happens |
//! |---|---|
//! | chaos | two runs that differ by a rounding part; the invariants of each are kept all the same. Derivatives grow as the deviations do |
//! | a stiff spring, a strong field | `V''` is in the step's error: a step well below its period, or collocation |
//! | a motion that comes to rest, or sleeps | solved as any other; nothing is divided by a speed |
//! | `h < 0` | steps back; `h = 0` changes nothing |
//! | `f32` | everything above, with its digits: a limit of 1e-7 and not 1e-16 |
//! | units far from one | as long as squares don't overflow; [`StepError::NonFinite`](crate::StepError::NonFinite) says so if they do |
//! | steady rotation for 10⁸ steps | rounds in the same direction each time; the attitude is put back into the group |
//!
//! # All of them, measured
//!
//! ```text
//! cargo run --release --example hard-cases             # each criterion beside what was measured; some minutes
//! cargo run --release --example hard-cases -- --row S1 # one of them
//! ```
//!
//! These are the cases that break integrators of rigid bodies: steps at the edge of solvability, thin rods, flips,
//! sleeping and chaotic tops, strong damping, millions of steps. Each is measured for this crate, for the updates of physics engines
//! and for RK4, and where a criterion is missed the table says so. `tests/hard_cases` has them as tests, and
//! `cargo test --release -p liestep-tests -- --ignored` adds those of up to 10⁸ steps.
//!
//! `tests/robustness` puts random scenes, states and steps into every method: an answer or a typed error, and nothing else. A
//! million of them are run by `LIESTEP_CASES=1000000 cargo test --release -p liestep-tests --test robustness random_inputs`.
