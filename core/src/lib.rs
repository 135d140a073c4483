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

pub mod conventions;
pub mod effects;
pub mod groups;
pub mod laws;

mod accuracy;
mod advected;
mod bisection;
#[cfg(feature = "serde")]
mod checkpoint;
mod compensated;
mod composition;
mod control;
mod coordinates;
mod effect;
mod entries;
mod error;
mod flows;
mod force;
mod functions;
mod gauss;
mod inertia;
mod kinetic;
mod lagrangian;
mod machine;
mod newton;
mod operations;
mod preprocessed;
mod remedy;
mod retraction;
mod scalar;
mod scene;
mod solvability;
mod splitting;
mod state;
mod stepper;
mod sum;
mod symmetry;

#[doc(hidden)]
#[path = "private.rs"]
pub mod __private;

pub use accuracy::{Accuracy, AccuracyError, AccurateStepper, Candidates, Choice, Offer};
pub use advected::{Advected, ContravariantTensor, ContravariantVector, CovariantTensor, MixedTensor};
#[cfg(feature = "serde")]
pub use checkpoint::{Checkpoint, CheckpointError, Stored};
pub use compensated::{CompensatedState, CompensatedStepper};
pub use composition::{Composition, CompositionScheme};
pub use coordinates::Coordinates;
pub use effect::{Effect, Group, Matrix, Parts, Scalar, Square, Vector};
pub use effects::{Gravity, RigidBody};
pub use entries::Entries;
pub use error::{SetupError, StepError};
pub use flows::{DiscreteEulerPoincare, DiscreteLiePoisson, Increment, reconstruct};
pub use force::Force;
pub use gauss::{Gauss, GaussState};
pub use groups::{Generators, LieGroup, MatrixGroup, NotARotation, NotInGroup};
pub use groups::{Heisenberg, R1, R2, R3, SE2, SE3, SL2, SO2, SO3, SU2};
pub use inertia::{DiagonalNonstandardInertia, Inertia, InertiaError, NonstandardInertia};
pub use kinetic::{KineticPart, Moves, Regular, WithKinetic, WithoutKinetic};
pub use lagrangian::DiscreteLagrangian;
pub use liestep_macros::{force, lagrangian};
pub use operations::Operations;
pub use preprocessed::{PreprocessedBody, PreprocessedOrder};
pub use remedy::{Fallback, OnFailure, RemediedStepper, Remedy, Substeps};
pub use retraction::{CayleyRetraction, ExponentialRetraction, Retraction};
pub use scalar::{Mask, Real};
pub use scene::SceneVisitor;
pub use solvability::{Solvability, TurningLimits};
pub use splitting::{
    DeclaredDrift, Flow, KineticFlow, PreprocessedDrift, PreprocessedFlow, SplitBody, SplitDrift, Splitting,
    SplittingScheme, SymmetricBody, SymmetricDrift, Turn,
};
pub use state::State;
pub use stepper::{StepReport, Stepper};
pub use sum::{SharedBy, Sum};
pub use symmetry::{AxiallyInvariant, LeftInvariant, OneVector};

#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
struct Readme;
