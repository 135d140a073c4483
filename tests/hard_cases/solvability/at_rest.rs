//! Where nothing acts nothing happens, exactly: no formula divides by the angle of a step, by the momentum, by `w` or
//! by the weight.

use declarations::{FreeBody, HeavyTop};
use liestep::groups::LieGroup as _;
use liestep::mechanics::{DiscreteLagrangian, Regular};
use liestep::{SO3, Stepper};
use nalgebra::{UnitQuaternion, Vector3};

/// Starts at rest and finds the same attitude, momentum and advected parameters after each of many steps.
fn assert_stays<L: DiscreteLagrangian<Scalar = f64, Group = SO3> + Regular>(lagrangian: L, attitude: impl Into<SO3>) {
    let stepper = Stepper::new(lagrangian, 0.01).unwrap();
    let mut state = stepper.start(attitude, Vector3::zeros()).unwrap();
    let before = state;
    for _ in 0..1000 {
        stepper.step(&mut state).unwrap();
        assert_eq!(
            (state.attitude(), state.momentum(), state.advected()),
            (before.attitude(), before.momentum(), before.advected())
        );
    }
    assert!(stepper.energy(&state).to_bits() == stepper.energy(&before).to_bits());
}

fn tilted() -> UnitQuaternion<f64> {
    UnitQuaternion::from_scaled_axis(Vector3::new(0.8, -0.3, 0.1))
}

#[test]
fn s4_zero_momentum_without_forces() {
    assert_stays(FreeBody::with_moments([3.0, 3.0, 4.0]), tilted());
    assert_stays(FreeBody::with_moments([1.0, 2.0, 3.0]), SO3::identity());
}

#[test]
fn s4_zero_gravity_mass_lever_or_vertical() {
    assert_stays(HeavyTop { g: 0.0, ..HeavyTop::asymmetric() }, tilted());
    assert_stays(HeavyTop { m: 0.0, ..HeavyTop::asymmetric() }, tilted());
    assert_stays(HeavyTop { rho: Vector3::zeros(), ..HeavyTop::asymmetric() }, tilted());
    assert_stays(HeavyTop { up: Vector3::zeros(), ..HeavyTop::asymmetric() }, tilted());
}

#[test]
fn s4_exactly_hanging_and_exactly_inverted() {
    for rho in [Vector3::z(), Vector3::new(0.3, 0.2, 0.4)] {
        // A multiple of two has the same digits, so the torque `w × ρ` is zero to the last bit.
        assert_stays(HeavyTop { rho, up: rho * 2.0, ..HeavyTop::asymmetric() }, SO3::identity());
        assert_stays(HeavyTop { rho, up: rho * -2.0, ..HeavyTop::asymmetric() }, SO3::identity());
    }
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

/// The vector that gravity acts along may be zero while the body turns: it is then a free body.
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
