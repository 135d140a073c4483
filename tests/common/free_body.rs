//! The variational equations of the free body, by the classical Runge–Kutta method.

use nalgebra::{Matrix3, Vector3};
use workbench::runge_kutta;

/// The changes of turn and momentum by each variable.
pub type Columns = Vec<(Vector3<f64>, Vector3<f64>)>;

/// The derivatives of `F`, as `δF = ε̂ F`, and of the momentum after a time with respect to the initial momentum and
/// the inertia:
///
/// ```text
/// Ḟ = F Ω̂        μ̇ = μ × Ω        ε̇ = F δΩ        δμ̇ = δμ × Ω + μ × δΩ        J δΩ = δμ − δJ Ω
/// ```
pub fn variational(
    inertia: &Matrix3<f64>,
    varied: &[Matrix3<f64>],
    momentum: &Vector3<f64>,
    time: f64,
) -> (Matrix3<f64>, Columns) {
    const STEPS: u32 = 40_000;
    let inverse = inertia.try_inverse().expect("a body");
    let vector = |y: &[f64], at: usize| Vector3::from_column_slice(&y[at..at + 3]);
    let rate = |y: &[f64], rates: &mut [f64]| {
        let (F, mu) = (Matrix3::from_column_slice(&y[..9]), vector(y, 9));
        let Omega = inverse * mu;
        rates[..9].copy_from_slice((F * Omega.cross_matrix()).as_slice());
        rates[9..12].copy_from_slice(mu.cross(&Omega).as_slice());
        for k in 0..3 + varied.len() {
            let at = 12 + 6 * k;
            let by_inertia = k.checked_sub(3).map_or(Vector3::zeros(), |k| varied[k] * Omega);
            let change = vector(y, at + 3);
            let of_velocity = inverse * (change - by_inertia);
            rates[at..at + 3].copy_from_slice((F * of_velocity).as_slice());
            rates[at + 3..at + 6].copy_from_slice((change.cross(&Omega) + mu.cross(&of_velocity)).as_slice());
        }
    };
    let mut y = vec![0.0; 12 + 6 * (3 + varied.len())];
    y[..9].copy_from_slice(Matrix3::<f64>::identity().as_slice());
    y[9..12].copy_from_slice(momentum.as_slice());
    for k in 0..3 {
        y[12 + 6 * k + 3 + k] = 1.0;
    }
    for _ in 0..STEPS {
        runge_kutta::step(rate, &mut y, time / f64::from(STEPS));
    }
    let columns = (0..3 + varied.len()).map(|k| (vector(&y, 12 + 6 * k), vector(&y, 15 + 6 * k)));
    (Matrix3::from_column_slice(&y[..9]), columns.collect())
}
