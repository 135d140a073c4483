//! Runs that are observed, stopped and watched for events.

use std::cell::RefCell;

use declarations::HeavyTop;
use liestep::motion::{Factor, Integrator, StepReport};
use liestep::prelude::*;
use liestep::recording::{Event, Reason, RunError, RunReport, sections};
use nalgebra::{UnitQuaternion, Vector3};

use crate::one_top::{VELOCITY, top};

#[test]
fn a_run_ends_when_it_is_told_to() {
    let (stepper, start) = top(0.01);
    // The times are whole numbers of steps up to rounding, and times between.
    for (until, steps) in [(0.0, 0), (-1.0, 0), (0.3, 30), (0.07, 7), (0.7, 70), (0.701, 71), (1e-9, 1)] {
        let ended = stepper.observed(&mut start.clone()).until(until).unwrap();
        assert_eq!((ended.steps, ended.reason), (steps, Reason::Done), "until {until}");
    }
    for until in [f64::NAN, f64::INFINITY, 1e300] {
        let error = stepper.observed(&mut start.clone()).until(until).unwrap_err();
        assert!(matches!(error, RunError::End { .. }), "{error}");
    }

    let mut state = start;
    let ended = stepper.observed(&mut state).stop_when(|now| now.momentum().x < -0.5).steps(1000).unwrap();
    let RunReport { steps, reason: Reason::Stopped { time }, iterations } = ended else { panic!("{ended:?}") };
    assert!(state.momentum().x < -0.5 && iterations >= steps);
    assert_eq!((state.steps(), time), (steps, stepper.time(&state)));
    // If the condition holds at the start, no step is made, also in a run that continues.
    for _ in 0..2 {
        let ended = stepper.observed(&mut state).stop_when(|now| now.momentum().x < -0.5).steps(1000).unwrap();
        assert_eq!((ended.steps, ended.reason, state.steps()), (0, Reason::Stopped { time }, steps));
    }
    let ended = stepper.observed(&mut start.clone()).stop_when(|_| true).steps(1000).unwrap();
    assert_eq!((ended.steps, ended.reason), (0, Reason::Stopped { time: 0.0 }));

    // A run backwards.
    let (back, mut state) = top(-0.01);
    let ended = back.observed(&mut state).at([0.0, -0.005, -0.015], |_| ()).until(-0.02).unwrap();
    assert_eq!((ended.steps, back.time(&state)), (2, -0.02));
}

/// Several observers of the ends of steps each receive their own, in a run that continues from step 5.
#[test]
fn each_observer_sees_its_steps() {
    let (stepper, mut state) = top(0.01);
    stepper.run(&mut state, 5).unwrap();
    let (seen, shares) = (RefCell::new(Vec::new()), RefCell::new(Vec::new()));
    let ended = stepper
        .observed(&mut state)
        .every(7, |now| seen.borrow_mut().push((now.steps(), 7)))
        .every(10, |now| seen.borrow_mut().push((now.steps(), 10)))
        .progress(|share| shares.borrow_mut().push(share))
        .steps(300)
        .unwrap();
    assert_eq!((ended.steps, ended.reason, state.steps()), (300, Reason::Done, 305));
    let due = |step: u64| {
        [7, 10].into_iter().filter(move |every| step.is_multiple_of(*every)).map(move |every| (step, every))
    };
    assert_eq!(seen.into_inner(), (6..=305).flat_map(due).collect::<Vec<_>>());
    assert_eq!(shares.into_inner(), (1..=100).map(|share| f64::from(share) / 100.0).collect::<Vec<_>>());
}

