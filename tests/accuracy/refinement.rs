//! The public functions `convergence` and `work_precision`, and their tables.

use std::time::Duration;

use declarations::{HeavyTop, Motion};
use liestep::accuracy::End;
use liestep::prelude::*;
use liestep::{SetupError, StepError};
use liestep_refinement::{Effort, Measurement, Reference, Refinement, RefinementError, convergence, work_precision};
use workbench::measure::relative;

type TopRun = (Stepper<HeavyTop>, State<SO3, Vector3<f64>>);

fn looping() -> impl Fn(f64) -> Result<TopRun, SetupError> {
    let motion = Motion::looping();
    move |h| {
        let stepper = Stepper::new(motion.top.clone(), h)?;
        let start = stepper.start(motion.attitude, motion.velocity)?;
        Ok((stepper, start))
    }
}

fn known(t: f64) -> Reference<SO3> {
    let (attitude, velocity) = Motion::looping().at(t);
    Reference::End(End { attitude: SO3::try_from(attitude).unwrap(), velocity })
}

/// The errors of the table, by an independent loop.
#[test]
fn errors_are_those_of_a_loop_by_hand() {
    let motion = Motion::looping();
    let (attitude, velocity) = motion.at(1.0);
    let table = convergence(looping(), 1.0, [400, 100, 200, 200], known(1.0)).unwrap();
    let mut steps = [0.01, 0.005, 0.0025].into_iter();
    for row in table.rows() {
        assert_eq!(Some(row.step), steps.next());
        let stepper = Stepper::new(motion.top.clone(), row.step).unwrap();
        let mut state = stepper.start(motion.attitude, motion.velocity).unwrap();
        while stepper.time(&state) < 1.0 - 1e-9 {
            stepper.step(&mut state).unwrap();
        }
        let apart = (stepper.velocity(&state) - velocity).norm();
        let scale = velocity.norm().max(motion.velocity.norm());
        let expected = relative(state.attitude().as_matrix(), &attitude).hypot(apart / scale);
        assert!((row.error / expected - 1.0).abs() < 1e-12, "{} instead of {expected}", row.error);
        assert!(row.iterations.is_some_and(|iterations| (1.0..4.0).contains(&iterations)));
        assert_eq!(row.seconds, None);
    }
    assert_eq!(steps.next(), None);
    assert!(table.orders().all(|order| (order - 2.0).abs() < 0.01), "{table}");
    // Three points are too few for a fit.
    assert_eq!(table.order_above(0.0), None);
}

/// The errors relative to the finest run are those against the truth, up to the error of that run.
#[test]
fn the_finest_run_serves_as_a_reference() {
    let truth = convergence(looping(), 1.0, [100, 200], known(1.0)).unwrap();
    let own = convergence(looping(), 1.0, [100, 200, 800], Reference::Finest).unwrap();
    assert_eq!(own.rows().len(), 2);
    for ((truth, own), part) in truth.rows().iter().zip(own.rows()).zip([1.0 / 64.0, 1.0 / 16.0]) {
        assert!((own.error / truth.error - (1.0 - part)).abs() < 0.01, "{} {}", own.error, truth.error);
    }
}

#[test]
fn what_has_no_answer_is_a_typed_error() {
    for time in [0.0, f64::NAN, f64::INFINITY] {
        let refused = convergence(looping(), time, [10], known(1.0)).unwrap_err();
        assert!(matches!(refused, RefinementError::Time { .. }), "{refused}");
    }
    for (counts, reference) in [(vec![], known(1.0)), (vec![0, 10], known(1.0)), (vec![10], Reference::Finest)] {
        assert_eq!(convergence(looping(), 1.0, counts, reference).unwrap_err(), RefinementError::NoSteps);
    }
    // A constructor that ignores its step is refused.
    let deaf = |_| looping()(0.01);
    let refused = convergence(deaf, 1.0, [100, 200], known(1.0)).unwrap_err();
    assert_eq!(refused, RefinementError::OtherStep { asked: 0.005, found: 0.01 });
    // A step beyond the quarter turn is refused.
    let refused = convergence(looping(), 1.0, [2, 100], known(1.0)).unwrap_err();
    let RefinementError::Step { step: 0.5, cause: StepError::BeyondSolvable { .. } } = refused else {
        panic!("{refused}")
    };
    let nowhere = Reference::End(End { attitude: SO3::identity(), velocity: Vector3::new(f64::NAN, 0.0, 0.0) });
    let refused = convergence(looping(), 1.0, [100], nowhere).unwrap_err();
    assert_eq!(refused, RefinementError::NonFinite { step: 0.01 });
    let nothing = |h| Stepper::new(HeavyTop { m: f64::NAN, ..Motion::looping().top }, h).and_then(|_| looping()(h));
    let refused = convergence(nothing, 1.0, [100], known(1.0)).unwrap_err();
    assert!(matches!(refused, RefinementError::Setup { step: 0.01, .. }), "{refused}");
    // A negative duration is valid.
    let back = convergence(looping(), -1.0, [100, 200, 400, 800, 6400], Reference::Finest).unwrap();
    assert!((back.order_above(0.0).unwrap() - 2.0).abs() < 0.05, "{back}");
}

