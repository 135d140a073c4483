//! The names that most programs need: `use liestep::prelude::*;`
//!
//! The traits are imported without their names, so that their methods are found and no name of yours is shadowed.

pub use crate::effects::{Gravity, PrincipalBody, RigidBody};
pub use crate::error::{SetupError, StepError};
pub use crate::groups::{LieGroup as _, R1, R2, R3, SE2, SE3, SO2, SO3};
pub use crate::mechanics::{DiagonalNonstandardInertia, Inertia, NonstandardInertia};
pub use crate::mechanics::{DiscreteLagrangian as _, Effect as _, Term as _};
pub use crate::motion::{Integrator as _, State, StateOf, Stepper};
pub use liestep_macros::{force, lagrangian, nonholonomic};
pub use nalgebra::{Matrix3, UnitQuaternion, Vector3};
