//! Viscous drag.

use nalgebra::Vector3;

use crate::groups::SO3;
use crate::mechanics::Inertia;
use liestep_macros::force;

/// Viscous drag, the torque `−c Ω` against the body velocity. A step takes `((F − Fᵀ)/2)^∨/h` for `Ω`.
///
/// At any `c h` no spin changes its sign, and the energy of a free body with the kinetic term of (3.13) never rises in
/// a step; with another kinetic term it may, as that term's own energy oscillates. The scheme is of second order.
///
/// Under a constant torque `τ` about a principal axis the body ends up turning by `θ` a step with `sin θ = hτ/c`, at
/// the rate `τ/c` where that is small. The momentum of the state is the one at a node, with half an impulse in it. The
/// velocity computed from it is `(τ/c)(1 + ½ x y³/(1 + y²)^{3/2})` with the `x` and `y` below: for a body with three equal
/// moments 1.3 times `τ/c` at `x = 1`, 6 times at `x = 10`, 51 times at `x = 100`. If `c h` isn't small against `J`,
/// compute the velocity from two attitudes, as `θ/h`.
///
/// The torque of a step is shared between its ends: halves where `c h` is small against the moments of inertia, all of
/// it at the beginning where it is large. About a principal axis a step divides the momentum by `1 + x/(1 − b)`, with
/// `x = c h/J_i` and `b < ⅔` for the share of the end (`y ≥ x/2` below); halves at any strength, `b = x/2`, would
/// reverse a spin once `x > 2`. The difference of the shares is odd in `h`, so that a step of `−h` undoes one of `h`, and
/// [compositions](crate::Stepper::composed) have their order.
#[force(
    group = SO3,
    gradients,
    work = {
        let y = 0.5 * c * h * inverse(J).trace();
        let uneven = y / (1.0 + y * y).sqrt();
        let end = 0.5 * c * (1.0 - uneven * uneven * uneven);
        -vee(F).dot(&(eta * (c - end) + eta_next * end))
    },
)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drag<T = f64> {
    /// Coefficient, N m s.
    pub c: T,
    /// Inertia of the scene, kg m². No moment may be larger than the body's, or a spin may be reversed after all.
    pub J: Inertia<T>,
}

/// Viscous drag `−c (Ω − w)` in air, or another fluid, that turns at the rate `w`: [`Drag`] by the relative velocity.
///
/// Torques are shared between the ends of a step as in [`Drag`]; at the end the air's velocity in the body frame is
/// `F⁻¹ w`. [`Stepper::driven`](crate::Stepper::driven) prescribes it step by step, for air that turns with an orbit.
#[force(
    group = SO3,
    gradients,
    advected(w = air),
    work = {
        let y = 0.5 * c * h * inverse(J).trace();
        let uneven = y / (1.0 + y * y).sqrt();
        let end = 0.5 * c * (1.0 - uneven * uneven * uneven);
        let turn = vee(F);
        (w * h - turn).dot(&eta) * (c - end) + (F.transpose() * w * h - turn).dot(&eta_next) * end
    },
)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AirDrag<T = f64> {
    /// Coefficient, N m s.
    pub c: T,
    /// Angular velocity of the air, in space, rad/s.
    pub air: Vector3<T>,
    /// Inertia of the scene, kg m²; as in [`Drag`].
    pub J: Inertia<T>,
}