const BRIEF: Effort = Effort { longest: 10.0, repeated: Duration::ZERO };

#[test]
fn work_leaves_out_what_fails_and_says_why_all_did() {
    let table = work_precision(looping(), 1.0, [2, 100, 200, 400, 800], known(1.0), BRIEF).unwrap();
    let plain = convergence(looping(), 1.0, [100, 200, 400, 800], known(1.0)).unwrap();
    let errors = |table: &Refinement| table.rows().iter().map(|row| row.error).collect::<Vec<_>>();
    assert_eq!(errors(&table), errors(&plain));
    assert!(table.rows().iter().all(|row| row.seconds > Some(0.0)));
    let refused = work_precision(looping(), 1.0, [1, 2], known(1.0), BRIEF).unwrap_err();
    assert!(matches!(refused, RefinementError::Step { step: 0.5, .. }), "{refused}");
    // The limit of zero admits only the first run.
    let short = Effort { longest: 0.0, ..BRIEF };
    assert_eq!(work_precision(looping(), 1.0, [100, 200, 400], known(1.0), short).unwrap().rows().len(), 1);
}

#[test]
fn shorter_steps_end_where_errors_stop_falling() {
    // An error of order 4 above a floor of 2e-13.
    let error = |h: f64| h.powi(4).max(2e-13);
    let steps = || (0..40).map(|k| 0.5_f64.powi(k));
    let table = Refinement::timed(steps(), BRIEF, |h| Some(move || Some(error(h))), |error: &f64| *error);
    // At h = 1 the error is 1, which is another motion; the floor begins at the twelfth, and three more confirm it.
    assert_eq!(table.rows().first().map(|row| row.step), Some(0.5));
    assert_eq!(table.rows().len(), 11 + 3);
    // The table leaves out runs that fail, as every second one does here.
    let mut fails = false;
    let half = Refinement::timed(
        steps().take(9),
        BRIEF,
        |h| {
            fails = !fails;
            (!fails).then_some(move || Some(error(h)))
        },
        |error: &f64| *error,
    );
    assert_eq!(half.rows().len(), 4);
}

/// A first run that ends in NaN isn't the best one: later runs stay in the curve.
#[test]
fn runs_that_end_in_nan_are_no_plateau() {
    let errors = [f64::NAN, 4e-11, 3e-11, 2e-11, 1e-11, 9e-12];
    let mut errors_in_turn = errors.into_iter();
    let table = Refinement::timed(
        (0..6).map(|k| 0.5_f64.powi(k)),
        BRIEF,
        |_| errors_in_turn.next().map(|error| move || Some(error)),
        |error: &f64| *error,
    );
    assert_eq!(table.rows().iter().map(|row| row.error).collect::<Vec<_>>(), errors[1..]);
}

/// The number of repetitions is bounded for every request, and a failure ends them at once.
#[test]
fn repetitions_are_bounded_and_end_with_a_failure() {
    let endless = Effort { repeated: Duration::MAX, ..BRIEF };
    let mut runs = 0;
    let fine = endless.time(|| {
        runs += 1;
        Ok::<_, ()>(runs)
    });
    assert!(fine.is_ok_and(|(last, _)| last == 1000), "{fine:?}");
    let mut runs = 0;
    let failed = endless.time(|| {
        runs += 1;
        if runs < 3 { Ok(()) } else { Err(runs) }
    });
    assert_eq!(failed.unwrap_err(), 3);
}

/// A coarse run that can't be constructed or ends in NaN is left out of the table; if no run remains, the error says
/// why.
#[test]
fn work_leaves_out_steps_that_are_refused_and_ends_that_are_not_finite() {
    let refuses = |h: f64| {
        if h > 0.015 { Stepper::new(Motion::looping().top, f64::NAN).and_then(|_| looping()(h)) } else { looping()(h) }
    };
    let table = work_precision(refuses, 1.0, [50, 100, 200], known(1.0), BRIEF).unwrap();
    assert_eq!(table.rows().iter().map(|row| row.step).collect::<Vec<_>>(), [0.01, 0.005]);
    let refused = work_precision(refuses, 1.0, [25, 50], known(1.0), BRIEF).unwrap_err();
    assert!(matches!(refused, RefinementError::Setup { step: 0.02, .. }), "{refused}");
    let nowhere = Reference::End(End { attitude: SO3::identity(), velocity: Vector3::new(f64::NAN, 0.0, 0.0) });
    let refused = work_precision(looping(), 1.0, [100, 200], nowhere, BRIEF).unwrap_err();
    assert_eq!(refused, RefinementError::NonFinite { step: 0.005 });
    // A reference of another motion is refused.
    let spun = Reference::End(End { attitude: SO3::identity(), velocity: Vector3::new(1e3, 0.0, 0.0) });
    let refused = work_precision(looping(), 1.0, [100, 200], spun, BRIEF).unwrap_err();
    assert!(matches!(refused, RefinementError::OtherMotion { least } if least >= 0.5), "{refused}");
    // A closure that ignores its step isn't a coarse step.
    let refused = work_precision(|_| looping()(0.01), 1.0, [100, 200], known(1.0), BRIEF).unwrap_err();
    assert_eq!(refused, RefinementError::OtherStep { asked: 0.005, found: 0.01 });
}

