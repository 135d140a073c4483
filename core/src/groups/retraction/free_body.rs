//! The Jacobian of a free body in Cayley coordinates, an approximation of that of any kinetic part.

use nalgebra::{Matrix3, Vector3};

use crate::groups::rotation_functions::inverse;
use crate::numbers::{Real, real};

/// The Jacobian `h ∂p/∂y` of the momentum `p` that turns a free body with the inertia `J` by `cay(y)` within `h`.
///
/// The exact discrete Lagrangian of the free body is, in the logarithm `x`,
///
/// ```text
/// h K(x) = ½ x·Jx − u·J⁻¹u/24 + O(x⁶)    with u = Jx × x
/// ```
///
/// and its right momentum `h p = g + ½ x × g + (1/12) x × (x × g)` with `g = ∂(hK)/∂x`, up to `O(x⁵)`. With
/// `x = y (1 − |y|²/12 + |y|⁴/80)` the result is right to the relative order of `|y|⁴`.
#[hot]
pub(super) fn momentum_tangent<T: Real>(inertia: &Matrix3<T>, y: &Vector3<T>) -> Matrix3<T> {
    let twelfth = real::<T>(1.0 / 12.0);
    let n = y.dot(y);
    let x = y * (T::one() - n * (twelfth - n * real(1.0 / 80.0)));
    let unbent = inertia * x;
    let inverse = inverse(*inertia);
    let b = inverse * unbent.cross(&x);
    let g = unbent - (inertia * x.cross(&b) + b.cross(&unbent)) * twelfth;
    // The derivative ∂u/∂x, and from it the symmetric ∂g/∂x.
    let bend = unbent.cross_matrix() - x.cross_matrix() * inertia;
    let twist = b.cross_matrix() * inertia;
    let hessian = inertia - (bend.transpose() * (inverse * bend) + twist + twist.transpose()) * twelfth;
    // The derivative along x alone; g adds ∂(x × g)/∂x = −ĝ and ∂(x × (x × g))/∂x = x·g I + x gᵀ − 2 g xᵀ.
    let through = |m: &Matrix3<T>| {
        let turned = x.cross_matrix() * m;
        m + turned * real::<T>(0.5) + x.cross_matrix() * turned * twelfth
    };
    let outer = (x * g.transpose() - g * x.transpose() * real::<T>(2.0)).map(|entry| entry * twelfth);
    let along = through(&hessian) - g.cross_matrix() * real::<T>(0.5)
        + outer
        + Matrix3::from_diagonal_element(x.dot(&g) * twelfth);
    // The derivative ∂x/∂y = φ I + 2φ' y yᵀ.
    let scale = T::one() - n * (twelfth - n * real(1.0 / 80.0));
    let slope = n * real(1.0 / 20.0) - real(1.0 / 6.0);
    along * scale + (along * y * slope) * y.transpose()
}
