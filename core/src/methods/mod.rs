//! Methods of higher order, made of a scene's own step, of its kinetic flow and kicks, or of its continuous limit.

mod composition;
mod gauss;
mod preprocessed;
mod splitting;

pub use composition::{Composition, CompositionScheme};
pub use gauss::{Gauss, GaussState};
pub use preprocessed::{PreprocessedBody, PreprocessedOrder};
pub(crate) use splitting::has_force_gradient;
pub use splitting::{
    DeclaredDrift, Flow, KineticFlow, PreprocessedDrift, PreprocessedFlow, SplitBody, SplitDrift, Splitting,
    SplittingScheme, SymmetricBody, SymmetricDrift, Turn,
};
