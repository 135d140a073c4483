//! Systems of rigid bodies with joints, by multipliers. A step of `N` bodies with `L` loops takes time
//! `O(N + N L + L³)`.
//!
//! The configurations of the bodies are `q = (R_a, x_a)` on (SO(3) × R³)ᴺ, and joints are constraints `g(q) = 0`. With
//! the matrix `G` of the constraints' derivatives along `δR = R ẑ`, `δx`, a step is that of the scene with the joints'
//! impulses in its momentum equation (2.7), and with the constraints imposed on the next configuration:
//!
//! ```text
//! a = μ + kick_before(w) − G(q)ᵀ λ            solve   U(F, w) = a,   g(q F) = 0            for F and λ
//! μ⁺ = Ad*_F a + kick_after(F, w⁺) − G(q⁺)ᵀ ν          with ν such that G(q⁺) J⁻¹ μ⁺ = 0
//! ```
//!
//! The step is RATTLE for (2.7) and (2.9). Positions are those of SHAKE, as `λ` absorbs the last `ν`; `ν` makes
//! velocities satisfy the constraints, too. The step is variational: order 2, symmetric and symplectic if the scene's
//! is. In minimal coordinates, if there are any, it is the same as the step of the minimal form.
//! [`LinkedBodies`](super::LinkedBodies) has these for chains.
//!
//! [`Stepper::jointed`](crate::Stepper::jointed) takes [`Joints`], and a scene on bodies `(SO3, R3)` whose terms may
//! couple anything but velocities. There are no limits, motors or contacts.
//!
//! The unknowns of Newton's iteration are half the coordinates `y` of `F` and the multipliers. The residual is affine
//! in the multipliers, so they need no initial guess from the last step.

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
