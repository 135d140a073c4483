//! The full two-body problem.

use liestep::groups::R3;
use liestep::mechanics::Inertia;
use liestep::{NonstandardInertia, SO3, lagrangian};
use nalgebra::{Matrix3, Vector3};

/// Two rigid bodies that attract each other, as two asteroids do: the full two-body problem. Their potential is that of
/// two points, with the second-order correction for their shapes.
#[lagrangian(
    group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
    advected(R = F_1.seen_from(space), Q = F_2.seen_from(F_1), r = d_2.seen_from(d_1)),
    l_d = {
        // The vector from the first body to the second, in the first body's frame.
        let U = |Q: Matrix3<T>, y: Vector3<T>| {
            let s = y.norm_squared();
            let moments = m_2 * J_1.trace() + m_1 * J_2.trace();
            let along = m_2 * y.dot(&(J_1 * y)) + m_1 * y.dot(&(Q * (J_2 * (Q.transpose() * y))));
            -G * (m_1 * m_2 + 0.5 * moments / s - 1.5 * along / s.powi(2)) / s.sqrt()
        };
        let y = R.transpose() * r;
        let y_next = F_1.transpose() * (R.transpose() * (r + d_2 - d_1));
        ((F_1 - I) * K_1 * (F_1 - I).transpose()).trace() / (2.0 * h) + m_1 * d_1.norm_squared() / (2.0 * h)
            + ((F_2 - I) * K_2 * (F_2 - I).transpose()).trace() / (2.0 * h) + m_2 * d_2.norm_squared() / (2.0 * h)
            - 0.5 * h * (U(Q, y) + U(F_1.transpose() * Q * F_2, y_next))
    },
)]
#[derive(Clone, Debug)]
pub struct TwoBodies<T = f64> {
    /// Mass of the first body, kg.
    pub m_1: T,
    /// Mass of the second body, kg.
    pub m_2: T,
    /// Nonstandard inertia of the first body about its centre of mass, kg m².
    pub K_1: NonstandardInertia<T>,
    /// Nonstandard inertia of the second body about its centre of mass, kg m².
    pub K_2: NonstandardInertia<T>,
    /// The inertia of the first body, kg m².
    pub J_1: Inertia<T>,
    /// The inertia of the second body, kg m².
    pub J_2: Inertia<T>,
    /// Gravitational constant, m³/(kg s²).
    pub G: T,
}
