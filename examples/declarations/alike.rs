//! A potential on two bodies of many, which is placed at pairs of them.

use liestep::{SO3, lagrangian};

/// An alignment potential of two bodies, evaluated at both ends of a step.
#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(Q = F_2.seen_from(F_1)),
    l_d = 0.5 * h * kappa * (Q.trace() + (F_1.transpose() * Q * F_2).trace()),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Alike<T = f64> {
    /// The strength of the alignment, J.
    pub kappa: T,
}
