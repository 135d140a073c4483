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
//! step; `cargo bench --bench scenes` has the costs.
//!
//! | kinetic term | order of a free body | its energy | a spin turns in a step by up to |
//! |---|---|---|---|
//! | [`RigidBody`], [`PrincipalBody`], (3.13) | 2 | conserved to rounding | 90° |
//! | [`CayleyBody`] | 2 | oscillates | 180°, at any speed |
//! | [`GeodesicBody`] | 2 | oscillates | 145° |
//! | [`FourthOrderBody`] | 4 | oscillates | 125° |
//! | [`SixthOrderBody`] | 6 | oscillates | 115° |
//!
//! The last three angles were measured for the bodies with the smallest limits, rods that spin end over end.
//!
//! | force | torque |
//! |---|---|
//! | [`Drag`] | `−c Ω` |
//! | [`AirDrag`] | `−c (Ω − w)` |
//! | [`MagneticDamping`] | `−k (B × Ω) × B` |
//! | [`Thrust`] | of a force that is constant in the body, at a point of it |
//! | [`Torque`] | constant in the body |
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
