//! Any bytes as a top, a state and a step: the result is a state that satisfies its equation, or a typed error that
//! leaves the state unchanged. Run with `cargo fuzz run step`.

#![no_main]
// The names of the fields are those of the equations.
#![allow(non_snake_case)]

use libfuzzer_sys::fuzz_target;
use liestep::prelude::*;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

/// The heavy top (3.13).
#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)
        - 0.5 * h * m * g * w.dot(&(rho + F * rho)),
)]
#[derive(Clone, Debug)]
struct Top {
    J_d: DiagonalNonstandardInertia,
    m: f64,
    g: f64,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

/// Numbers from the bytes, eight bytes each; zero after the last.
struct Numbers<'a>(&'a [u8]);

impl Numbers<'_> {
    fn next(&mut self) -> f64 {
        let Some((bytes, rest)) = self.0.split_first_chunk::<8>() else { return 0.0 };
        self.0 = rest;
        f64::from_le_bytes(*bytes)
    }

    fn vector(&mut self) -> Vector3<f64> {
        Vector3::new(self.next(), self.next(), self.next())
    }
}

fn is_finite(state: &State<SO3, Vector3<f64>>) -> bool {
    let vectors = [state.momentum(), state.advected()];
    vectors.iter().flatten().chain(state.attitude().as_matrix()).all(|entry| entry.is_finite())
}

/// Checks `𝔽l_d⁻(F, w) = μ` and `𝔽l_d⁺(F, w) = μ⁺`, to the rounding of `F = RᵀR⁺` and of cancelling terms.
fn assert_solved(stepper: &Stepper<Top>, before: &State<SO3, Vector3<f64>>, after: &State<SO3, Vector3<f64>>) {
    let (top, h) = (stepper.scene(), stepper.step_size());
    let f = before.attitude().inverse().compose(&after.attitude()).matrix();
    let (w, size) = (before.advected(), top.J_d.diagonal().amax() / h.abs());
    let kick = 3.0 * (h * top.m * top.g).abs() * top.rho.amax() * w.amax();
    let scale = size + kick + before.momentum().norm() + after.momentum().norm();
    let minus = (top.legendre_minus(&f, &w, h) - before.momentum()).norm();
    let plus = (top.legendre_plus(&f, &w, h) - after.momentum()).norm();
    let allowed = (1e-14 + 4.0 * before.orthogonality_defect()) * scale;
    assert!(minus <= allowed && plus <= allowed, "{minus:e} and {plus:e} of {scale:e}");
}

fuzz_target!(|bytes: &[u8]| {
    let mut numbers = Numbers(bytes);
    let Ok(J_d) = DiagonalNonstandardInertia::from_diagonal(numbers.vector()) else { return };
    let (m, g, rho, up) = (numbers.next(), numbers.next(), numbers.vector(), numbers.vector());
    let Ok(stepper) = Stepper::new(Top { J_d, m, g, rho, up }, numbers.next()) else { return };
    let quaternion = Quaternion::new(numbers.next(), numbers.next(), numbers.next(), numbers.next());
    let attitude = UnitQuaternion::from_quaternion(quaternion);
    let Ok(mut state) = stepper.start_with_momentum(attitude, numbers.vector()) else { return };
    for _ in 0..4 {
        let before = state;
        match stepper.step(&mut state) {
            Ok(_) if stepper.step_size() == 0.0 => assert!(is_finite(&state)),
            Ok(_) => {
                assert!(is_finite(&state), "{state:?}");
                assert_solved(&stepper, &before, &state);
            }
            Err(error) => {
                assert_eq!(format!("{before:?}"), format!("{state:?}"));
                if let StepError::BeyondSolvable { step, largest, .. } = error {
                    assert!(largest.abs() < step.abs() && largest * step >= 0.0, "{step:e} {largest:e}");
                }
                return;
            }
        }
    }
});
