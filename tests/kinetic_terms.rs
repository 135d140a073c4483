//! Kinetic terms other than that of (3.13), declared as they stand in the literature.

// The letters of the field.
#![allow(non_snake_case)]
// The declarations are shared with the examples.
#![allow(unreachable_pub)]

mod common;

use common::measure::relative;
use common::reference::{matrix, number, read, vector};
use liestep::{DiscreteLiePoisson, Inertia, LieGroup as _, SO3, Stepper};
use nalgebra::{UnitQuaternion, Vector3};

#[path = "../examples/declarations/cayley_top.rs"]
mod cayley_top;
#[path = "../examples/declarations/fourth_order_top.rs"]
mod fourth_order_top;
#[path = "../examples/declarations/log_top.rs"]
mod log_top;
#[path = "../examples/declarations/log_trace_top.rs"]
mod log_trace_top;
#[path = "../examples/declarations/sixth_order_top.rs"]
mod sixth_order_top;

use cayley_top::CayleyTop;
use fourth_order_top::FourthOrderTop;
use log_top::LogTop;
use log_trace_top::LogTraceTop;
use sixth_order_top::SixthOrderTop;

#[test]
fn golden_entries_of_the_cayley_top_are_reproduced() {
    golden("cayley_trapezoid", |J, weight, rho, up| CayleyTop { J, weight, rho, up });
}

#[test]
fn golden_entries_of_the_log_top_are_reproduced() {
    golden("log_trapezoid", |J, weight, rho, up| LogTop { J, weight, rho, up });
}

#[test]
fn golden_entries_of_the_fourth_order_top_are_reproduced() {
    golden("L4_log", |J, weight, rho, up| FourthOrderTop { J, weight, rho, up });
}

#[test]
fn golden_entries_of_the_sixth_order_top_are_reproduced() {
    golden("L6_log", |J, weight, rho, up| SixthOrderTop { J, weight, rho, up });
}

fn golden<L>(name: &str, top: impl Fn(Inertia, f64, Vector3<f64>, Vector3<f64>) -> L)
where
    L: liestep::Regular<Scalar = f64, Group = SO3, Advected = Vector3<f64>>,
{
    let data = read("golden_steps");
    let steps = data["steps"].as_array().unwrap();
    let entries: Vec<_> = steps.iter().filter(|entry| entry["l_d"] == name).collect();
    assert_eq!(entries.len(), 4, "two bodies, two steps");
    for entry in entries {
        let J = Inertia::from_principal_moments(vector(&entry["J"])).unwrap();
        let (weight, rho, up) = (number(&entry["mg"]), vector(&entry["rho"]), Vector3::z());
        let flow = DiscreteLiePoisson::new(top(J, weight, rho, up), number(&entry["h"])).unwrap();
        let (mut momentum, mut w, mut guess) = (vector(&entry["Pi0"]), vector(&entry["w0"]), Vector3::zeros());
        for i in 1..=10 {
            let step = flow.step(&momentum, &w, &guess).unwrap();
            (momentum, w, guess) = (step.momentum, step.advected, step.coordinates);
            if i == 1 {
                assert!(relative(&step.element().matrix(), &matrix(&entry["F0"])) < 1e-12);
                assert!(relative(&momentum, &vector(&entry["Pi1"])) < 1e-12);
            }
        }
        let error = relative(&momentum, &vector(&entry["Pi10"]));
        assert!(error < 1e-12, "{error:e} after ten steps");
        assert!(relative(&w, &vector(&entry["w10"])) < 1e-12);
    }
}

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
