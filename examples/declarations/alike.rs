//! What two bodies of many have, that is put at pairs of them.

use liestep::{SO3, lagrangian};

/// Two bodies that would like to stand alike: a potential at both ends of a step.
#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(Q = F_2.seen_from(F_1)),
    l_d = 0.5 * h * kappa * (Q.trace() + (F_1.transpose() * Q * F_2).trace()),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Alike<T = f64> {
    /// How much they would, J.
    pub kappa: T,
}
