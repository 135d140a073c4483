//! The motion on the separatrix: from one turn about the middle axis to the opposite one, in infinite time.

use nalgebra::Vector3;

/// `Ω_2 = Ω̄ tanh λt`, with `Ω_1` and `Ω_3` in proportion to `1/cosh λt`, for moments `J_1 < J_2 < J_3`.
///
/// `λ² = Ω̄² (J_2 − J_1)(J_3 − J_2)/(J_1 J_3)`; `Ω̄` is the rate about the middle axis at either end, rad/s.
pub(crate) fn velocity(moments: &Vector3<f64>, rate: f64, t: f64) -> Vector3<f64> {
    let [a, b, c] = [moments.x, moments.y, moments.z];
    let lambda = rate * ((b - a) * (c - b) / (a * c)).sqrt();
    let outer = rate / (lambda * t).cosh();
    let first = outer * (b * (c - b) / (a * (c - a))).sqrt();
    let third = outer * (b * (b - a) / (c * (c - a))).sqrt();
    Vector3::new(first, rate * (lambda * t).tanh(), third)
}
