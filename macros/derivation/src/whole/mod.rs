//! The whole step of a declaration as straight-line programs on numbers, for any group.
//!
//! The programs of `staged` are the parts of a step that a Lagrangian decides. Here they become a step: increments, inverses,
//! tangents and the coadjoint action are written out from the generators alone, as are the actions on advected parameters and
//! the elimination of the Newton system, with all zeros and ones left out. What runs them compares numbers and copies
//! them, and knows no group.
//!
//! Operations have the order of the library's own groups and solves, so that a step has the bits of the compiled one. From
//! five rows on, pivots of an inverse are taken on the diagonal, as the library's are in steps of up to half a radian; in longer ones
//! roundings differ.
//!
//! Deliberately not here: any decision of a run, such as how often to iterate.
//!
//! The files depend on each other in one direction: `hamiltonian → step`, `{step → {limit, certified, reverse}, collocation, directions}
//! → tangent → constraints → writer →
//! {actions, solved} → factor → {relations, rigid} → {basis, matrix → values}`.

mod actions;
mod basis;
mod certified;
mod collocation;
mod constraints;
mod directions;
mod factor;
mod hamiltonian;
mod limit;
mod matrix;
mod relations;
mod reverse;
mod rigid;
mod solved;
mod step;
mod tangent;
mod values;
mod writer;

use std::fmt;

pub use crate::mathematics::chart::Chart;
pub use basis::{Basis, Form};
pub use collocation::Canonical;
pub use constraints::constrained;
pub use directions::in_directions;
pub use factor::MatrixFactor;
pub use hamiltonian::HamiltonianStep;
pub use reverse::pulled_back;
pub use step::{Programs, Sizes, WholeStep};
pub use values::{Value, Words};

/// The limit on the operations of a step: a tenth more than those on the rotations of nine dimensions, with 36 unknowns.
pub const MOST_OPERATIONS: usize = 120_000;

/// The reason why a declaration has no step as programs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StepRefusal {
    /// A generator of the group is a combination of others.
    Dependent,
    /// The Cayley map leaves the group, and so does that of multiples of this generator, whose cube isn't a multiple of it.
    Cube {
        /// Index of the generator, from zero.
        generator: usize,
    },
    /// The group isn't one of linear and quadratic relations, which collocation keeps.
    NotQuadratic,
    /// There is no kinetic part, so that no velocity has a momentum.
    NoKinetic,
    /// A Hamiltonian has steps of its own.
    Hamiltonian,
    /// Constraints on velocities, as many as the group has dimensions or more, leave no motion.
    Fixed {
        /// The number of constraints.
        constraints: usize,
        /// The dimension of the group.
        dimension: usize,
    },
    /// Constraints on velocities need a Lagrangian that is quadratic in the velocity.
    NotQuadraticVelocity,
    /// The programs of the step don't make one, which is a fault of this library.
    Wrong {
        /// The claim that isn't met.
        claim: &'static str,
    },
    /// The step has more operations than the limit.
    TooLong {
        /// The limit on operations.
        most: usize,
    },
}

impl fmt::Display for StepRefusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Dependent => write!(f, "the generators of the group depend on each other: leave one out"),
            Self::Cube { generator } => write!(
                f,
                "the Cayley map leaves the group, and the cube of generator {} isn't a multiple of it: choose generators \
                 `E` with `E³ = c E`",
                generator + 1
            ),
            Self::NotQuadratic => write!(
                f,
                "collocation leaves this group, which isn't one of linear and quadratic relations: take a composition"
            ),
            Self::NoKinetic => write!(f, "there is no kinetic part, so no step: add a Lagrangian of the velocity"),
            Self::Hamiltonian => {
                write!(f, "a Hamiltonian has its step or a composition of it, with equal steps and no term beside it")
            }
            Self::Fixed { constraints, dimension } => write!(
                f,
                "{constraints} constraints on velocities leave no motion on a group of dimension {dimension}: leave some out"
            ),
            Self::NotQuadraticVelocity => write!(
                f,
                "constraints on velocities need a Lagrangian that is quadratic in the velocity: leave them out, or write \
                 the kinetic energy as a square"
            ),
            Self::Wrong { claim } => write!(f, "{claim} in the step as it is written: please report this declaration"),
            Self::TooLong { most } => {
                write!(f, "a step has more than {most} operations: declare a smaller group or a shorter Lagrangian")
            }
        }
    }
}

impl std::error::Error for StepRefusal {}
