//! Mechanics: the terms of a scene, declared by the macro or written by hand.
//!
//! An [`Effect`] is one term with everything that a step needs; a [`DiscreteLagrangian`] is an effect with `l_d(F, w)`
//! itself, a [`Force`] one with virtual work, a [`Nonholonomic`] one a constraint on velocities. A [`Sum`] of two effects is an effect, and so is a [`Placement`] of terms
//! on bodies of a system. A [`ContinuousLagrangian`] is `l(ξ, w)` with the continuous equations. No equation is solved
//! here except that of the inverse Legendre transform.

mod continuous;
mod derivation;
mod description;
mod direction;
mod effect;
mod facts;
mod force;
mod inertia;
mod kinetic_part;
mod lagrangian;
mod noether;
mod nonholonomic;
mod operations;
mod second_derivatives;
mod sum;
mod symmetry;
mod systems;
mod term;
mod velocity;

pub use continuous::{ContinuousLagrangian, Legendre};
pub use derivation::derivation;
pub use description::SceneVisitor;
pub use effect::{Effect, Group, Limit, Matrix, Moves, NewtonUpdate, Regular, Scalar, Square, Vector};
pub(crate) use effect::{pattern, update_of};
pub use facts::{Facts, Parts};
pub use force::Force;
pub use inertia::{DiagonalNonstandardInertia, Inertia, InertiaError, NonstandardInertia};
#[doc(hidden)]
pub use kinetic_part::KineticPart;
pub use kinetic_part::{WithKinetic, WithoutKinetic};
pub use lagrangian::{DiscreteLagrangian, RigidScene, Scene};
pub(crate) use noether::{left_symmetries, right_symmetries};
pub use nonholonomic::{Nonholonomic, NonholonomicCheck};
pub(crate) use nonholonomic::{check_constraints, normals};
pub use operations::Operations;
pub(crate) use second_derivatives::PointOf;
pub use second_derivatives::{SecondDerivatives, StepDerivatives, StepPoint};
pub use sum::{SharedBy, Sum};
pub use symmetry::{LeftInvariant, OneVector};
pub use systems::{
    Along, At, Between, Coupling, Each, Neighbours, On, Pairs, Placement, Places, SeenBetween, WhereAllAre,
};
pub use term::Term;
pub use velocity::{FactoredInertia, inertia};
pub(crate) use velocity::{
    check_inertia, check_velocity, constant_inertia, energy, estimated_velocity, factored_inertia,
    momentum_of_velocity, velocity_and_energy, velocity_of_momentum,
};
