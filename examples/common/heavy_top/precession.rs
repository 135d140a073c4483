//! Nutation and precession of a symmetric top by its first integrals, in closed form.
//!
//! With `u = cos θ` and the constants `Π_3` and `e₃·RΠ` the energy is `u'² = f(u)` with a cubic `f`: `u` oscillates
//! between the two roots of `f` below one, with a period that is an elliptic integral \[AS64, 17.6\].

use core::f64::consts::PI;

use nalgebra::Vector3;

use super::declaration::HeavyTop;
use super::euler_angles::SymmetricTop;

/// Nutation and precession of a motion.
#[derive(Clone, Copy, Debug)]
pub struct Precession {
    /// The least and the greatest tilt `θ`, rad.
    pub tilt: (f64, f64),
    /// The least and the greatest rate `φ'`, rad/s.
    pub rate: (f64, f64),
    /// The period of the nutation, s.
    pub period: f64,
}

/// The three kinds of precession, \[RDAE, figure 3.3\].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The rate changes its sign.
    Looping,
    /// The rate has a zero at the least tilt, without a change of sign.
    Cuspidal,
    /// The rate has no zero.
    Unidirectional,
}

impl Precession {
    /// Nutation and precession for a momentum in the body frame and the vertical in the body frame.
    pub fn of(top: &HeavyTop, momentum: &Vector3<f64>, w: &Vector3<f64>) -> Self {
        let SymmetricTop { across, weight, .. } = SymmetricTop::of(top);
        let (a, b) = (momentum.z / across, momentum.dot(w) / across);
        let energy = 0.5 * momentum.xy().norm_squared() / across + weight * w.z;
        let (alpha, beta) = (2.0 * energy / across, 2.0 * weight / across);
        // The cubic f(u) = (α − βu)(1 − u²) − (b − au)².
        let [low, high, beyond] = roots(-(alpha + a * a) / beta, (2.0 * a * b - beta) / beta, (alpha - b * b) / beta);
        let rate = |u: f64| (b - a * u) / (1.0 - u * u);
        let rates = (0..=1000).map(|i| rate(low + (high - low) * f64::from(i) / 1000.0));
        let rate = rates.fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), r| (least.min(r), most.max(r)));
        let modulus = (high - low) / (beyond - low);
        let period = 4.0 * complete_integral((1.0 - modulus).sqrt()) / (beta * (beyond - low)).sqrt();
        Self { tilt: (high.acos(), low.acos()), rate, period }
    }

    /// The kind of precession by the sign of the rate; rates below `zero` rad/s count as zero.
    pub fn kind(&self, zero: f64) -> Kind {
        let (least, most) = self.rate;
        match least * most {
            _ if least.abs().min(most.abs()) <= zero => Kind::Cuspidal,
            product if product < 0.0 => Kind::Looping,
            _ => Kind::Unidirectional,
        }
    }
}

/// The three real roots of `u³ + A u² + B u + C`, in order (Viète).
fn roots(a: f64, b: f64, c: f64) -> [f64; 3] {
    let p = b - a * a / 3.0;
    let q = 2.0 * a.powi(3) / 27.0 - a * b / 3.0 + c;
    let size = 2.0 * (-p / 3.0).sqrt();
    let angle = (3.0 * q / (p * size)).clamp(-1.0, 1.0).acos() / 3.0;
    let mut roots = [0.0, 1.0, 2.0].map(|k| size * (angle - 2.0 * PI * k / 3.0).cos() - a / 3.0);
    roots.sort_by(f64::total_cmp);
    roots
}

/// The complete elliptic integral `K` for the complementary modulus `k'`, by the arithmetic–geometric mean, which
/// converges quadratically.
pub fn complete_integral(complement: f64) -> f64 {
    let (mut one, mut other) = (1.0, complement);
    for _ in 0..40 {
        (one, other) = (0.5 * (one + other), f64::sqrt(one * other));
    }
    0.5 * PI / one
}
