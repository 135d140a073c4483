//! Whether the kinetic flow has the rotors of the Lagrangian whose kinetic part it replaces.

use nalgebra::SimdBool as _;

use super::kinetic_flow::KineticFlow;
use crate::groups::{Advected as _, CayleyRetraction, Retraction as _, SO3};
use crate::mechanics::DiscreteLagrangian;
use crate::numbers::{Real, real};

/// Compares `s` in `p = JΩ + s` at two attitudes, as a declared one may depend on what is advected.
pub(super) fn is_shared<T, L, K>(lagrangian: &L, kinetic: &K) -> bool
where
    T: Real,
    L: DiscreteLagrangian<Scalar = T, Group = SO3<T>>,
    K: KineticFlow<T>,
{
    let of_flow = K::momentum_bias(kinetic);
    [[0.7, -0.4, 1.1], [-0.3, 0.9, 0.5]].iter().all(|xi| {
        let attitude = CayleyRetraction::retract(&nalgebra::Vector3::from(*xi).map(real::<T>));
        let declared = lagrangian.momentum_bias(&lagrangian.advected().seen_from(&attitude));
        let allowed = (declared.norm_squared() + of_flow.norm_squared()) * real(1e-24);
        (declared - of_flow).norm_squared().simd_le(allowed).all()
    })
}
