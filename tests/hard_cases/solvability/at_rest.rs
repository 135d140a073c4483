//! Bodies at rest without any torque stay at rest exactly: no formula divides by the angle of a step, by the momentum,
//! by `w` or by the weight.

use declarations::HeavyTop;
use liestep::{SO3, Stepper};
use nalgebra::{UnitQuaternion, Vector3};

fn tilted() -> UnitQuaternion<f64> {
    UnitQuaternion::from_scaled_axis(Vector3::new(0.8, -0.3, 0.1))
}

/// Upright and spinning about the axis of symmetry: the torque is zero, the axis stays, the angle is known.
#[test]
fn s4_upright_spin_turns_about_the_vertical_alone() {
    let (h, speed) = (0.01, 5.0_f64);
    let stepper = Stepper::new(HeavyTop::thesis(), h).unwrap();
    let mut state = stepper.start(SO3::identity(), Vector3::z() * speed).unwrap();
    let before = state;
    for _ in 0..1000 {
        stepper.step(&mut state).unwrap();
        assert_eq!((state.momentum(), state.advected()), (before.momentum(), before.advected()));
    }
    // `sin θ = hΩ` at each step; the attitude loses a rounding per step.
    let angle = 1000.0 * (h * speed).asin();
    let expected = UnitQuaternion::from_scaled_axis(Vector3::z() * angle).into();
    assert!(state.attitude().inverse().compose(&expected).log().norm() < 1e-13);
}

/// A turning body whose direction of gravity is zero is a free body.
#[test]
fn s4_turning_without_a_vertical() {
    let top = HeavyTop { up: Vector3::zeros(), ..HeavyTop::asymmetric() };
    let stepper = Stepper::new(top, 0.01).unwrap();
    let mut state = stepper.start(tilted(), Vector3::new(1.0, 2.0, 0.5)).unwrap();
    let before = state.spatial_momentum();
    for _ in 0..1000 {
        stepper.step(&mut state).unwrap();
    }
    assert_eq!(state.advected(), Vector3::zeros());
    // The spatial momentum loses a rounding per step.
    assert!((state.spatial_momentum() - before).norm() < 1e-13 * before.norm());
}

/// A step whose inverse leaves the range of the scalar is refused when the stepper is built, not when it steps.
#[test]
fn a_step_out_of_range_is_refused() {
    use liestep::SetupError;
    for h in [1e-300, -1e-200, 1e200, f64::NAN, f64::INFINITY, f64::MIN_POSITIVE / 4.0] {
        let refused = Stepper::new(HeavyTop::thesis(), h);
        assert!(matches!(refused, Err(SetupError::InvalidStep { .. })), "h = {h:e}: {refused:?}");
    }
    for h in [1e-60, -1e-30, 0.0, 1e3] {
        assert!(Stepper::new(HeavyTop::thesis(), h).is_ok(), "h = {h:e}");
    }
}
