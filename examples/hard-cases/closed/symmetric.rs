//! The free motion of a symmetric body.

use nalgebra::{Matrix3, Rotation3, Vector3};

/// `F = exp(t p/J_1) exp(−t (1/J_1 − 1/J_3) p_3 E_3)`, and the momentum `Fᵀ p`, for `J = diag(J_1, J_1, J_3)`.
pub(crate) fn motion(moments: &Vector3<f64>, momentum: &Vector3<f64>, t: f64) -> (Matrix3<f64>, Vector3<f64>) {
    let spin = t * (1.0 / moments.x - 1.0 / moments.z) * momentum.z;
    let turn = Rotation3::new(momentum * (t / moments.x)) * Rotation3::new(Vector3::z() * -spin);
    (turn.into_inner(), turn.inverse() * momentum)
}