/// Observers have no influence on the motion, and are called in order.
#[test]
fn given_times_are_shown_in_order() {
    let (stepper, start) = top(0.01);
    let (mut state, mut alone) = (start, start);
    let times: Vec<f64> = (0..60).map(|frame| f64::from(frame) / 60.0).collect();
    let seen = RefCell::new(Vec::new());
    let shares = RefCell::new(Vec::new());
    let ended = stepper
        .observed(&mut state)
        .at(times.iter().copied(), |now| seen.borrow_mut().push((now.time(), now.attitude())))
        .at([0.02, 0.025], |now| assert_eq!(now.steps(), 2))
        .every(25, |now| seen.borrow_mut().push((now.time(), now.attitude())))
        .every(0, |_| -> () { panic!("never") })
        .progress(|share| shares.borrow_mut().push(share))
        .until(1.0)
        .unwrap();
    stepper.run(&mut alone, 100).unwrap();
    assert_eq!((ended.steps, &state), (100, &alone));
    let seen = seen.into_inner();
    assert!(seen.is_sorted_by(|a, b| a.0 <= b.0));
    assert_eq!(seen.len(), 60 + 5);
    for (time, attitude) in seen {
        let expected = liestep::motion::Integrator::state_at(&stepper, &start, time).unwrap();
        assert!((attitude.as_matrix() - expected.attitude().as_matrix()).norm() < 1e-13, "{time}");
    }
    let expected: Vec<f64> = (1..=100).map(|share| f64::from(share) / 100.0).collect();
    assert_eq!(shares.into_inner(), expected);

    for times in [vec![0.02, 0.01], vec![f64::NAN], vec![-0.1], vec![0.5, f64::NEG_INFINITY]] {
        let error = stepper.observed(&mut start.clone()).at(times, |_| ()).until(1.0).unwrap_err();
        assert!(matches!(error, RunError::Time { .. }), "{error}");
    }
}

/// A requested time at the run's end is shown where rounding has the last step end before it.
#[test]
fn the_end_is_shown_where_it_is_rounded() {
    let (h, end) = (2.0 / 49.0, 2.0);
    assert!(49.0 * h < end);
    let (stepper, mut state) = top(h);
    let seen = RefCell::new(Vec::new());
    let times = [1.0, end, end * (1.0 + 1e-12)];
    stepper
        .observed(&mut state)
        .at(times, |now| seen.borrow_mut().push((now.time(), now.attitude())))
        .until(end)
        .unwrap();
    let seen = seen.into_inner();
    assert_eq!(seen.iter().map(|row| row.0).collect::<Vec<_>>(), [1.0, end]);
    assert_eq!(seen[1].1, state.attitude());
}

/// Events within one step are reported in order, prescribed times included, and the steps stay unchanged.
#[test]
fn events_happen_in_their_order() {
    let (stepper, start) = top(0.05);
    let (mut state, mut alone) = (start, start);
    let seen = RefCell::new(Vec::new());
    let axis = Vector3::x();
    let times = (0..200).map(|k| 0.005 * f64::from(k));
    let normals = [0.0, 0.5, 1.0, 1.5].map(|angle: f64| Vector3::new(angle.cos(), angle.sin(), 0.0));
    let mut run = stepper.observed(&mut state).at(times, |now| seen.borrow_mut().push((now.time(), 9)));
    for (k, (normal, event)) in
        normals.into_iter().zip([Event::rising(), Event::falling(), Event::crossing(), Event::rising()]).enumerate()
    {
        let seen = &seen;
        run = run.event(event, sections::plane(axis, normal), move |now| {
            assert!(now.attitude().as_matrix().column(0).dot(&normal).abs() < 1e-14, "off the plane");
            let rises = now.rising().unwrap();
            assert!(if k == 0 || k == 3 { rises } else { k == 2 || !rises });
            seen.borrow_mut().push((now.time(), k));
        });
    }
    run.until(1.0).unwrap();
    stepper.run(&mut alone, 20).unwrap();
    assert_eq!(state, alone);
    let seen = seen.into_inner();
    assert!(seen.is_sorted_by(|a, b| a.0 <= b.0), "{seen:?}");
    let count = |event| seen.iter().filter(|(_, which)| *which == event).count();
    // The body turns about twice a second, and a crossing in both directions counts twice.
    assert!(count(9) == 200 && (1..4).contains(&count(0)) && count(2).abs_diff(2 * count(1)) < 2, "{seen:?}");
    let events: Vec<_> = seen.iter().filter(|(_, which)| *which != 9).collect();
    let step = |time: f64| (time / 0.05).floor();
    let shared = events.windows(2).any(|pair| step(pair[0].0).total_cmp(&step(pair[1].0)).is_eq());
    assert!(shared, "no two events in a step: {seen:?}");
}

