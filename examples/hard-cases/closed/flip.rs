//! The period of a body that flips about its middle axis.

use nalgebra::Vector3;
use workbench::heavy_top::precession::complete_integral;

/// The time of two flips, `4 K(k)/λ`, for moments `J_1 < J_2 < J_3` and a body velocity.
///
/// The middle rate is a Jacobi elliptic function of the modulus `k` in `λ t`, [Landau and Lifshitz, Mechanics, § 37].
pub(crate) fn period(moments: &Vector3<f64>, velocity: &Vector3<f64>) -> f64 {
    let [a, b, c] = [moments.x, moments.y, moments.z];
    // p² − 2E J_1 and 2E J_3 − p², both positive, without subtracting large numbers.
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
