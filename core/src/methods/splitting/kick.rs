//! The kicks of a declared Lagrangian's potential, and the checks that the Lagrangian is separable and that its kinetic
//! part agrees with the kinetic flow.

use nalgebra::{Matrix3, SimdBool as _, Vector3};

use super::kinetic_flow::KineticFlow;
use crate::error::SetupError;
use crate::groups::{Advected as _, CayleyRetraction, LieGroup as _, Retraction as _, SO3};
use crate::mechanics::{DiscreteLagrangian, Term};
use crate::numbers::{Coordinates, Real, real, reported};

/// The constants for which [`kick_before`](crate::mechanics::Effect::kick_before) is the torque `τ(w)` itself: those of a step of two
/// seconds, as a half kick is `(h/2) τ`.
///
/// # Errors
///
/// [`SetupError::NotSeparable`] if the Lagrangian isn't `K(F) − (h/2) (V(w) + V(F⁻¹·w))`.
pub(crate) fn torque<T, L>(lagrangian: &L) -> Result<L::Constants, SetupError>
where
    T: Real,
    L: DiscreteLagrangian<Scalar = T, Group = SO3<T>>,
{
    let constants = lagrangian.constants(real(2.0));
    let half = lagrangian.constants(real(1.0));
    let kick = |w: &L::Advected| -> Vector3<T> { L::kick_before(&constants, w) };
    let mut defect = T::zero();
    let [some, other] = [Vector3::new(0.7, -0.4, 1.1), Vector3::new(-0.3, 0.9, 0.5)]
        .map(|xi| lagrangian.advected().seen_from(&CayleyRetraction::retract(&xi.map(real::<T>))));
    for xi in [Vector3::new(0.2, -0.1, 0.3), Vector3::new(-0.5, 0.4, 0.1)] {
        let element: SO3<T> = CayleyRetraction::retract(&xi.map(real::<T>));
        let (f, increment) = (element.matrix(), element.increment());
        // Without the half kicks, the momenta are those of the kinetic part, which doesn't depend on `w`.
        let parts = |w: &L::Advected| -> [Vector3<T>; 3] {
            let next = w.advect(&increment);
            let h = real(1.0);
            let before = lagrangian.legendre_minus(&f, w, h) + kick(w) * real::<T>(0.5);
            let after = lagrangian.legendre_plus(&f, w, h) - kick(&next) * real::<T>(0.5);
            [before, after, L::kick_before(&half, w) - kick(w) * real::<T>(0.5)]
        };
        let (of_some, of_other) = (parts(&some), parts(&other));
        let size = of_some[0].norm_squared() + kick(&some).norm_squared() + kick(&other).norm_squared();
        for (a, b) in of_some.into_iter().zip(of_other) {
            defect = defect.simd_max((a - b).norm_squared() / size);
        }
    }
    let defect = defect.simd_sqrt();
    if defect.simd_le(T::simd_default_epsilon() * real(1e4)).all() && Coordinates::is_finite(&kick(&some)) {
        Ok(constants)
    } else {
        Err(SetupError::NotSeparable { defect: reported(defect) })
    }
}

/// The torque of the potential's commutator with the kinetic energy, `U = −½ τ·J⁻¹τ`; a multiple of `J⁻¹` gives the
/// same multiple of it. `None` if the derivative of the torque isn't known.
///
/// Let the velocity `v = J⁻¹τ` be constant, and `η` a turn of the body. Then
///
/// ```text
/// −dU·η = v·∂_η τ = η·∂_v τ + τ·(η × v) = η·(∂_v τ + v × τ)
/// ```
///
/// because the second derivatives `η·∂_v τ` of the potential along left-invariant fields commute up to their bracket.
/// The commutator itself is that of \[Ch97\]. Body frame; kg m²/s⁴, so that `h³` times it is a momentum.
///
/// If `DIAGONAL`, only the diagonal of the inverse inertia is used.
#[hot]
pub(super) fn force_gradient<L, const DIAGONAL: bool>(
    torque: &L::Constants,
    inverse_inertia: &Matrix3<L::Scalar>,
    w: &L::Advected,
) -> Option<Vector3<L::Scalar>>
where
    L: DiscreteLagrangian<Group = SO3<<L as Term>::Scalar>>,
{
    let tau: Vector3<L::Scalar> = L::kick_before(torque, w);
    let m = inverse_inertia;
    let velocity = if DIAGONAL { Vector3::new(m.m11 * tau.x, m.m22 * tau.y, m.m33 * tau.z) } else { m * tau };
    let change = L::kick_derivative(torque, w, &velocity)?;
    // A multiple of the torque in `v` has no effect. With this multiple, the third component is exactly zero for a body
    // that is symmetric about its third axis.
    let across = velocity - tau * m.m11;
    Some(change + across.cross(&tau))
}

/// Whether the derivative of the torque is known.
pub(crate) fn has_force_gradient<T, L>(lagrangian: &L) -> bool
where
    T: Real,
    L: DiscreteLagrangian<Scalar = T, Group = SO3<T>>,
{
    L::kick_derivative(&lagrangian.constants(T::one()), &lagrangian.advected(), &Vector3::zeros()).is_some()
}

/// Whether the flow has the same momentum bias `s` as the Lagrangian, in `p = JΩ + s`, due to rotors. A declared bias
/// may depend on advected parameters, so two attitudes are compared.
pub(super) fn has_bias_of_flow<T, L, K>(lagrangian: &L, kinetic: &K) -> bool
where
    T: Real,
    L: DiscreteLagrangian<Scalar = T, Group = SO3<T>>,
    K: KineticFlow<T>,
{
    let of_flow = K::momentum_bias(kinetic);
    [[0.7, -0.4, 1.1], [-0.3, 0.9, 0.5]].iter().all(|xi| {
        let attitude = CayleyRetraction::retract(&Vector3::from(*xi).map(real::<T>));
        let declared = lagrangian.limit(None, &lagrangian.advected().seen_from(&attitude)).momentum;
        let allowed = (declared.norm_squared() + of_flow.norm_squared()) * real(1e-24);
        (declared - of_flow).norm_squared().simd_le(allowed).all()
    })
}