#[test]
fn an_event_may_end_the_run() {
    let (stepper, start) = top(0.01);
    let mut state = start;
    let mut at = Vec::new();
    let ended = stepper
        .observed(&mut state)
        .event(Event::crossing(), |now| now.time() - 0.05, |_| ())
        .event(Event::falling().terminal(), |now| 0.103 - now.time(), |now| at.push(**now))
        .event(Event::rising(), |now| now.time() - 0.109, |_| -> () { panic!("it is later") })
        .every(1, |now| assert!(now.steps() < 11, "the run has ended"))
        .until(1.0)
        .unwrap();
    let Reason::Event { event: 1, time } = ended.reason else { panic!("{ended:?}") };
    assert!((time - 0.103).abs() < 1e-17 && state.steps() == 11, "{time}");
    let expected = liestep::motion::Integrator::state_at(&stepper, &start, 0.103).unwrap();
    assert!((at[0].momentum() - expected.momentum()).norm() < 1e-13);
    // The run then continues without a second report.
    let ended =
        stepper.observed(&mut state).event(Event::crossing(), |now| now.time() - 0.103, |_| -> () { panic!("again") });
    assert_eq!(ended.steps(5).unwrap().reason, Reason::Done);

    // A zero at a step, to the bit, is one crossing; one at the start is none.
    let count = RefCell::new(0);
    stepper
        .observed(&mut start.clone())
        .event(Event::crossing(), |now| now.time() - stepper.step_size() * 7.0, |_| *count.borrow_mut() += 1)
        .event(Event::crossing(), |now| 2.0 * now.time(), |_| -> () { panic!("at the start") })
        .event(
            Event::crossing(),
            |now| (now.time() - stepper.step_size() * 7.0).powi(2),
            |_| -> () { panic!("it touches") },
        )
        .until(0.2)
        .unwrap();
    assert_eq!(count.into_inner(), 1);

    let mut state = start;
    let run = stepper.observed(&mut state).event(Event::rising(), |now| (0.055 - now.time()).sqrt(), |_| ());
    let error = run.until(1.0).unwrap_err();
    assert!(matches!(error, RunError::NotANumber { event: 0, time } if (0.055..0.061).contains(&time)), "{error}");
    // A zero at a step before a NaN isn't a crossing, because the sign after it is unknown; the error names the NaN,
    // with a close inspection or without.
    for event in [Event::crossing(), Event::crossing().curvature(1.0)] {
        let mut state = start;
        let seventh = stepper.step_size() * 7.0;
        let run = stepper.observed(&mut state).event(
            event,
            |now| (seventh - now.time()).sqrt(),
            |_| -> () { panic!("it isn't crossed") },
        );
        let error = run.until(1.0).unwrap_err();
        assert!(matches!(error, RunError::NotANumber { event: 0, time } if (0.07..0.081).contains(&time)), "{error}");
    }
    let flat = |bound| {
        let mut state = start;
        stepper.observed(&mut state).event(Event::rising().curvature(bound), |_| 0.0, |_| ()).until(0.1)
    };
    for bound in [1.0, 1e300, f64::INFINITY, f64::NAN] {
        let error = flat(bound).unwrap_err();
        assert!(matches!(error, RunError::TooManyLooks { event: 0, time: 0.0 }), "{error}");
    }
    assert_eq!(flat(0.0).unwrap().steps, 10);
}

/// An integrator that implements only the required methods.
struct MinimalIntegrator<'a, I>(&'a I);

