//! The Cayley and the log-trace kinetic terms have a step where (3.13) has none.

use declarations::{CayleyTop, LogTraceTop};
use liestep::mechanics::Inertia;
use liestep::{SO3, Stepper};
use nalgebra::{UnitQuaternion, Vector3};

fn tilted() -> UnitQuaternion<f64> {
    UnitQuaternion::from_scaled_axis(Vector3::new(0.8, 0.0, 0.0))
}

#[test]
fn s6_kinetic_terms_without_a_step_limit() {
    // h Ω = 2.46 about the third axis, far beyond the 90° at which (3.13) ends.
    let (h, velocity) = (0.1, Vector3::new(0.5, 1.0, 24.6));
    let J = Inertia::from_principal_moments(Vector3::new(3.0, 3.0, 4.0)).unwrap();
    let (weight, rho, up) = (9.81, Vector3::z(), Vector3::z());
    let stepper = Stepper::new(CayleyTop { J, weight, rho, up }, h).unwrap();
    let mut state = stepper.start(tilted(), velocity).unwrap();
    let vertical = state.momentum_along(&up);
    for _ in 0..1000 {
        stepper.step(&mut state).unwrap();
    }
    assert!((state.momentum_along(&up) - vertical).abs() < 1e-11 * vertical.abs());
    let stepper = Stepper::new(LogTraceTop { I1: 3.0, weight, rho, up }, h).unwrap();
    let mut state = stepper.start(SO3::from(tilted()), velocity).unwrap();
    for _ in 0..1000 {
        stepper.step(&mut state).unwrap();
    }
}

/// `E_h = |p|²/(2 I₁) + m g ⟨w, ρ⟩ + (h/2)(m g/I₁) ⟨p, w × ρ⟩` is an integral of the discrete top.
#[test]
fn s6_the_log_trace_top_has_an_energy() {
    let (I1, weight, rho, up) = (3.0, 9.81, Vector3::z(), Vector3::z());
    for h in [0.01, 0.1] {
        let stepper = Stepper::new(LogTraceTop { I1, weight, rho, up }, h).unwrap();
        let mut state = stepper.start(tilted(), Vector3::new(0.5, 2.0, 12.0)).unwrap();
        let energy = |p: Vector3<f64>, w: Vector3<f64>| {
            p.norm_squared() / (2.0 * I1) + weight * w.dot(&rho) + 0.5 * h * weight / I1 * p.dot(&w.cross(&rho))
        };
        let start = energy(state.momentum(), state.advected());
        for _ in 0..10_000 {
            stepper.step(&mut state).unwrap();
        }
        let error = (energy(state.momentum(), state.advected()) / start - 1.0).abs();
        assert!(error < 1e-12, "{error:e} at h = {h}");
    }
}
