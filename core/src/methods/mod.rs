//! Methods: plans of higher order, composed of a scene's own step, of its kinetic flow and kicks, or from its
//! continuous limit.
//!
//! | method | order | requires | preserves exactly |
//! |---|---|---|---|
//! | [`OwnStep`](crate::motion::OwnStep), by [`Stepper::new`](crate::Stepper::new) | the declaration's, mostly 2 | a kinetic part | Poisson structure, momentum maps |
//! | [`Composition`], by [`Stepper::composed`](crate::Stepper::composed) | 4 to 10 | a self-adjoint Lagrangian | as above |
//! | [`Splitting`], by [`Stepper::split`](crate::Stepper::split) | 2 to 10 | SO(3), a separate potential | as above; no equation is solved with a closed [`KineticFlow`] |
//! | [`ProcessedSplitting`], by [`Stepper::processed`](crate::Stepper::processed) | 4, 6 | as above, and derivatives of kicks | as above |
//! | [`Gauss`], by [`Stepper::collocated`](crate::Stepper::collocated) | `4 PAIRS` | SO(3), a separate potential, `f64` | as above |
//! | [`CotangentGauss`], a map of its own | `4 PAIRS` | any `l(ξ, w)` on a single group, `f64` | as above |
//! | [`LinkedBodies`], by [`Stepper::linked`](crate::Stepper::linked) | 2 | links on ball joints, potentials, `f64` | Poisson structure, momentum maps |
//! | [`MultibodyStepper`], by [`Multibody::stepper`] | the declaration's, mostly 2 | bodies `(SO3, R3)` and joints, `f64` | Poisson structure, momentum maps |

#[macro_use]
mod schemes;

mod chain;
mod composition;
mod gauss;
mod multibody;
mod splitting;
#[cfg(test)]
mod tests;

pub use chain::{Chain, ChainStepper, Link, LinkedBodies, Weights};
pub use composition::{Composition, CompositionScheme};
#[doc(hidden)]
pub use gauss::{CollocationMemory, CotangentCarry};
pub use gauss::{CotangentGauss, Gauss};
pub use multibody::{BodyPart, Constraint, Joint, Multibody, MultibodyStepper, Place, Redundancy, Slope};
pub(crate) use splitting::has_force_gradient;
pub use splitting::{
    DifferentiableFlow, ExactBody, Flow, Inside, KineticFlow, ProcessedScheme, ProcessedSplitting, Splitting,
    SplittingScheme, SymmetricBody, Turn,
};
