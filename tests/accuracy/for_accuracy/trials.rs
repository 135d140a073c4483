//! What the trials of a choice cost, where they end, and what a saved choice spares.

use super::*;

/// Trials are counted in operations, so the bound holds on any machine. Runs are of one step and of thousands.
#[test]
fn trials_cost_at_most_thirty_runs_and_half_of_them_ten() {
    let mut all = Vec::new();
    for (name, horizon) in MOTIONS.iter().flat_map(|name| [0.03, 0.1, 0.3, 1.0, 3.0, 10.0].map(|t| (name, t))) {
        let motion = Motion::read(name);
        for tolerance in [3e-2, 1e-3, 1e-6, 1e-9, 1e-11] {
            let accuracy = Accuracy { tolerance, horizon };
            let own = Stepper::for_accuracy(motion.top.clone(), accuracy, motion.attitude, motion.velocity);
            let of_body = of_body(&motion).for_accuracy(accuracy, motion.attitude, motion.velocity);
            for stepper in [own.unwrap(), of_body.unwrap()] {
                let choice = stepper.choice();
                assert!(choice.trials <= 30.0, "{name}\n{choice}");
                all.push((choice.trials, choice.steps));
            }
        }
    }
    let median = |mut trials: Vec<f64>| {
        trials.sort_by(f64::total_cmp);
        trials[trials.len() / 2]
    };
    let (short, ordinary): (Vec<_>, Vec<_>) = all.into_iter().partition(|(_, steps)| *steps <= 60);
    for runs in [short, ordinary] {
        assert!(runs.len() > 40, "{}", runs.len());
        let median = median(runs.into_iter().map(|(trials, _)| trials).collect());
        assert!(median <= 10.0, "{median}");
    }
}

/// A run whose error leaves room for longer steps, which have no solution, is chosen as it is.
#[test]
fn steps_too_long_to_be_solved_end_the_search_for_longer_ones() {
    let motion = Motion::read("chaotic");
    let accuracy = Accuracy { tolerance: 0.05, horizon: 30.0 };
    let stepper = all(&motion).for_accuracy(accuracy, motion.attitude, motion.velocity).unwrap();
    // A search that goes on to a finer reference takes thousands of runs.
    assert!(stepper.choice().trials <= 30.0, "{}", stepper.choice());
}

/// A spin of more than a turn in the shortest step that is tried, each of which has a solution: no two trials agree,
/// and rounding has no part in that. (No composition is of a method of order 8, so that one method is tried.)
#[test]
fn steps_too_long_for_the_motion_are_not_taken_for_rounding() {
    let body = CayleyBody { J: Inertia::from_principal_moments(Vector3::new(1.0, 1.0, 1.0)).unwrap() };
    let accuracy = Accuracy { tolerance: 1e-3, horizon: 1000.0 };
    let refusal = Candidates::of(body, 8).for_accuracy(accuracy, SO3::identity(), Vector3::z() * 1e5).unwrap_err();
    let AccuracyError::TooManySteps { steps, is_bound: false, method, .. } = &refusal else { panic!("{refusal}") };
    assert!(*steps > 1e6 && steps.is_finite() && method == "its own step", "{refusal}");
    assert!(refusal.to_string().starts_with("about "), "{refusal}");
}

/// The same of a body whose long steps have no solution: that they fail isn't why. Of the shortest part's trials only
/// the last has one.
#[test]
fn long_steps_without_a_solution_are_not_the_cause() {
    let body = RigidBody { J_d: NonstandardInertia::from_diagonal(Vector3::new(1.0, 1.5, 2.0)).unwrap() };
    let accuracy = Accuracy { tolerance: 1e-3, horizon: 1000.0 };
    let velocity = Vector3::z() * (0.8 * 8.0_f64.powi(20) / accuracy.horizon);
    let refusal = Candidates::of(body, 8).for_accuracy(accuracy, SO3::identity(), velocity).unwrap_err();
    let AccuracyError::TooManySteps { steps, is_bound: true, method, .. } = &refusal else { panic!("{refusal}") };
    assert!(*steps > 1e17 && method == "its own step", "{refusal}");
    assert!(refusal.to_string().starts_with("at least 1e18 steps of the method `its own step`"), "{refusal}");
}

/// In so short a time the steps that the accuracy takes are too short for a double.
#[test]
fn a_set_up_that_fails_for_shorter_steps_is_the_error() {
    let body = CayleyBody { J: Inertia::from_principal_moments(Vector3::new(1.0, 2.0, 2.5)).unwrap() };
    let (horizon, velocity) = (1e-98, Vector3::new(0.3e98, 0.5e98, 0.8e98));
    let accuracy = Accuracy { tolerance: 1e-12, horizon };
    let refusal = Candidates::of(body, 8).for_accuracy(accuracy, SO3::identity(), velocity).unwrap_err();
    assert!(matches!(refusal, AccuracyError::Setup(SetupError::InvalidStep { .. })), "{refusal}");
}