/// For a power law the time to any error is known.
#[test]
fn the_time_to_an_error_is_read_off_straight_lines() {
    let row = |h: f64| Measurement { step: h, error: 1e-3 * h * h, iterations: None, seconds: Some(2e-3 / h) };
    let table: Refinement = [1.0, 0.5, 0.25].map(row).into_iter().collect();
    // The time is read at the runs, half way between two of them in both logarithms, and beyond the table.
    assert_eq!(table.seconds_to(1e-3), Some(2e-3));
    assert_eq!(table.seconds_to(1.0), Some(2e-3));
    let between = table.seconds_to(1e-3 / 2.0).unwrap();
    assert!((between / (2e-3 * 2_f64.sqrt()) - 1.0).abs() < 1e-12, "{between}");
    assert_eq!(table.seconds_to(1e-5), None);
    assert_eq!(Refinement::of([(0.1, 1e-9)]).seconds_to(1e-3), None);
}

/// A slope is a finite number or `None`.
#[test]
fn the_order_is_read_off_finite_errors_above_zero() {
    let halvings = [0.4, 0.2, 0.1, 0.05];
    let squares = Refinement::of(halvings.map(|h| (h, h * h)));
    assert!((squares.order_above(0.0).unwrap() - 2.0).abs() < 1e-12);
    for odd in [f64::INFINITY, f64::NAN, 0.0] {
        // A row with such a number beside four others doesn't count; in place of one of these it leaves too few.
        let with = |first| Refinement::of([first].into_iter().chain(halvings.map(|h| (h, h * h))));
        assert_eq!(with((0.8, odd)).order_above(-1.0), squares.order_above(0.0));
        assert_eq!(with((odd, 0.7)).order_above(-1.0), squares.order_above(0.0));
        let instead = halvings.iter().enumerate().map(|(place, h)| (*h, if place == 2 { odd } else { h * h }));
        assert_eq!(Refinement::of(instead).order_above(-1.0), None);
    }
    assert_eq!(Refinement::of([1e-1, 1e-2, 1e-3, 1e-4].map(|error| (0.1, error))).order_above(0.0), None);
}

#[test]
fn the_texts_have_the_numbers_to_the_bit() {
    let table = work_precision(looping(), 1.0, [100, 200, 400], known(1.0), BRIEF).unwrap();
    let csv = table.to_csv();
    let mut lines = csv.lines();
    assert_eq!(lines.next(), Some("step,error,ratio,order,iterations,seconds"));
    for (line, row) in lines.zip(table.rows()) {
        let cells: Vec<Option<f64>> = line.split(',').map(|cell| cell.parse().ok()).collect();
        assert_eq!(
            [cells[0], cells[1], cells[4], cells[5]],
            [Some(row.step), Some(row.error), row.iterations, row.seconds]
        );
    }
    assert_eq!(csv.lines().count(), 4);
    // The first run has no row before it.
    assert_eq!(csv.lines().nth(1).unwrap().split(',').skip(2).take(2).collect::<Vec<_>>(), ["", ""]);

    let json: serde_json::Value = serde_json::from_str(&table.to_json()).unwrap();
    assert_eq!(json, serde_json::to_value(&table).unwrap());
    assert_eq!(json[2]["error"].as_f64(), Some(table.rows()[2].error));
    assert_eq!(json[2]["order"].as_f64(), table.orders().nth(1));
    assert!(json[0]["order"].is_null());

    // An error of zero has an infinite order.
    let odd = Refinement::of([(0.1, 1.0), (0.05, 0.0), (0.025, f64::NAN)]);
    let json: serde_json::Value = serde_json::from_str(&odd.to_json()).unwrap();
    assert!(json[1]["ratio"].is_null() && json[2]["error"].is_null() && json[0]["seconds"].is_null());
    assert_eq!(json, serde_json::to_value(&odd).unwrap());
    assert_eq!(
        odd.to_csv(),
        "step,error,ratio,order,iterations,seconds\n0.1,1.0,,,,\n0.05,0.0,inf,inf,,\n0.025,NaN,NaN,NaN,,\n"
    );
}

#[test]
fn a_table_shows_the_columns_that_there_are() {
    let plain = Refinement::of([(0.1, 4e-2), (0.05, 1e-2)]).to_string();
    let expected = [
        "      h, s     error     ratio     order",
        "  1.000e-1   4.00e-2         –         –",
        "  5.000e-2   1.00e-2      4.00      2.00",
    ];
    assert_eq!(plain.lines().collect::<Vec<_>>(), expected);
    // Columns stay separate even for long numbers.
    let full = Refinement::of([(1e-100, 1e100), (1e-101, 1e-100)]).to_string();
    assert_eq!(full.lines().nth(2).unwrap().split_whitespace().count(), 4, "{full}");
    assert_eq!(Refinement::default().to_string(), "      h, s     error");
    assert_eq!(Refinement::default().to_json(), "[]");
}
