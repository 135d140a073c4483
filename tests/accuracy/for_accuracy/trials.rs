//! The cost of the trial runs of a choice by accuracy, and the ends of these runs.

use core::ops::Add;

use super::*;

/// A body with a slow rotor, which can't be split, so that only its own steps are available.
fn spun<B: Add<Rotor>>(body: B) -> B::Output {
    body + Rotor { spin: Vector3::x() * 1e-3 }
}

/// Trials are counted in operations, so the bound holds on any machine. Runs have one step to thousands.
#[test]
fn trials_cost_at_most_sixty_runs_and_half_of_them_twenty() {
    let mut all = Vec::new();
    for (name, horizon) in MOTIONS.iter().flat_map(|name| [0.03, 0.1, 0.3, 1.0, 3.0, 10.0].map(|t| (name, t))) {
        let motion = Motion::read(name);
        for tolerance in [3e-2, 1e-3, 1e-6, 1e-9, 1e-11] {
            let accuracy = Accuracy { tolerance, horizon };
            for stepper in [ask(&motion, accuracy).unwrap(), ask_coupled(&motion, accuracy).unwrap()] {
                let choice = stepper.choice();
                assert!(choice.trials <= 60.0, "{name}\n{choice}");
                all.push((choice.trials, choice.steps));
            }
        }
    }
    let median = |mut trials: Vec<f64>| {
        trials.sort_by(f64::total_cmp);
        trials[trials.len() / 2]
    };
    let (short, ordinary): (Vec<_>, Vec<_>) = all.into_iter().partition(|(_, steps)| *steps <= 30);
    for runs in [short, ordinary] {
        assert!(runs.len() > 40, "{}", runs.len());
        let median = median(runs.into_iter().map(|(trials, _)| trials).collect());
        assert!(median <= 20.0, "{median}");
    }
}

/// If longer steps would be accurate enough but have no solution, the longest solvable step is chosen.
#[test]
fn steps_too_long_to_be_solved_end_the_search_for_longer_ones() {
    let motion = Motion::read("chaotic");
    let accuracy = Accuracy { tolerance: 0.05, horizon: 30.0 };
    let stepper = ask(&motion, accuracy).unwrap();
    // A search for a finer reference would take thousands of runs.
    assert!(stepper.choice().trials <= 60.0, "{}", stepper.choice());
}

/// A spin of more than a turn in the shortest tried step, each of which has a solution: no two trials agree, and
/// rounding isn't the cause.
#[test]
fn steps_too_long_for_the_motion_are_not_taken_for_rounding() {
    let body = CayleyBody { J: Inertia::from_principal_moments(Vector3::new(1.0, 1.0, 1.0)).unwrap() };
    let accuracy = Accuracy { tolerance: 1e-3, horizon: 1000.0 };
    let refusal = Stepper::for_accuracy(spun(body), accuracy, SO3::identity(), Vector3::z() * 1e5).unwrap_err();
    let AccuracyError::TooManySteps { steps, is_bound: false, .. } = &refusal else { panic!("{refusal}") };
    assert!(*steps > 1e6 && steps.is_finite(), "{refusal}");
    assert!(refusal.to_string().starts_with("about "), "{refusal}");
}

/// The spin of a body whose long steps have no solution, which isn't the cause of the refusal. Among the trials of the
/// shortest part only the last is solvable.
#[test]
fn long_steps_without_a_solution_are_not_the_cause() {
    let body = RigidBody { J_d: NonstandardInertia::from_diagonal(Vector3::new(1.0, 1.5, 2.0)).unwrap() };
    let accuracy = Accuracy { tolerance: 1e-3, horizon: 1000.0 };
    let velocity = Vector3::z() * (0.8 * 8.0_f64.powi(20) / accuracy.horizon);
    let refusal = Stepper::for_accuracy(spun(body), accuracy, SO3::identity(), velocity).unwrap_err();
    let AccuracyError::TooManySteps { steps, is_bound: true, method, .. } = &refusal else { panic!("{refusal}") };
    assert!(*steps > 1e17 && method == "step", "{refusal}");
    assert!(refusal.to_string().starts_with("at least 1e18 steps of the method `step`"), "{refusal}");
}

/// The step of order 2 underflows a double in so short a time, while a composition takes longer ones.
#[test]
fn a_set_up_that_fails_for_shorter_steps_is_not_the_end() {
    let body = CayleyBody { J: Inertia::from_principal_moments(Vector3::new(1.0, 2.0, 2.5)).unwrap() };
    let (horizon, velocity) = (1e-98, Vector3::new(0.3e98, 0.5e98, 0.8e98));
    let accuracy = Accuracy { tolerance: 1e-12, horizon };
    assert!(matches!(Stepper::new(body, horizon / 1e6), Err(SetupError::InvalidStep { .. })));
    let stepper = Stepper::for_accuracy(spun(body), accuracy, SO3::identity(), velocity).unwrap();
    assert!(stepper.choice().error <= 1e-12, "{}", stepper.choice());
}

/// Trials end after a bounded number of operations, some seconds, for every request, and an error reports their number.
#[test]
fn hostile_scenes_are_refused_soon() {
    let motion = Motion::read("chaotic");
    let mut answered = 0;
    for (gravity, horizon) in [(1e6, 10.0), (1e8, 10.0), (1e8, 1e4), (1e12, 1e9), (9.81, 1e9)] {
        let mut top = motion.top.clone();
        top.g = gravity;
        let accuracy = Accuracy { tolerance: 1e-6, horizon };
        let operations = match Stepper::for_accuracy(top, accuracy, motion.attitude, motion.velocity) {
            Ok(_) => {
                answered += 1;
                0.0
            }
            Err(AccuracyError::Unreachable { trials, .. } | AccuracyError::TooManySteps { trials, .. }) => {
                assert!(trials.runs > 10 && trials.most_steps > 0.0, "{trials:?}");
                trials.operations
            }
            Err(other) => panic!("{other}"),
        };
        assert!(operations < 1.5e9, "{gravity} {horizon}: {operations:e}");
    }
    assert_eq!(answered, 0);
}
