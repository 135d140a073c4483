//! The replacements by a stepper with a policy if there is no step, and their reports.

use declarations::{HeavyTop, Motion};
use liestep::motion::Remedy;
use liestep::{SO3, State, StepError, Stepper};
use nalgebra::Vector3;

type TopState = State<SO3, Vector3<f64>>;

/// The setting of the script that the thesis' author has published, at which (3.13) has no first step.
fn published() -> (Stepper<HeavyTop>, TopState) {
    let Motion { top, attitude, velocity, .. } = Motion::looping();
    let stepper = Stepper::new(top, 0.1).unwrap();
    let state = stepper.start(attitude, velocity).unwrap();
    (stepper, state)
}

/// Checks the invariants of every step: the group, `|w|` and the momentum about the vertical.
fn assert_kept(state: &TopState, start: &TopState) {
    assert!(state.orthogonality_defect() < 1e-14);
    assert!((state.advected().norm() - 1.0).abs() < 1e-14);
    let vertical = |state: &TopState| state.momentum_along(&Vector3::z());
    assert!((vertical(state) / vertical(start) - 1.0).abs() < 1e-13);
}

#[test]
fn s2_substeps_in_the_place_of_the_published_step() {
    let (stepper, start) = published();
    let remedied = stepper.clone().or_substeps(16);
    let mut state = start;
    let report = remedied.step(&mut state).unwrap();
    assert_eq!(report.remedy, Some(Remedy::Substeps(2)));
    assert_eq!(state.steps(), 1);

    // The replacement is two steps of half the size, to the bit.
    let half = Stepper::new(stepper.scene().clone(), 0.05).unwrap();
    let mut expected = half.start(Motion::looping().attitude, Motion::looping().velocity).unwrap();
    let iterations: u32 = (0..2).map(|_| half.step(&mut expected).unwrap().iterations).sum();
    assert_eq!(report.iterations, iterations);
    assert_eq!(
        (state.attitude(), state.momentum(), state.advected()),
        (expected.attitude(), expected.momentum(), expected.advected())
    );

    for _ in 0..100 {
        remedied.step(&mut state).unwrap();
    }
    assert_eq!(state.steps(), 101);
    assert_kept(&state, &start);
}

/// If no remedy helps, the first error is returned, and the state is unchanged to the bit.
#[test]
fn s2_without_a_remedy_the_state_is_left_alone() {
    let (stepper, start) = published();
    let mut state = start;
    let error = stepper.clone().or_substeps(1).step(&mut state).unwrap_err();
    assert!(matches!(error, StepError::BeyondSolvable { .. }), "{error:?}");
    assert_eq!(format!("{start:?}"), format!("{state:?}"));
}
