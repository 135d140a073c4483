//! Systems of rigid bodies held together by joints, with multipliers. A step of `N` bodies with `L` loops takes time
//! `O(N + N L + L³)`.
//!
//! The configurations of the bodies are `q = (R_a, x_a)` on (SO(3) × R³)ᴺ, and joints are functions `g(q) = 0` of
//! them. With the matrix `G` of their derivatives along `δR = R ẑ`, `δx`, a step is that of the scene with the
//! impulses of joints in its momentum equation (2.7), and the next places on the joints:
//!
//! ```text
//! a = μ + kick_before(w) − G(q)ᵀ λ            solve   U(F, w) = a,   g(q F) = 0            for F and λ
//! μ⁺ = Ad*_F a + kick_after(F, w⁺) − G(q⁺)ᵀ ν          with ν such that G(q⁺) J⁻¹ μ⁺ = 0
//! ```
//!
//! That is RATTLE of (2.7) and (2.9). As `λ` takes what `ν` has left, positions are those of SHAKE; with `ν`
//! velocities keep to the joints, too. The step is variational: order 2, symmetric and symplectic where the scene's
//! is, and in the coordinates that are left, if one has them, the same as the step of the minimal form.
//! [`LinkedBodies`](super::LinkedBodies) has these for chains.
//!
//! What [`Stepper::jointed`](crate::Stepper::jointed) takes is a scene on bodies `(SO3, R3)`, of which terms may
//! couple anything but velocities, and [`Joints`]. There are no limits, motors or contacts.
//!
//! The unknowns of Newton's iteration are half the coordinates `y` of `F` and the multipliers, of which the residual
//! is an affine function, so that none is kept from step to step.

mod constraint;
mod elimination;
mod equations;
mod graph;
mod jointed;
mod places;
mod plan;
mod start;

pub use constraint::{BallJoint, Constraint, Joint, PinJoint, Place, Slope};
pub use graph::{Joints, PlacedJoint};
pub use jointed::JointedBodies;
