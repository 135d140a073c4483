//! The kinetic energy of a rigid body in Cayley coordinates.

use crate::groups::SO3;
use crate::mechanics::Inertia;
use liestep_macros::lagrangian;

/// A rigid body with the kinetic term `(2/h) x·Jx` in `x = tan(θ/2) n`, of second order, with a solution at every step.
///
/// The momentum is `h p = 2 (Jx + x × Jx + (x·Jx) x)`, which grows beyond all bounds towards half a turn a step. The
/// error is about twice that of [`RigidBody`](super::RigidBody), and the energy of a free body oscillates. A fast step
/// of a needle, a body with one moment far below the others, may still be refused.
#[lagrangian(
    group = SO3,
    gradients,
    l_d = {
        let x = vee(F - F.transpose()) / (1.0 + F.trace());
        2.0 * x.dot(&(J * x)) / h
    },
)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CayleyBody<T = f64> {
    /// Inertia about the fixed point or the centre of mass, kg m².
    pub J: Inertia<T>,
}
