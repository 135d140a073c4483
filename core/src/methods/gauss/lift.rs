//! The body's unit quaternion and conjugate momentum: canonical equations on `T*ℝ⁴`.

use nalgebra::{Matrix3, Vector3};

use crate::groups::{Advected as _, SO3};
use crate::mechanics::{Effect, RigidScene, velocity_of_momentum};
use crate::methods::splitting::inverse_inertia;

/// The quaternion `q`, scalar part first, and its momentum `p`.
pub(super) type PhasePoint = [f64; 8];

/// The Hamiltonian `H(q, p) = ½ (Π − s)·J⁻¹(Π − s) + V(R(q)ᵀ·a_0)` with `Π = ½ Im(q̄ p)` and the rotation `R` of
/// `q/|q|`.
///
/// `Π` is the momentum map of the right multiplication by unit quaternions, and that multiplication advects
/// `w = R(q)ᵀ·a_0`. So `(q, p) ↦ (Π, w)` is a Poisson map to the dual of the semidirect product. The equations are
///
/// ```text
/// q' = ½ q Ω        p' = ½ p Ω + 2 q τ(w)/|q|²        Ω = J⁻¹(Π − s)
/// ```
///
/// They imply `Π' = Π × Ω + τ` and `|q| = const`.
#[derive(Clone, Debug)]
pub(super) struct Lift<L: Effect> {
    /// The matrix that maps `2 Π` to `½ (Ω + J⁻¹ s)`.
    half_velocity: Matrix3<f64>,
    /// The velocity `½ J⁻¹ s` of the bias.
    half_bias: Vector3<f64>,
    spatial: L::Advected,
    torque: L::Constants,
}

impl<L: RigidScene<Scalar = f64>> Lift<L> {
    /// The canonical equations of a separable Lagrangian, with the constants of its torque.
    pub(super) fn new(lagrangian: &L, torque: L::Constants) -> Self {
        let spatial = lagrangian.advected();
        let inverse = inverse_inertia(lagrangian);
        let half_bias = velocity_of_momentum(lagrangian, &Vector3::zeros(), &spatial) * -0.5;
        // J⁻¹ is symmetrised: the rounding of its columns would otherwise make the equations non-Hamiltonian.
        let half_velocity = (inverse + inverse.transpose()) * 0.125;
        Self { half_velocity, half_bias, spatial, torque }
    }

    /// The advected parameters in the body frame, at this attitude.
    #[inline(always)]
    pub(super) fn seen_from(&self, attitude: &SO3) -> L::Advected {
        self.spatial.seen_from(attitude)
    }

    /// The rates of change, times a weight.
    #[inline(always)]
    pub(super) fn weighted_rate(&self, place: &PhasePoint, weight: f64) -> PhasePoint {
        let [q @ .., e, f, g, h] = *place;
        let (j, m) = (&self.half_velocity, twice_momentum(place));
        // The product is written out: nalgebra's, a column at a time, makes a step a twentieth longer.
        let half_velocity = Vector3::new(
            j.m11 * m.x + j.m12 * m.y + j.m13 * m.z - self.half_bias.x,
            j.m21 * m.x + j.m22 * m.y + j.m23 * m.z - self.half_bias.y,
            j.m31 * m.x + j.m32 * m.y + j.m33 * m.z - self.half_bias.z,
        );
        let turn = half_velocity * weight;
        let [a, b, c, d] = times(&q, &turn);
        let [e, f, g, h] = times(&[e, f, g, h], &turn);
        // The compiler removes the rest if there is no potential.
        if !L::FACTS.parts.kick_before {
            return [a, b, c, d, e, f, g, h];
        }
        let scale = 2.0 / length_squared(place);
        let w = self.spatial.seen_from(&SO3::from_matrix_unchecked(rotation(&q, scale)));
        let [r, s, t, u] = times(&q, &(L::kick_before(&self.torque, &w) * (scale * weight)));
        [a, b, c, d, e + r, f + s, g + t, h + u]
    }
}

/// The rotation of `q/|q|`, for `scale = 2/|q|²`. The products don't wait for the division in it.
#[inline(always)]
pub(super) fn rotation(&[a, b, c, d]: &[f64; 4], scale: f64) -> Matrix3<f64> {
    let (bb, cc, dd) = (b * b, c * c, d * d);
    let (bc, bd, cd) = (b * c, b * d, c * d);
    let (ab, ac, ad) = (a * b, a * c, a * d);
    #[rustfmt::skip]
    let matrix = Matrix3::new(
        1.0 - scale * (cc + dd), scale * (bc - ad), scale * (bd + ac),
        scale * (bc + ad), 1.0 - scale * (bb + dd), scale * (cd - ab),
        scale * (bd - ac), scale * (cd + ab), 1.0 - scale * (bb + cc),
    );
    matrix
}

/// The phase-space point `(q, 2 q Π)` of a unit quaternion and a body momentum.
pub(super) fn lifted(&[a, b, c, d]: &[f64; 4], momentum: &Vector3<f64>) -> PhasePoint {
    let [e, f, g, h] = times(&[a, b, c, d], &(momentum * 2.0));
    [a, b, c, d, e, f, g, h]
}

/// Twice the body momentum, `2 Π = Im(q̄ p)`.
#[inline(always)]
pub(super) fn twice_momentum(&[a, b, c, d, e, f, g, h]: &PhasePoint) -> Vector3<f64> {
    Vector3::new(a * f - e * b - (c * h - d * g), a * g - e * c - (d * f - b * h), a * h - e * d - (b * g - c * f))
}

/// The product of a quaternion and an imaginary quaternion.
#[inline(always)]
pub(super) fn times(&[a, b, c, d]: &[f64; 4], v: &Vector3<f64>) -> [f64; 4] {
    [
        -(b * v.x + c * v.y + d * v.z),
        a * v.x + (c * v.z - d * v.y),
        a * v.y + (d * v.x - b * v.z),
        a * v.z + (b * v.y - c * v.x),
    ]
}

/// `|q|²`.
#[inline(always)]
pub(super) fn length_squared(&[a, b, c, d, ..]: &PhasePoint) -> f64 {
    (a * a + b * b) + (c * c + d * d)
}
