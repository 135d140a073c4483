//! The extended poses of inertial navigation.

use nalgebra::{RealField, Rotation3, SMatrix, UnitQuaternion, Vector3};

use super::generators::Generators;
use super::matrix_group::MatrixGroup;
use super::rigid::{self, rigid_group};

/// The group SE₂(3) of extended poses: an attitude, a velocity and a place.
///
/// | object | representation |
/// |---|---|
/// | matrix form | 5 × 5, `[R, v, x; 0, I]` |
/// | tangent space | `(ω, a, u)`: the rates of `R`, of `v` and of `x`, all in the body frame |
/// | basis | `E_1`, `E_2`, `E_3` the `ê_k` of SO(3) in the upper left, `E_4` to `E_6` the unit columns in place of `v`, `E_7` to `E_9` those in place of `x` |
/// | bracket | `[(ω, a, u), (ω', a', u')] = (ω × ω', ω × a' − ω' × a, ω × u' − ω' × u)` |
/// | action | `(p, s, t) ↦ (R p + s v + t x, s, t)` |
/// | relation | `RᵀR = I`, `det R = 1`, the last two rows those of the identity |
/// | units | `R` none, `v` m/s, `x` m |
///
/// # Source
///
/// Barrau and Bonnabel 2017, The invariant extended Kalman filter as a stable observer, section IV.
///
/// # Examples
///
/// ```
/// use liestep::groups::{LieGroup, SE23};
/// use nalgebra::{UnitQuaternion, Vector3};
/// let turn = UnitQuaternion::from_scaled_axis(Vector3::new(0.8, 0.0, 0.0));
/// let pose = SE23::from_parts(turn, Vector3::x(), Vector3::new(1.0, 2.0, 3.0));
/// assert_eq!(pose.place(), Vector3::new(1.0, 2.0, 3.0));
/// assert!(pose.compose(&pose.inverse()).defect() < 1e-15);
/// ```
pub type SE23<T = f64> = MatrixGroup<SE23Generators, T, 5, 9>;

rigid_group! {
    SE23, SE23Generators<3, 5, 9>, UnitQuaternion by Rotation3, Vector3;
    /// The pose with the attitude `R`, the velocity `v` and the place `x`.
    from_parts(
        /// The attitude `R`.
        attitude,
        /// The velocity `v`.
        velocity at 3,
        /// The place `x`.
        place at 4
    )
}
