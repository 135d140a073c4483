//! Kinetic terms of higher order.

use crate::groups::SO3;
use crate::mechanics::Inertia;
use liestep_macros::lagrangian;

/// A rigid body with a kinetic term of the fourth order: the geodesic one, corrected for the path that the acceleration
/// `a = J⁻¹(Jξ × ξ)` bends, `K = (ξ·Jξ/2 − a·Ja/24)/h`.
///
/// The order is that of a free body. Potentials are added at the ends of a step, which is of second order; a scene with
/// one has the fourth order only as a composition or a splitting.
#[lagrangian(
    group = SO3,
    l_d = {
        let xi = log(F);
        let a = inverse(J) * (J * xi).cross(&xi);
        (xi.dot(&(J * xi)) / 2.0 - a.dot(&(J * a)) / 24.0) / h
    },
)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FourthOrderBody<T = f64> {
    /// Inertia about the fixed point or the centre of mass, kg m².
    pub J: Inertia<T>,
}

/// A rigid body with a kinetic term of the sixth order: the action of a path that is bent by the acceleration
/// `a = J⁻¹(Jξ × ξ)` and its rate `b = J⁻¹(Ja × ξ + Jξ × a + J(a × ξ))`, in units of the step,
/// `K = (ξ·Jξ/2 − a·Ja/24 + ((a × ξ)·J(a × ξ) + Jξ·(a × (a × ξ)))/240 − b·Jb/1440)/h`.
///
/// The order is that of a free body; with potentials it is as for [`FourthOrderBody`].
#[lagrangian(
    group = SO3,
    l_d = {
        let xi = log(F);
        let momentum = J * xi;
        let a = inverse(J) * momentum.cross(&xi);
        let c = a.cross(&xi);
        let b = inverse(J) * ((J * a).cross(&xi) + momentum.cross(&a) + J * c);
        (xi.dot(&momentum) / 2.0 - a.dot(&(J * a)) / 24.0
            + (c.dot(&(J * c)) + momentum.dot(&a.cross(&c))) / 240.0
            - b.dot(&(J * b)) / 1440.0) / h
    },
)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SixthOrderBody<T = f64> {
    /// Inertia about the fixed point or the centre of mass, kg m².
    pub J: Inertia<T>,
}
