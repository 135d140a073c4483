//! A Lagrangian that isn't quadratic in the velocity.

use liestep::groups::R3;
use liestep::lagrangian;
use nalgebra::Vector4;

/// A fast particle in a uniform field, `l(v, w) = −m c² √(1 − |v|²/c²) + q w₄`, where `w₄` is the value of an affine
/// function of space at the particle. Newton's iteration inverts the momentum `m v/√(1 − |v|²/c²)`.
///
/// Without `discretise` there is no step: an ODE solver integrates [`RightHandSide`](liestep::motion::RightHandSide).
#[lagrangian(
    group = R3,
    velocity = v,
    advected(w = field),
    l = -m * c * c * (1.0 - v.norm_squared() / (c * c)).sqrt() + q * w[3],
)]
#[derive(Clone, Debug)]
pub struct RelativisticParticle {
    /// Mass at rest, kg.
    pub m: f64,
    /// The velocity of light, m/s.
    pub c: f64,
    /// Charge, C.
    pub q: f64,
    /// The field as an affine function of the position, `⟨field, (x, 1)⟩` in V.
    pub field: Vector4<f64>,
}
