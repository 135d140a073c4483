//! Drifts that turn by very many radians: the attitude stays a rotation, or the step is refused.

use liestep::effects::{Gravity, RigidBody};
use liestep::methods::{ExactBody, KineticFlow, SplittingScheme, SymmetricBody};
use liestep::prelude::*;
use liestep::{StepError, Stepper};
use nalgebra::Vector3;

const SCHEMES: [SplittingScheme; 2] = [SplittingScheme::NYSTROM_14, SplittingScheme::KAHAN_LI_8];

/// Steps of a second in gravity, at rates up to those at which the angle has no significant digit.
fn assert_rotations<K: KineticFlow<f64>>(moments: Vector3<f64>, flow: &K) {
    let body = RigidBody { J_d: NonstandardInertia::from_principal_moments(moments).unwrap() };
    let gravity = Gravity { m: 1.0, g: 9.81, rho: Vector3::z(), up: Vector3::z() };
    for scheme in SCHEMES {
        let stepper = Stepper::split(body + gravity, 1.0, flow.clone(), scheme).unwrap();
        for rate in [1.0, 1e1, 1e2, 1e4, 1e6, 1e9, 3e9, 1e10, 1e12, 1e14, 1e16, 1e18, 1e30, 1e100] {
            let mut state = stepper.start(SO3::identity(), Vector3::new(1.0, 0.3, -0.7) * rate).unwrap();
            let before = state;
            match stepper.step(&mut state) {
                Ok(_) => {
                    let defect = state.orthogonality_defect();
                    assert!(defect < 1e-13, "{}, {rate:e}: {defect:e}", scheme.name());
                    let length = state.momentum().norm() / before.momentum().norm();
                    // The bound is the largest effect of gravity in a second.
                    assert!((length - 1.0).abs() < 10.0 / rate + 1e-12, "{}, {rate:e}: {length:e}", scheme.name());
                }
                Err(error) => {
                    assert!(matches!(error, StepError::AngleWithoutDigits { .. }) && rate > 1e13, "{rate:e}: {error}");
                    assert_eq!(state, before);
                }
            }
        }
    }
}

#[test]
fn of_a_symmetric_body() {
    let moments = Vector3::new(2.0, 2.0, 3.0);
    let flow = SymmetricBody::new(&Inertia::from_principal_moments(moments).unwrap()).unwrap();
    assert_rotations(moments, &flow);
}

#[test]
fn of_any_body_exactly() {
    // The last body is a needle.
    for moments in [Vector3::new(2.0, 2.0, 3.0), Vector3::new(2.0, 2.5, 3.0), Vector3::new(1e-6, 1.0, 1.0)] {
        assert_rotations(moments, &ExactBody::new(&Inertia::from_principal_moments(moments).unwrap()));
    }
}
