//! Motions of a free body in closed form.

use nalgebra::{Matrix3, Rotation3, Vector3};
use workbench::heavy_top::precession::complete_integral;

/// The duration of two flips, `4 K(k)/λ`, for moments `J_1 < J_2 < J_3` and a body velocity.
///
/// The middle rate is a Jacobi elliptic function of the modulus `k` in `λ t`, [Landau and Lifshitz, Mechanics, § 37].
pub(crate) fn flip_period(moments: &Vector3<f64>, velocity: &Vector3<f64>) -> f64 {
    let [a, b, c] = [moments.x, moments.y, moments.z];
    // p² − 2E J_1 and 2E J_3 − p², both positive, without a difference of large numbers.
    let above = velocity.y.powi(2) * b * (b - a) + velocity.z.powi(2) * c * (c - a);
    let below = velocity.x.powi(2) * a * (c - a) + velocity.y.powi(2) * b * (c - b);
    // p² − 2E J_2 has either sign.
    let middle = velocity.z.powi(2) * c * (c - b) - velocity.x.powi(2) * a * (b - a);
    let (rate, complement) = if middle > 0.0 {
        // k'² = (J_3 − J_1)(p² − 2E J_2)/((J_3 − J_2)(p² − 2E J_1))
        (((c - b) * above / (a * b * c)).sqrt(), (c - a) * middle / ((c - b) * above))
    } else {
        (((b - a) * below / (a * b * c)).sqrt(), -(c - a) * middle / ((b - a) * below))
    };
    4.0 * complete_integral(complement.sqrt()) / rate
}

/// The velocity on the separatrix, from a rotation about the middle axis to the opposite one in infinite time:
/// `Ω_2 = Ω̄ tanh λt`, with `Ω_1` and `Ω_3` proportional to `1/cosh λt`, for moments `J_1 < J_2 < J_3`.
///
/// `λ² = Ω̄² (J_2 − J_1)(J_3 − J_2)/(J_1 J_3)`; `Ω̄` is the rate about the middle axis at either end, rad/s.
pub(crate) fn on_separatrix(moments: &Vector3<f64>, rate: f64, t: f64) -> Vector3<f64> {
    let [a, b, c] = [moments.x, moments.y, moments.z];
    let lambda = rate * ((b - a) * (c - b) / (a * c)).sqrt();
    let outer = rate / (lambda * t).cosh();
    let first = outer * (b * (c - b) / (a * (c - a))).sqrt();
    let third = outer * (b * (b - a) / (c * (c - a))).sqrt();
    Vector3::new(first, rate * (lambda * t).tanh(), third)
}

/// The motion of a symmetric body:
/// `F = exp(t p/J_1) exp(−t (1/J_1 − 1/J_3) p_3 E_3)`, and the momentum `Fᵀ p`, for `J = diag(J_1, J_1, J_3)`.
pub(crate) fn symmetric_body(moments: &Vector3<f64>, momentum: &Vector3<f64>, t: f64) -> (Matrix3<f64>, Vector3<f64>) {
    let spin = t * (1.0 / moments.x - 1.0 / moments.z) * momentum.z;
    let turn = Rotation3::new(momentum * (t / moments.x)) * Rotation3::new(Vector3::z() * -spin);
    (turn.into_inner(), turn.inverse() * momentum)
}
