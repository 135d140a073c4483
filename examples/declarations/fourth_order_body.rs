//! The free rigid body to the fourth order.

use liestep::{Inertia, SO3, lagrangian};

/// The free rigid body to the fourth order: the geodesic kinetic term less what the acceleration `a = J⁻¹(Jξ × ξ)` bends
/// the path, `K = (ξ·Jξ/2 − a·Ja/24)/h`.
#[lagrangian(
    group = SO3,
    l_d = {
        let xi = log(F);
        let a = inverse(J) * (J * xi).cross(&xi);
        (xi.dot(&(J * xi)) / 2.0 - a.dot(&(J * a)) / 24.0) / h
    },
)]
#[derive(Clone, Debug)]
pub struct FourthOrderBody {
    /// Inertia about the centre of mass, kg m².
    pub J: Inertia,
}
