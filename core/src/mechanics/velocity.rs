//! Momenta and their velocities: the Legendre transform of the continuous limit, and the energy.

use crate::error::SetupError;
use crate::groups::{LieGroup, SquareOf, body_of};
use crate::mechanics::effect::{Effect, Group, Limit, Scalar, Square, Vector};
use crate::numbers::{Coordinates, Real, newton_halving, real, reported};
use nalgebra::{SimdBool as _, SimdPartialOrd as _, SimdRealField};

/// The momentum of the body velocity `ξ`: `μ = ∂l/∂ξ`, which is `Jξ + s(w)` if `l` is quadratic.
pub(crate) fn momentum_of_velocity<E: Effect>(effect: &E, velocity: &Vector<E>, w: &E::Advected) -> Vector<E> {
    if effect.facts().is_quadratic {
        let Limit { hessian, momentum, .. } = effect.limit(None, w);
        hessian * *velocity + momentum
    } else {
        effect.limit(Some(velocity), w).momentum
    }
}

/// The body velocity of the momentum `μ`: `ξ = J⁻¹(μ − s(w))` if `l` is quadratic, otherwise the solution of
/// `∂l/∂ξ = μ`. Lanes whose momentum is that of no velocity are NaN.
pub(crate) fn velocity_of_momentum<E: Effect>(effect: &E, momentum: &Vector<E>, w: &E::Advected) -> Vector<E> {
    let near_rest = velocity_near_rest(effect, momentum, w);
    if effect.facts().is_quadratic {
        return near_rest;
    }
    let (of, hessian) =
        (|xi: &Vector<E>| effect.limit(Some(xi), w).momentum, |xi: &Vector<E>| effect.limit(Some(xi), w).hessian);
    let found = newton_halving(momentum, near_rest, of, hessian);
    found.solution.select(found.is_settled & found.is_regular, Vector::<E>::zero() * real(f64::NAN))
}

/// A constant inertia, and its factors, by which the velocities of many momenta are computed.
#[derive(Clone, Copy, Debug)]
pub struct FactoredInertia<G: LieGroup> {
    matrix: <G::Vector as Coordinates<G::Scalar>>::Square,
    factors: <G::Vector as Coordinates<G::Scalar>>::Square,
    det: G::Scalar,
}

/// The factorised inertia, if it is constant.
pub(crate) fn factored_inertia<E: Effect>(effect: &E) -> Option<FactoredInertia<Group<E>>> {
    let matrix = constant_inertia(effect).ok()?;
    let (factors, det) = Vector::<E>::factorise(&matrix);
    Some(FactoredInertia { matrix, factors, det })
}

/// The body velocity of the momentum `μ` and the energy; with a factorised inertia they have the same bits as without.
#[hot]
pub(crate) fn velocity_and_energy<E: Effect>(
    effect: &E,
    inertia: Option<&FactoredInertia<Group<E>>>,
    momentum: &Vector<E>,
    w: &E::Advected,
) -> (Vector<E>, Scalar<E>) {
    if let Some(known) = inertia {
        let velocity =
            Vector::<E>::solve_again(&known.factors, known.det, &(*momentum - effect.limit(None, w).momentum));
        return (velocity, quadratic_energy(effect, &velocity, &known.matrix, w));
    }
    let velocity = velocity_of_momentum(effect, momentum, w);
    (velocity, energy_of_velocity(effect, &velocity, w))
}

/// The velocity by the inertia at rest: exact if `l` is quadratic, otherwise an estimate.
fn velocity_near_rest<E: Effect>(effect: &E, momentum: &Vector<E>, w: &E::Advected) -> Vector<E> {
    let Limit { hessian, momentum: bias, .. } = effect.limit(None, w);
    Vector::<E>::solve(&hessian, &(*momentum - bias)).0
}

/// An estimate of the body velocity of the momentum `μ`, which is finite even if no velocity has this momentum.
pub(crate) fn estimated_velocity<E: Effect>(effect: &E, momentum: &Vector<E>, w: &E::Advected) -> Vector<E> {
    let velocity = velocity_of_momentum(effect, momentum, w);
    if effect.facts().is_quadratic || velocity.is_finite() {
        return velocity;
    }
    // NaN isn't equal to itself, so lanes with NaN are replaced.
    let size = velocity.dot(&velocity);
    velocity.select(size.simd_eq(size), velocity_near_rest(effect, momentum, w))
}

