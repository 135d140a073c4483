//! The motion of a free body by the Taylor series of its equations: `p' = p × Ω`, `q' = ½ q Ω`, `Ω = J⁻¹ p`.
//!
//! This solution doesn't use elliptic functions.

use nalgebra::Vector3;
use num_traits::{One as _, Zero as _};

use super::heavy_top::of_quaternion;
use super::{DoubleDouble, Matrix, Vector, long};

/// The terms of the series; a step turns the body by a tenth of a radian, so the last term is some 10⁻³⁵.
const TERMS: usize = 24;
const ANGLE: f64 = 0.1;

/// The increments `F − I` and `p⁺ − p` over the time, for a momentum and inverse moments.
pub(crate) fn turn(inverse_moments: &Vector, momentum: &Vector, time: DoubleDouble) -> (Matrix, Vector) {
    // The body's rate and the rate of its momentum in the body frame: for a rod both are far less than the fastest
    // rotation with this momentum.
    let [i, p] = [inverse_moments, momentum].map(|v| v.map(DoubleDouble::rounded));
    let across = Vector3::from_fn(|k, _| p[k] * p[k] * ((i[(k + 1) % 3] - i[k]) * (i[(k + 2) % 3] - i[k])).abs());
    let rate = p.component_mul(&i).norm() + across.sum().sqrt();
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // some thousands at the most
    let steps = (time.rounded().abs() * rate / ANGLE).ceil().max(1.0) as u32;
    let h = time / long(steps.into());
    let (mut p, mut real, mut imaginary) = (*momentum, DoubleDouble::one(), Vector::zeros());
    for _ in 0..steps {
        (p, real, imaginary) = step(inverse_moments, h, (p, real, imaginary));
    }
    let length = (real * real + imaginary.dot(&imaginary)).sqrt();
    let rotation = of_quaternion(real / length, &imaginary.map(|part| part / length));
    (rotation - Matrix::identity(), p - momentum)
}

type State = (Vector, DoubleDouble, Vector);

/// A step by its Taylor coefficients one by one, each from all before.
fn step(inverse_moments: &Vector, h: DoubleDouble, (p, real, imaginary): State) -> State {
    let (mut ps, mut omegas, mut reals, mut imaginaries) = (vec![p], Vec::new(), vec![real], vec![imaginary]);
    let half = long(0.5);
    for n in 0..TERMS {
        omegas.push(ps[n].component_mul(inverse_moments));
        let sum = |term: &dyn Fn(usize) -> Vector| (0..=n).fold(Vector3::zeros(), |sum: Vector, k| sum + term(k));
        let over = long(1.0) / long(f64::from(u32::try_from(n).unwrap() + 1));
        let of_p = sum(&|k| ps[k].cross(&omegas[n - k]));
        let of_real = (0..=n).fold(DoubleDouble::zero(), |sum, k| sum - imaginaries[k].dot(&omegas[n - k]));
        let of_imaginary = sum(&|k| omegas[n - k] * reals[k] + imaginaries[k].cross(&omegas[n - k]));
        ps.push(of_p * over);
        reals.push(of_real * over * half);
        imaginaries.push(of_imaginary * (over * half));
    }
    let vector = |terms: &[Vector]| terms.iter().rev().fold(Vector::zeros(), |sum, term| sum * h + term);
    let number = reals.iter().rev().fold(DoubleDouble::zero(), |sum, term| sum * h + *term);
    (vector(&ps), number, vector(&imaginaries))
}
