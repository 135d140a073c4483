//! Structure-preserving integrators from declared reduced discrete Lagrangians.
//!
//! Annotate a struct with its reduced discrete Lagrangian `l_d(F, w)`, and [`lagrangian`] derives, when the crate is
//! compiled, the momentum maps, the diamond term, the momentum equation and its Newton Jacobian; [`Stepper`] turns
//! them into an integrator. [`conventions`] fixes what left, right and a momentum's components mean.
//!
//! The macro half runs when the user's crate is compiled; this half runs when the user's program runs. It works
//! without the macro too: [`DiscreteLagrangian`] can be implemented by hand. Modules depend on each other in one
//! direction: `{machine, scalar} ← entries ← coordinates ← groups ← {retraction, advected} ← effect ← {lagrangian, sum}
//! ← newton ← flows ← stepper`, and on it `{composition, preprocessed ← splitting ← {accuracy, gauss}}`.

// Expansions name this crate by its path from outside; our own documentation and tests do too.
extern crate self as liestep;

mod error;

pub mod accuracy;
pub mod conventions;
pub mod effects;
pub mod groups;
pub mod laws;
pub mod mechanics;
pub mod methods;
pub mod motion;
pub mod numbers;
mod solving;
pub mod with;

#[doc(hidden)]
#[path = "private.rs"]
pub mod __private;

pub use accuracy::{Accuracy, AccuracyError, AccurateStepper, Candidates, Choice, Offer};
pub use effects::{Gravity, RigidBody};
pub use error::{SetupError, StepError};
pub use groups::{Advected, ContravariantTensor, ContravariantVector, CovariantTensor, MixedTensor};
pub use groups::{CayleyRetraction, ExponentialRetraction, Retraction};
pub use groups::{Generators, LieGroup, MatrixGroup, NotARotation, NotInGroup};
pub use groups::{Heisenberg, R1, R2, R3, SE2, SE3, SL2, SO2, SO3, SU2};
pub use liestep_macros::{force, lagrangian};
pub use mechanics::{AxiallyInvariant, LeftInvariant, OneVector};
pub use mechanics::{DiagonalNonstandardInertia, Inertia, InertiaError, NonstandardInertia};
pub use mechanics::{DiscreteLagrangian, Force, Operations, SceneVisitor, SharedBy, Sum};
pub use mechanics::{Effect, Group, Matrix, Parts, Scalar, Square, Vector};
pub use mechanics::{KineticPart, Moves, Regular, WithKinetic, WithoutKinetic};
pub use methods::{CompositionScheme, Gauss, PreprocessedOrder};
pub use methods::{Flow, KineticFlow, PreprocessedFlow, SplitBody, SplittingScheme, SymmetricBody, Turn};
pub use motion::Remedy;
pub use motion::{DiscreteEulerPoincare, DiscreteLiePoisson, Increment, reconstruct};
pub use motion::{Solvability, State, StepReport, Stepper};
pub use numbers::{Coordinates, Entries, Mask, Real};
pub use solving::TurningLimits;
#[cfg(feature = "serde")]
pub use with::{Checkpoint, CheckpointError, Stored};

#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
struct Readme;