#[test]
fn a_saved_choice_is_looked_at_once() {
    let motion = Motion::read("chaotic");
    let ask = |candidates: Candidates<SO3, Vector3<f64>>, accuracy, velocity| {
        candidates.for_accuracy(accuracy, motion.attitude, velocity).unwrap()
    };
    let accuracy = Accuracy { tolerance: 1e-7, horizon: 10.0 };
    let first = ask(of_body(&motion), accuracy, motion.velocity);
    let saved = first.choice().saved();
    let text = serde_json::to_string(&saved).unwrap();
    let saved: SavedChoice = serde_json::from_str(&text).unwrap();
    let again = ask(of_body(&motion).with_saved(saved.clone()), accuracy, motion.velocity);
    assert_eq!((again.choice().saved(), end(&again)), (saved.clone(), end(&first)));
    assert!(again.choice().trials < 3.0 && again.choice().error <= 1e-7, "{}", again.choice());
    // What is said of the error is of the size of the true one.
    let true_error = error(&end(&again), &motion.at(10.0), &motion.velocity, 10.0);
    assert!((again.choice().error / true_error - 1.0).abs() < 0.2, "{} {true_error}", again.choice());
    // Another start and horizon, for which it still does, as a search for a thousandth of the error shows.
    let (accuracy, velocity) = (Accuracy { tolerance: 1e-6, horizon: 9.0 }, motion.velocity * 0.9);
    let elsewhere = ask(of_body(&motion).with_saved(saved.clone()), accuracy, velocity);
    let finer = ask(of_body(&motion), Accuracy { tolerance: 1e-9, ..accuracy }, velocity);
    assert!(elsewhere.choice().trials < 3.0, "{}", elsewhere.choice());
    assert!(error(&end(&elsewhere), &end(&finer), &velocity, 9.0) <= 1e-6, "{}", elsewhere.choice());
    assert!(elsewhere.choice().saved().step <= saved.step * (1.0 + 1e-9));
    // One for which it doesn't is searched for, and its two runs, by fewer steps than are taken then, are counted.
    let accuracy = Accuracy { tolerance: 1e-10, horizon: 10.0 };
    let searched = ask(of_body(&motion), accuracy, motion.velocity);
    let found = ask(of_body(&motion).with_saved(saved.clone()), accuracy, motion.velocity);
    assert_eq!((found.choice().saved(), end(&found)), (searched.choice().saved(), end(&searched)));
    let besides = found.choice().trials - searched.choice().trials;
    assert!(besides > 0.1 && besides < 2.5, "{besides}");
    // Those that say nothing take no run.
    let nameless = SavedChoice { method: "another".to_owned(), ..saved.clone() };
    let steps = [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-300].map(|step| SavedChoice { step, ..saved.clone() });
    for wrong in core::iter::once(nameless).chain(steps) {
        let found = ask(of_body(&motion).with_saved(wrong), accuracy, motion.velocity);
        assert_eq!(found.choice(), searched.choice());
    }
}

/// Where one step is enough, too.
#[test]
fn bounds_of_methods_that_were_not_tried_are_below_what_they_cost() {
    let mut compared = 0;
    for name in MOTIONS {
        let motion = Motion::read(name);
        for (tolerance, horizon) in [(3e-2, 0.03), (1e-3, 0.1), (1e-6, 1.0)] {
            let ask = |candidates: Candidates<SO3, Vector3<f64>>| {
                candidates.for_accuracy(Accuracy { tolerance, horizon }, motion.attitude, motion.velocity).unwrap()
            };
            let searched = ask(of_body(&motion));
            let again = ask(of_body(&motion).with_saved(searched.choice().saved()));
            for (known, bound) in searched.choice().offers().iter().zip(again.choice().offers()) {
                if bound.is_bound && !known.is_bound {
                    let is_below = bound.cost <= known.cost * (1.0 + 1e-12);
                    assert!(is_below, "{name} {}\n{}", again.choice(), searched.choice());
                    compared += 1;
                }
            }
        }
    }
    assert!(compared > 30, "{compared}");
}

/// Trials end after so many operations, some seconds, whatever is asked, and an error says how many were made.
#[test]
fn hostile_scenes_are_refused_soon() {
    let motion = Motion::read("chaotic");
    let mut answered = 0;
    for (gravity, horizon) in [(1e6, 10.0), (1e8, 10.0), (1e8, 1e4), (1e12, 1e9), (9.81, 1e9)] {
        let mut top = motion.top.clone();
        top.g = gravity;
        let accuracy = Accuracy { tolerance: 1e-6, horizon };
        for candidates in [Candidates::of(top.clone(), 2), Candidates::of_body(top, 2)] {
            let operations = match candidates.for_accuracy(accuracy, motion.attitude, motion.velocity) {
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
    }
    assert_eq!(answered, 0);
}
