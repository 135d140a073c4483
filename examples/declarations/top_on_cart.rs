//! A top on a cart.

use liestep::groups::R2;
use liestep::{NonstandardInertia, SO3, lagrangian};
use nalgebra::Vector3;

/// A top whose pivot is a cart that slides without friction in the plane: the cart's displacement is coupled to that of
/// the top's centre of mass relative to the cart.
#[lagrangian(
    group(F = SO3, d = R2),
    advected(R = F.seen_from(space)),
    l_d = {
        let lever = R * ((F - I) * s);
        ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)
            + M * d.norm_squared() / (2.0 * h)
            + (d.x * lever.x + d.y * lever.y) / h
            - 0.5 * h * g * ((R * s).z + (R * (F * s)).z)
    },
)]
#[derive(Clone, Debug)]
pub struct TopOnCart<T = f64> {
    /// Nonstandard inertia of the top about its pivot, in its frame, kg m².
    pub J_d: NonstandardInertia<T>,
    /// First moment of the top about its pivot, its mass times the position of its centre of mass in the top's frame,
    /// kg m.
    pub s: Vector3<T>,
    /// Mass of the cart and the top together, kg.
    pub M: T,
    /// Gravitational acceleration, m/s².
    pub g: T,
}
