//! (3.13) is self-adjoint, `l_d(F, w, h) = −l_d(F⁻¹, F⁻¹·w, −h)`, so the step of `−h` undoes that of `h`; that of zero
//! is the identity.

use checks::random::Random;
use declarations::HeavyTop;
use declarations::Motion;
use liestep::Stepper;
use liestep::groups::LieGroup as _;
use liestep::motion::DiscreteLiePoisson;
use workbench::measure::relative;

#[test]
fn s5_zero_step_is_the_identity() {
    let motion = Motion::looping();
    let stepper = Stepper::new(motion.top.clone(), 0.0).unwrap();
    let mut state = stepper.start(motion.attitude, motion.velocity).unwrap();
    let before = state;
    for _ in 0..10 {
        stepper.step(&mut state).unwrap();
    }
    assert_eq!(
        (before.attitude(), before.momentum(), before.advected()),
        (state.attitude(), state.momentum(), state.advected())
    );
}

#[test]
fn s5_negative_step_is_the_inverse_map() {
    let mut random = Random::new(5);
    for h in [0.1, 0.01, 1e-6] {
        let [there, back] = [h, -h].map(|h| DiscreteLiePoisson::new(HeavyTop::asymmetric(), h).unwrap());
        for _ in 0..50 {
            let (momentum, w) = (random.vector() * 5.0, random.direction());
            let step = there.step(&momentum, &w, &nalgebra::Vector3::zeros()).unwrap();
            let returned = back.step(&step.momentum, &step.advected, &-step.coordinates).unwrap();
            // Some roundings of two steps.
            assert!(relative(&returned.momentum, &momentum) < 2e-15);
            assert!(relative(&returned.advected, &w) < 2e-15);
            assert!(relative(&returned.element().matrix(), &step.element().inverse().matrix()) < 2e-15);
        }
    }
}

/// The worst relative error of attitude, momentum and `w` after a million steps there and a million back.
fn error_on_return(h: f64) -> f64 {
    let motion = Motion::looping();
    let [there, back] = [h, -h].map(|h| Stepper::new(motion.top.clone(), h).unwrap());
    let mut state = there.start(motion.attitude, motion.velocity).unwrap();
    let before = state;
    for _ in 0..1_000_000 {
        there.step(&mut state).unwrap();
    }
    for _ in 0..1_000_000 {
        back.step(&mut state).unwrap();
    }
    let errors = [
        relative(&state.attitude().matrix(), &before.attitude().matrix()),
        relative(&state.momentum(), &before.momentum()),
        relative(&state.advected(), &before.advected()),
    ];
    println!("h = {h}: {errors:?}");
    errors.into_iter().fold(0.0, f64::max)
}

/// Ten seconds and a hundred. A rounding of the momentum changes the rate of the phase, and so its effect on the way
/// back grows with the time: over 10⁴ s the phase comes back to 10⁻⁹ only, in any regular motion with a twist.
#[test]
fn s5_a_million_steps_there_and_back() {
    for h in [1e-5, 1e-4] {
        // Two million roundings at random, and what the twist makes of them.
        let error = error_on_return(h);
        assert!(error <= 1e-12, "h = {h}: {error:e}");
    }
}
