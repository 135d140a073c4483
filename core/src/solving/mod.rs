//! Solving the momentum equation (2.7) for the increment `F`, and bounds on its solutions.
//!
//! [`problem`] is the solve that a step usually makes, by Newton's [`iteration`]; [`reused_jacobian`] and [`lanes`] are
//! its cheaper and its wider forms, and [`careful`] has the fallbacks and the check that the solution is on the branch
//! of `F = I`. This room has neither states nor time.

mod careful;
mod constrained;
mod guess;
mod iteration;
mod lanes;
mod largest_step;
mod problem;
mod reused_jacobian;
mod solvability;

pub use guess::{Guess, WarmStart};
pub(crate) use iteration::Root;
pub use iteration::{LONGEST_DAMPED, MAX_DAMPED_ITERATIONS, MAX_ITERATIONS, MOST_HALVINGS, SETTLED};
pub use largest_step::{largest_fraction, six_digits};
pub(crate) use problem::{Problem, newton_residual, newton_system, step_terms};
pub(crate) use reused_jacobian::Curvature;
pub use reused_jacobian::{NEAR_ENOUGH, SUFFICIENT, has_sufficed, may_suffice, safe};
pub use solvability::{Solvability, TurningLimits, turning_limits};
