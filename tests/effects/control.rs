//! Torques that are prescribed anew for each step.

use liestep::effects::{Thrust, Torque};
use liestep::{SO3, StepError, Stepper};
use nalgebra::Vector3;
use workbench::measure::relative;

use super::{body, gravity, started};

/// A prescribed torque that is the same in each step acts as the effect `Torque`; so does a thrust with that torque.
#[test]
fn a_constant_torque_is_the_effect() {
    let torque = Vector3::new(0.3, -0.2, 0.1);
    let thruster = Thrust { at: Vector3::new(0.0, 0.5, 1.0), thrust: Vector3::new(-0.2, -0.3, 0.0) };
    let (alone, mut controlled) = started(body() + gravity(), 0.01);
    let (effect, mut turned) = started(body() + gravity() + Torque { torque }, 0.01);
    let (engine, mut pushed) = started(body() + gravity() + thruster, 0.01);
    for _ in 0..500 {
        alone.step_forced(&mut controlled, &torque).unwrap();
        effect.step(&mut turned).unwrap();
        engine.step(&mut pushed).unwrap();
    }
    assert!(relative(&controlled.momentum(), &turned.momentum()) < 1e-11);
    assert!(relative(&pushed.momentum(), &turned.momentum()) < 1e-11);
}

/// The spatial momentum of a free body changes by the impulse: about a fixed axis, exactly.
#[test]
fn impulses_add_up() {
    let stepper = Stepper::new(body(), 0.0625).unwrap();
    let mut state = stepper.start(SO3::identity(), Vector3::zeros()).unwrap();
    let mut sum = 0.0;
    for step in 0..200_i32 {
        let torque = f64::from(step % 7 - 3) * 0.125;
        stepper.step_forced(&mut state, &Vector3::new(0.0, 0.0, torque)).unwrap();
        sum += torque * 0.0625;
        assert_eq!(state.momentum(), Vector3::new(0.0, 0.0, sum));
    }
}

/// A prescribed torque that varies in time, taken at the middle of each step, doesn't lower the second order.
#[test]
fn a_smooth_input_keeps_the_order() {
    let at_one = |steps: u32| {
        let h = 1.0 / f64::from(steps);
        let (stepper, mut state) = started(body() + gravity(), h);
        for step in 0..steps {
            let t = (f64::from(step) + 0.5) * h;
            stepper.step_forced(&mut state, &Vector3::new((3.0 * t).sin(), t * t, (5.0 * t).cos())).unwrap();
        }
        state.momentum()
    };
    let truth = at_one(20_000);
    let [coarse, fine] = [100, 200].map(|steps| relative(&at_one(steps), &truth));
    assert!((coarse / fine - 4.0).abs() < 0.1, "{coarse:e} {fine:e}");
}

#[test]
fn a_bad_torque_is_an_error_and_changes_nothing() {
    let (stepper, mut state) = started(body() + gravity(), 0.01);
    let before = state;
    for bad in [f64::NAN, f64::INFINITY] {
        let error = stepper.step_forced(&mut state, &Vector3::new(0.0, bad, 0.0));
        assert_eq!(error, Err(StepError::NonFinite { what: "control force" }));
    }
    // The torque is so large that the body would turn too far in one step.
    let error = stepper.step_forced(&mut state, &Vector3::new(0.0, 1e9, 0.0));
    assert!(matches!(error, Err(StepError::BeyondSolvable { .. })), "{error:?}");
    assert_eq!(state, before);
}
