//! The free rigid body.

use liestep::{NonstandardInertia, SO3, lagrangian};

/// The free rigid body: the kinetic term of (3.13) alone, the discrete body of Moser and Veselov.
#[lagrangian(group = SO3, l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
#[derive(Clone, Debug)]
pub struct FreeBody {
    /// Nonstandard inertia about the fixed point, kg m².
    pub J_d: NonstandardInertia,
}

impl FreeBody {
    /// The body with these principal moments of the ordinary inertia.
    pub fn with_moments(moments: [f64; 3]) -> Self {
        Self { J_d: NonstandardInertia::from_principal_moments(moments.into()).unwrap() }
    }
}