impl<I: Integrator> Integrator for MinimalIntegrator<'_, I> {
    type Scalar = I::Scalar;
    type Motion = I::Motion;
    type Velocity = I::Velocity;
    type Inertia = I::Inertia;
    type State = I::State;

    fn step(&self, state: &mut I::State) -> Result<StepReport, StepError> {
        self.0.step(state)
    }

    fn run(&self, state: &mut I::State, steps: u64) -> Result<u64, StepError> {
        self.0.run(state, steps)
    }

    fn part(&self, state: &I::State, fraction: I::Scalar) -> Result<I::Motion, StepError> {
        self.0.part(state, fraction)
    }

    fn adopt(&self, motion: &I::Motion) -> I::State {
        self.0.adopt(motion)
    }

    fn steps(motion: &I::Motion) -> u64 {
        I::steps(motion)
    }

    fn step_size(&self) -> I::Scalar {
        self.0.step_size()
    }

    fn velocity(&self, motion: &I::Motion) -> I::Velocity {
        self.0.velocity(motion)
    }

    fn energy(&self, motion: &I::Motion) -> I::Scalar {
        self.0.energy(motion)
    }

    fn factors(&self) -> Vec<Factor> {
        self.0.factors()
    }

    fn inertia(&self) -> I::Inertia {
        self.0.inertia()
    }

    fn write(&self, motion: &I::Motion, inertia: &I::Inertia, attitude: &mut [I::Scalar], row: &mut [f64])
    where
        I::Scalar: Into<f64>,
    {
        self.0.write(motion, inertia, attitude, row);
    }
}

/// The end of a run in stretches, its iterations or its error, and the steps at which it was interrupted.
type RunEnd<M> = (M, Result<u64, StepError>, Vec<u64>);

fn shown<I: Integrator>(integrator: &I, start: &I::State, plan: &[u64]) -> RunEnd<I::Motion> {
    let (mut state, mut calls) = (start.clone(), Vec::new());
    let (first, mut rest) = (plan[0], plan[1..].iter().copied());
    let made = integrator.run_stretches(&mut state, first, &mut |motion, _| {
        calls.push(I::steps(motion));
        rest.next().unwrap_or(0)
    });
    ((*state).clone(), made, calls)
}

/// Stretches inside of the run or call by call: the same bits, iterations, errors and calls, and none without steps.
#[test]
fn runs_are_shown_alike_whatever_steps() {
    let attitude = UnitQuaternion::from_scaled_axis(Vector3::new(1e-3, 0.0, 0.0));
    for h in [0.01, 0.35] {
        let stepper = Stepper::new(HeavyTop::thesis(), h).unwrap();
        let any = stepper.clone().into_any().on_group::<SO3, Vector3<f64>>().unwrap();
        // At the longer step the body falls until it is too fast.
        let velocity = if h < 0.1 { VELOCITY } else { Vector3::zeros() };
        let start = stepper.start(attitude, velocity).unwrap();
        let any_start = any.start(attitude, velocity).unwrap();
        for plan in [[0_u64, 5].as_slice(), &[1], &[4, 4, 1, 3], &[0], &[5, 100, 7]] {
            let (end, made, calls) = shown(&stepper, &start, plan);
            assert_eq!(
                shown(&MinimalIntegrator(&stepper), &start, plan),
                (end, made.clone(), calls.clone()),
                "{plan:?}"
            );
            assert_eq!(shown(&any, &any_start, plan), (end, made.clone(), calls.clone()), "{plan:?}");
            assert_eq!(
                shown(&MinimalIntegrator(&any), &any_start, plan),
                (end, made.clone(), calls.clone()),
                "{plan:?}"
            );
            let (numbers, start) = (any.any(), any.any().start_at(SO3::from(attitude), velocity).unwrap());
            for (reached, spent, interrupted) in
                [shown(numbers, &start, plan), shown(&MinimalIntegrator(numbers), &start, plan)]
            {
                assert_eq!((spent, interrupted), (made.clone(), calls.clone()), "{plan:?}");
                assert_eq!(Vector3::from_column_slice(reached.momentum()), end.momentum(), "{plan:?}");
                assert_eq!(reached.steps(), end.steps(), "{plan:?}");
            }
            assert_eq!(calls.is_empty(), plan[0] == 0 || (h > 0.1 && plan[0] > end.steps()), "{plan:?}");
            assert_eq!(made.is_err(), h > 0.1 && plan.contains(&100), "{plan:?}");
        }
    }
}
