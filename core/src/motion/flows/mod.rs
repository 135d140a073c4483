//! The two flows of the thesis: on increments, (2.5), and on momenta, (2.8).

mod euler_poincare;
mod lie_poisson;

pub use euler_poincare::{DiscreteEulerPoincare, reconstruct};
pub use lie_poisson::DiscreteLiePoisson;
