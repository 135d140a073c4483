//! Effects on a rigid body, which are added up to scenes: `RigidBody { … } + Gravity { … }`.
//!
//! Each effect is a declaration like a user's own, and is added to those. A scene needs a body; an effect that isn't in
//! the sum isn't simulated. The attitude turns the body's axes into space. Vectors "in space" are advected: in the body
//! frame they turn.
//!
//! | effect | energy |
//! |---|---|
//! | [`RigidBody`], [`PrincipalBody`] | kinetic, `½ Ω·JΩ` |
//! | [`Gravity`] | `m g R ρ·up` |
//! | [`GravityGradient`] | `3 GM/(2 r³) n·Jn` |
//! | [`Dipole`] | `−m·B` |
//! | [`Spring`] | `½ k (|R r − a| − l)²` |
//! | [`Rotor`] | none of its own: it shifts the momentum, `JΩ + s` |
//!
//! The body can be discretised in several ways, which differ in order, in cost and in how far a body may turn in a
//! step; `cargo bench -p liestep-benches -- scenes` has the costs.
//!
//! | kinetic term | order of a free body | its energy | a step has a solution up to `hΩ` = | a spin turns too far at `hΩ` = 0.1, 1 |
//! |---|---|---|---|---|
//! | [`RigidBody`], [`PrincipalBody`], (3.13) | 2 | conserved to rounding | 1 rad, and turns by 90° there | by 0.17 %, 57 % |
//! | [`CayleyBody`] | 2 | oscillates | any, and turns by less than 180° | by −0.33 %, −20 % |
//! | [`GeodesicBody`] | 2 | oscillates | 2.5 rad, 145° | exact |
//! | [`FourthOrderBody`] | 4 | oscillates | 2.2 rad, 125° | exact |
//! | [`SixthOrderBody`] | 6 | oscillates | 2 rad, 115° | exact |
//!
//! The last three angles were measured on the bodies that bear the least, rods that spin end over end. A spin is one about a
//! principal axis. A step of (3.13) turns it by `asin hΩ`, so that the phase is ahead by the part `(hΩ)²/6 + 3(hΩ)⁴/40 + …`: by
//! 0.6° in each turn at `hΩ` = 0.1, and by 205° at the limit of solvability, `hΩ` = 1. In Cayley coordinates the phase lags
//! behind by the part `(hΩ)²/3 − …`. A fast spin takes a geodesic term, or a shorter step:
//!
//! ```
//! use liestep::effects::{CayleyBody, GeodesicBody};
//! use liestep::mechanics::Regular;
//! use liestep::prelude::*;
//!
//! /// The excess of the turn of a body with this `hΩ`, relative to it.
//! fn excess<B: Regular<Scalar = f64, Group = SO3>>(body: B, turn: f64) -> Result<f64, Box<dyn std::error::Error>> {
//!     let stepper = Stepper::new(body, 1.0)?;
//!     let mut state = stepper.start(SO3::identity(), Vector3::z() * turn)?;
//!     stepper.step(&mut state)?;
//!     Ok(state.attitude().log().z / turn - 1.0)
//! }
//! let J = Inertia::from_principal_moments(Vector3::new(1.0, 2.0, 2.5))?;
//! let rigid = RigidBody { J_d: J.to_nonstandard() };
//! assert!((360.0 * excess(rigid, 0.1)? - 0.60).abs() < 0.01); // degrees in each turn
//! assert!((360.0 * excess(rigid, 1.0 - 1e-9)? - 205.0).abs() < 1.0);
//! assert!(excess(rigid, 1.001).is_err()); // no solution
//! assert!((excess(CayleyBody { J }, 0.1)? + 0.0033).abs() < 1e-4);
//! assert!((excess(CayleyBody { J }, 1.0)? + 0.198).abs() < 1e-3);
//! assert!(excess(GeodesicBody { J }, 1.0)?.abs() < 1e-14);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! | force | torque |
//! |---|---|
//! | [`Drag`] | `−c Ω` |
//! | [`AirDrag`] | `−c (Ω − w)` |
//! | [`MagneticDamping`] | `−k (B × Ω) × B` |
//! | [`Thrust`] | of a force that is constant in the body, at a point of it |
//! | [`Torque`] | constant in the body |
//!
//! Springs, friction and motors in [`joints`] are terms between two bodies.
//!
//! A torque that is prescribed step by step isn't an effect but an argument of the step:
//! [`Stepper::step_forced`](crate::motion::Stepper::step_forced).

mod cayley_body;
mod dipole;
mod drag;
mod geodesic_body;
mod gravity;
mod gravity_gradient;
mod higher_order_body;
pub mod joints;
mod magnetic_damping;
mod rigid_body;
mod rotor;
mod spring;
mod thrust;
mod torque;

pub use cayley_body::CayleyBody;
pub use dipole::Dipole;
pub use drag::{AirDrag, Drag};
pub use geodesic_body::GeodesicBody;
pub use gravity::Gravity;
pub use gravity_gradient::GravityGradient;
pub use higher_order_body::{FourthOrderBody, SixthOrderBody};
pub use magnetic_damping::MagneticDamping;
pub use rigid_body::{PrincipalBody, RigidBody};
pub use rotor::Rotor;
pub use spring::Spring;
pub use thrust::Thrust;
pub use torque::Torque;
