//! Two links on ball joints.

use liestep::{NonstandardInertia, SO3, lagrangian};
use nalgebra::{Matrix3, Vector3};

/// A double pendulum of two rigid links: a ball joint at a fixed pivot, and one between them. The mass of the lower
/// link at its joint is included in `J_1` and `s_1`; `s_2` is the first moment of the lower link.
#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(w_1 = up.seen_from(F_1), w_2 = up.seen_from(F_2), Q = F_2.seen_from(F_1)),
    l_d = ((F_1 - I) * J_1 * (F_1 - I).transpose()).trace() / (2.0 * h)
        + ((F_2 - I) * J_2 * (F_2 - I).transpose()).trace() / (2.0 * h)
        + ((F_1 - I) * rho).dot(&(Q * ((F_2 - I) * s_2))) / h
        - 0.5 * h * g * (w_1.dot(&(s_1 + F_1 * s_1)) + w_2.dot(&(s_2 + F_2 * s_2))),
)]
#[derive(Clone, Debug)]
pub struct DoublePendulum<T = f64> {
    /// Nonstandard inertia of the upper link about the pivot, with the mass of the lower link at their joint, kg m².
    pub J_1: NonstandardInertia<T>,
    /// Nonstandard inertia of the lower link about their joint, kg m².
    pub J_2: NonstandardInertia<T>,
    /// The joint from the pivot, in the upper link, m.
    pub rho: Vector3<T>,
    /// First moment of the upper link about the pivot, with the mass of the lower link at their joint, kg m.
    pub s_1: Vector3<T>,
    /// First moment of the lower link about their joint, kg m.
    pub s_2: Vector3<T>,
    /// Gravitational acceleration, m/s².
    pub g: T,
    /// The vertical, in space.
    pub up: Vector3<T>,
}

impl DoublePendulum {
    /// A double pendulum without any symmetry.
    pub fn asymmetric() -> Self {
        let inertia = |x: f64, y: f64, z: f64| Matrix3::new(x, 0.02, -0.03, 0.02, y, 0.01, -0.03, 0.01, z);
        let (rho, c_1, c_2, m_2) =
            (Vector3::new(0.1, 0.2, -1.0), Vector3::new(0.1, 0.05, -0.5), Vector3::new(0.05, -0.1, -0.4), 0.7);
        let J_1 = NonstandardInertia::new(inertia(0.3, 0.2, 0.4) + rho * rho.transpose() * m_2).unwrap();
        let J_2 = NonstandardInertia::new(inertia(0.1, 0.15, 0.05) + c_2 * c_2.transpose() * m_2).unwrap();
        Self { J_1, J_2, rho, s_1: c_1 + rho * m_2, s_2: c_2 * m_2, g: 9.81, up: Vector3::z() }
    }

    /// Two point masses at the ends of thin rods, the reference in `tests/data`. The moment `spinning` of a rod about
    /// its own axis, kg m², is arbitrary, as there is no torque about that axis.
    pub fn spherical(spinning: f64) -> Self {
        let ([m_1, m_2], [l_1, l_2], e) = ([1.0, 0.7], [1.0, 0.9], Vector3::z());
        let rod = |moment: f64| {
            let across = 0.5 * spinning;
            NonstandardInertia::from_diagonal(Vector3::new(across, across, moment - across)).unwrap()
        };
        Self {
            J_1: rod((m_1 + m_2) * l_1 * l_1),
            J_2: rod(m_2 * l_2 * l_2),
            rho: e * l_1,
            s_1: e * ((m_1 + m_2) * l_1),
            s_2: e * (m_2 * l_2),
            g: 9.81,
            up: e,
        }
    }
}
