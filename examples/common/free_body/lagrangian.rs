//! The declaration that the integrator is made from.

use liestep::{DiagonalNonstandardInertia, SO3, lagrangian};

/// A free rigid body: the kinetic part of the reduced discrete Lagrangian \[RDAE, (3.13)\].
#[lagrangian(
    group = SO3,
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h),
)]
#[allow(non_snake_case)] // the paper's name
#[derive(Clone, Debug)]
pub(crate) struct FreeBody {
    /// Nonstandard inertia about the centre of mass, kg m².
    pub(crate) J_d: DiagonalNonstandardInertia,
}
