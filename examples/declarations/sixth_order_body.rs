//! The free rigid body to the sixth order.

use liestep::{Inertia, SO3, lagrangian};

/// The free rigid body to the sixth order: the action of a path that is bent by the acceleration `a = J⁻¹(Jξ × ξ)` and its
/// rate `b = J⁻¹(Ja × ξ + Jξ × a + J(a × ξ))`, in units of the step,
/// `K = (ξ·Jξ/2 − a·Ja/24 + ((a × ξ)·J(a × ξ) + Jξ·(a × (a × ξ)))/240 − b·Jb/1440)/h`.
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
#[derive(Clone, Debug)]
pub struct SixthOrderBody {
    /// Inertia about the centre of mass, kg m².
    pub J: Inertia,
}