/// Checks that the inverse Legendre transform of the momentum `μ` is the velocity that the user gave, up to rounding.
/// The inertia at rest makes the components of both commensurable.
pub(crate) fn check_velocity<T: Real, V: Coordinates<T>>(
    given: &V,
    found: &V,
    momentum: &V,
    inertia: &V::Square,
) -> Result<(), SetupError> {
    let (image, difference) = (*inertia * *given, *inertia * (*found - *given));
    let epsilon = T::simd_default_epsilon();
    // At a fold of the momentum, half of the digits of a velocity are lost. Cancellation in the momentum adds to that.
    let of_fold = image.dot(&image) * epsilon * real(256.0);
    let of_sum = momentum.dot(momentum) * epsilon * epsilon * real(1e8);
    let missed = difference.dot(&difference);
    if missed.simd_le(of_fold + of_sum).all() {
        return Ok(());
    }
    Err(SetupError::AmbiguousVelocity { difference: reported((missed / image.dot(&image)).simd_sqrt()) })
}

/// The energy `ξ·∂l/∂ξ − l` of the continuous limit: `½ ξ·Jξ + V(w)` if it is quadratic.
pub(crate) fn energy<E: Effect>(effect: &E, momentum: &Vector<E>, w: &E::Advected) -> Scalar<E> {
    energy_of_velocity(effect, &velocity_of_momentum(effect, momentum, w), w)
}

/// The energy at a known velocity.
fn energy_of_velocity<E: Effect>(effect: &E, velocity: &Vector<E>, w: &E::Advected) -> Scalar<E> {
    if !effect.facts().is_quadratic {
        let Limit { l, momentum, .. } = effect.limit(Some(velocity), w);
        return velocity.dot(&momentum) - l;
    }
    quadratic_energy(effect, velocity, &inertia(effect, w), w)
}

#[hot]
fn quadratic_energy<E: Effect>(effect: &E, velocity: &Vector<E>, inertia: &Square<E>, w: &E::Advected) -> Scalar<E> {
    velocity.dot(&(*inertia * *velocity)) * real(0.5) - effect.limit(None, w).l
}

/// The matrix `J(w)` of an effect's [limit](Effect::limit) at rest; for a single body it is the same for all `w`.
pub fn inertia<E: Effect>(effect: &E, w: &E::Advected) -> Square<E> {
    effect.limit(None, w).hessian
}

/// The inertia, if it is the same for all configurations.
pub(crate) fn constant_inertia<E: Effect>(effect: &E) -> Result<Square<E>, SetupError> {
    if effect.facts().has_constant_inertia && effect.facts().is_quadratic {
        Ok(inertia(effect, &effect.advected()))
    } else {
        Err(SetupError::VaryingInertia)
    }
}

/// Checks that a momentum determines a velocity, and that the kinetic energy is positive along every direction.
pub(crate) fn check_inertia<G: LieGroup>(inertia: &SquareOf<G>) -> Result<(), SetupError> {
    let (unit, determinant) = G::Vector::solve(inertia, &G::Vector::zero());
    let (pivot, component) = G::Vector::least_pivot(inertia);
    // A pivot of smaller absolute value may be the rounding error of zero.
    if pivot.simd_lt(real::<G::Scalar>(-1e6) * <G::Scalar as SimdRealField>::simd_default_epsilon()).any() {
        return Err(SetupError::NegativeKinetic { pivot: reported(pivot), body: body_of::<G>(component) });
    }
    let is_positive = pivot.simd_gt(real(0.0));
    if !unit.is_finite() || !(determinant.simd_gt(real(0.0)) & is_positive).all() {
        // If each pivot is positive and only their product is out of range, no single body is the cause.
        let body = if is_positive.all() { None } else { body_of::<G>(component) };
        return Err(SetupError::SingularKinetic { determinant: reported(determinant), body });
    }
    Ok(())
}
