//! Runs that are recorded and stopped, whatever is asked of them.

use std::cell::RefCell;
use std::io::{self, Write};
use std::ops::ControlFlow;
use std::rc::Rc;

use declarations::{HeavyTop, SlidingTop, TetheredPlate};
use liestep::effects::{Drag, RigidBody};
use liestep::groups::{LieGroup, SE2};
use liestep::mechanics::Sum;
use liestep::methods::CotangentGauss;
use liestep::motion::{AnyStepper, Integrator, Moment, Motion, ScalarIn, StepReport};
use liestep::numbers::Entries as _;
use liestep::prelude::*;
use liestep::with::{
    Background, Column, Csv, Ended, Event, Reason, RecordError, Recorder, RunError, Sink, SinkError, Table, sections,
};
use nalgebra::{UnitQuaternion, Vector3};

const VELOCITY: Vector3<f64> = Vector3::new(0.5, 2.0, 12.0);

type Top = AnyStepper<SO3, Vector3<f64>>;
type TopState = liestep::motion::AnyState<SO3, Vector3<f64>>;

/// One type of stepper for nearly all of what is asked here.
fn top(h: f64) -> (Top, TopState) {
    let stepper = Stepper::new(HeavyTop::thesis(), h).unwrap().into_any();
    let state = stepper.start(UnitQuaternion::from_scaled_axis(Vector3::new(0.8, 0.0, 0.0)), VELOCITY).unwrap();
    (stepper, state)
}

fn csv_of(stepper: &Top, state: &mut TopState, every: u64, until: f64) -> String {
    let mut recorder = Recorder::new(stepper, Csv::new(Vec::new()));
    stepper.observed(state).every(every, |now| recorder.record(now)).until(until).unwrap();
    String::from_utf8(recorder.finish().unwrap().into_inner().unwrap()).unwrap()
}

/// Each number is read back to the bit, and the numbers are those of the motion.
#[test]
fn a_file_has_every_bit() {
    let (stepper, start) = top(0.01);
    let text = csv_of(&stepper, &mut start.clone(), 10, 1.0);
    let mut lines = text.lines();
    assert_eq!(
        lines.next().unwrap(),
        "t,q_w,q_x,q_y,q_z,velocity_x,velocity_y,velocity_z,momentum_x,momentum_y,momentum_z,energy,defect"
    );
    let mut state = start;
    for line in lines.by_ref() {
        let row: Vec<f64> = line.split(',').map(|number| number.parse().unwrap()).collect();
        let (velocity, momentum) = (stepper.velocity(&state), state.momentum());
        let mut expected = vec![stepper.time(&state)];
        expected.extend(&row[1..5]);
        expected.extend(velocity.iter().chain(&momentum));
        expected.extend([stepper.energy(&state), state.orthogonality_defect()]);
        assert_eq!(row, expected);
        let quaternion = nalgebra::Quaternion::new(row[1], row[2], row[3], row[4]);
        let attitude = UnitQuaternion::new_unchecked(quaternion).to_rotation_matrix();
        assert!((attitude.matrix() - state.attitude().as_matrix()).norm() < 1e-14);
        stepper.run(&mut state, 10).unwrap();
    }
    assert_eq!((text.lines().count(), state.steps()), (12, 110));
}

/// A run in two parts writes what one run does, and so does a thread of its own.
#[test]
fn a_run_may_be_made_in_parts() {
    let (stepper, mut state) = top(0.01);
    let whole = csv_of(&stepper, &mut state.clone(), 10, 2.0);
    let mut recorder = Recorder::new(&stepper, Background::new(Csv::new(Vec::new()))).in_blocks_of(3);
    for until in [0.555, 0.555, 0.3, 1.2, 2.0] {
        stepper.observed(&mut state).every(10, |now| recorder.record(now)).until(until).unwrap();
        assert!(stepper.time(&state) > until - 1e-12);
    }
    let sink = recorder.finish().unwrap().into_inner().unwrap();
    assert_eq!(String::from_utf8(sink.into_inner().unwrap()).unwrap(), whole);
}

#[test]
fn a_run_ends_when_it_is_told_to() {
    let (stepper, start) = top(0.01);
    // Whole numbers of steps, but for rounding, and what lies between.
    for (until, steps) in [(0.0, 0), (-1.0, 0), (0.3, 30), (0.07, 7), (0.7, 70), (0.701, 71), (1e-9, 1)] {
        let ended = stepper.observed(&mut start.clone()).until(until).unwrap();
        assert_eq!((ended.steps, ended.reason), (steps, Reason::Done), "until {until}");
    }
    for until in [f64::NAN, f64::INFINITY, 1e300] {
        let error = stepper.observed(&mut start.clone()).until(until).unwrap_err();
        assert!(matches!(error, RunError::End { .. }), "{error}");
    }

    let mut state = start.clone();
    let ended = stepper.observed(&mut state).stop_when(|now| now.momentum().x < -0.5).steps(1000).unwrap();
    let Ended { steps, reason: Reason::Stopped { time }, iterations } = ended else { panic!("{ended:?}") };
    assert!(state.momentum().x < -0.5 && iterations >= steps);
    assert_eq!((state.steps(), time), (steps, stepper.time(&state)));
    // Where it is so at the start, no step is made, of a run that goes on neither.
    for _ in 0..2 {
        let ended = stepper.observed(&mut state).stop_when(|now| now.momentum().x < -0.5).steps(1000).unwrap();
        assert_eq!((ended.steps, ended.reason, state.steps()), (0, Reason::Stopped { time }, steps));
    }
    let ended = stepper.observed(&mut start.clone()).stop_when(|_| true).steps(1000).unwrap();
    assert_eq!((ended.steps, ended.reason), (0, Reason::Stopped { time: 0.0 }));

    // Backwards.
    let (back, mut state) = top(-0.01);
    let ended = back.observed(&mut state).at([0.0, -0.005, -0.015], |_| ()).until(-0.02).unwrap();
    assert_eq!((ended.steps, back.time(&state)), (2, -0.02));
}

/// Several who look at the ends of steps are shown each its own, of a run that goes on from step 5.
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

/// What observers see has no influence, and is seen in order.
#[test]
fn given_times_are_shown_in_order() {
    let (stepper, start) = top(0.01);
    let (mut state, mut alone) = (start.clone(), start.clone());
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

/// What happens in one step is shown in its order, given times among it, and the steps stay what they are.
#[test]
fn events_happen_in_their_order() {
    let (stepper, start) = top(0.05);
    let (mut state, mut alone) = (start.clone(), start.clone());
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
    let mut state = start.clone();
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
    // And goes on behind it.
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

    let mut state = start.clone();
    let run = stepper.observed(&mut state).event(Event::rising(), |now| (0.055 - now.time()).sqrt(), |_| ());
    let error = run.until(1.0).unwrap_err();
    assert!(matches!(error, RunError::NotANumber { event: 0, time } if (0.055..0.061).contains(&time)), "{error}");
    // Of a zero at a step nothing tells what comes behind it: without a sign there it is no crossing, and the error names
    // what isn't a number, looked at closely or not.
    for event in [Event::crossing(), Event::crossing().curvature(1.0)] {
        let mut state = start.clone();
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
        let mut state = start.clone();
        stepper.observed(&mut state).event(Event::rising().curvature(bound), |_| 0.0, |_| ()).until(0.1)
    };
    for bound in [1.0, 1e300, f64::INFINITY, f64::NAN] {
        let error = flat(bound).unwrap_err();
        assert!(matches!(error, RunError::TooManyLooks { event: 0, time: 0.0 }), "{error}");
    }
    assert_eq!(flat(0.0).unwrap().steps, 10);
}

/// A pendulum that falls until it is too fast for its steps: rows up to there are written, and the state is the last that
/// there is.
#[test]
fn a_run_that_fails_keeps_what_it_has() {
    let (stepper, _) = top(0.35);
    let attitude = UnitQuaternion::from_scaled_axis(Vector3::new(1e-3, 0.0, 0.0));
    let mut state = stepper.start(attitude, Vector3::zeros()).unwrap();
    let mut single = state.clone();
    let steps = (0..100).take_while(|_| stepper.step(&mut single).is_ok()).count();
    assert!((5..100).contains(&steps), "{steps}");
    let written = Rc::new(RefCell::new(Vec::new()));
    let mut recorder = Recorder::new(&stepper, Csv::new(Shared(written.clone())));
    let error = stepper.observed(&mut state).every(4, |now| recorder.record(now)).steps(1_000_000).unwrap_err();
    assert!(matches!(error, RunError::Step { cause: StepError::BeyondSolvable { .. }, .. }), "{error}");
    assert_eq!(usize::try_from(state.steps()).unwrap(), steps);
    assert_eq!(state, single);
    drop(recorder);
    let rows = String::from_utf8(written.take()).unwrap().lines().count() - 1;
    assert_eq!(rows, steps / 4 + 1);
}

struct Shared(Rc<RefCell<Vec<u8>>>);

impl Write for Shared {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.borrow_mut().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// A disk that is full.
struct Full;

impl Write for Full {
    fn write(&mut self, _: &[u8]) -> io::Result<usize> {
        Err(io::ErrorKind::StorageFull.into())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Counts the rows of each block, and how often the table has ended.
#[derive(Debug, Default)]
struct Calls {
    columns: usize,
    rows: Vec<usize>,
    ended: u32,
}

impl Calls {
    fn seen(&self) -> (&[usize], u32) {
        (&self.rows, self.ended)
    }
}

impl Sink for Calls {
    fn begin(&mut self, columns: &[Column]) -> Result<(), SinkError> {
        self.columns = columns.len();
        Ok(())
    }

    fn write(&mut self, rows: &[f64]) -> Result<(), SinkError> {
        assert_eq!(rows.len() % self.columns, 0);
        self.rows.push(rows.len() / self.columns);
        Ok(())
    }

    fn end(&mut self) -> Result<(), SinkError> {
        self.ended += 1;
        Ok(())
    }
}

#[test]
fn what_cannot_be_recorded_ends_the_run() {
    let (stepper, start) = top(0.01);
    let mut state = start.clone();
    let mut recorder = Recorder::new(&stepper, Csv::new(Full)).in_blocks_of(usize::MAX);
    let error = stepper.observed(&mut state).every(1, |now| recorder.record(now)).steps(10).unwrap_err();
    assert!(matches!(error, RunError::Observer { .. }) && state.steps() == 0, "{error}");
    assert!(error.to_string().contains("no storage space"), "{error}");
    drop(recorder);

    // In a thread it is found out with a later block.
    let mut recorder = Recorder::new(&stepper, Background::new(Csv::new(Full))).in_blocks_of(1);
    let error = stepper.observed(&mut start.clone()).every(1, |now| recorder.record(now)).steps(1000).unwrap_err();
    assert!(error.to_string().contains("no storage space"), "{error}");
    assert!(recorder.finish().is_err());

    let mut recorder = Recorder::new(&stepper, Table::new()).quantity("energy", "kJ", |now| 1e-3 * now.energy());
    let mut state = start.clone();
    let error = stepper.observed(&mut state).every(1, |now| recorder.record(now)).steps(10).unwrap_err();
    assert!(error.to_string().contains("two columns are called `energy`") && state.steps() == 0, "{error}");
    assert!(matches!(recorder.finish(), Err(RecordError::SameName { .. })));

    // Rows of two lengths would run into each other.
    let mut calls = Calls::default();
    let mut recorder = Recorder::new(&stepper, &mut calls);
    recorder.record(&Moment::of_step(&stepper, &start)).unwrap();
    recorder.record(&Moment::of_step(&stepper, &start)).unwrap();
    let mut recorder = recorder.quantity("late", "1", |_| 0.0).quantity("later", "1", |_| 0.0);
    let error = stepper.observed(&mut start.clone()).every(1, |now| recorder.record(now)).steps(10).unwrap_err();
    assert!(error.to_string().contains("the column `late` was added behind the first row"), "{error}");
    assert!(matches!(recorder.finish(), Err(RecordError::Late { .. })));
    // Those that came before are there, and the table has ended, once; also where nobody asks for more.
    assert_eq!(calls.seen(), (&[2][..], 1));
    let mut calls = Calls::default();
    let mut recorder = Recorder::bare(&stepper, &mut calls);
    recorder.record(&Moment::of_step(&stepper, &start)).unwrap();
    drop(recorder.quantity("late", "1", |_| 0.0));
    assert_eq!(calls.seen(), (&[1][..], 1));

    // The length of blocks may change between two rows.
    let mut calls = Calls::default();
    let mut recorder = Recorder::new(&stepper, &mut calls);
    recorder.record(&Moment::of_step(&stepper, &start)).unwrap();
    let mut recorder = recorder.in_blocks_of(3);
    stepper.observed(&mut start.clone()).every(1, |now| recorder.record(now)).steps(5).unwrap();
    let mut recorder = recorder.in_blocks_of(1);
    stepper.observed(&mut start.clone()).every(1, |now| recorder.record(now)).steps(2).unwrap();
    recorder.finish().unwrap();
    assert_eq!(calls.seen(), (&[3, 3, 2, 1, 1][..], 1));

    // An observer of one's own.
    let error = stepper.observed(&mut start.clone()).every(3, |_| Err::<(), _>("enough")).steps(10).unwrap_err();
    assert!(matches!(error, RunError::Observer { time: 0.0, .. }) && error.to_string().ends_with("enough"));
    let mut state = start;
    let stop_after_five = |steps| if steps > 5 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
    let ended = stepper.observed(&mut state).every(3, |now| stop_after_five(now.steps())).steps(10).unwrap();
    assert_eq!(ended.steps, 6);
}

/// Says that it has come to its end, and that it is gone.
struct Ends(std::sync::mpsc::Sender<&'static str>);

impl Sink for Ends {
    fn begin(&mut self, _: &[Column]) -> Result<(), SinkError> {
        Ok(())
    }

    fn write(&mut self, _: &[f64]) -> Result<(), SinkError> {
        Ok(())
    }

    fn end(&mut self) -> Result<(), SinkError> {
        Ok(self.0.send("ended")?)
    }
}

impl Drop for Ends {
    fn drop(&mut self) {
        let _ = self.0.send("gone");
    }
}

/// A file that isn't whole doesn't look so.
#[test]
fn a_table_in_a_thread_has_an_end_only_if_it_is_given_one() {
    for (is_ended, expected) in [(true, ["ended", "gone"].as_slice()), (false, &["gone"])] {
        let (sender, said) = std::sync::mpsc::channel();
        let mut sink = Background::new(Ends(sender));
        sink.begin(&[Column { name: "t".to_owned(), unit: "s".to_owned() }]).unwrap();
        sink.write(&[0.0]).unwrap();
        if is_ended {
            sink.end().unwrap();
        }
        drop(sink);
        assert_eq!(said.iter().collect::<Vec<_>>(), expected);
    }
}

/// Fails once, and writes down what it is asked.
struct Once {
    fails: &'static str,
    asked: Rc<RefCell<Vec<&'static str>>>,
}

impl Once {
    fn ask(&self, what: &'static str) -> Result<(), SinkError> {
        let mut asked = self.asked.borrow_mut();
        asked.push(what);
        let is_first = asked.iter().filter(|asked| **asked == what).count() == 1;
        if is_first && what == self.fails { Err("once".into()) } else { Ok(()) }
    }
}

impl Sink for Once {
    fn begin(&mut self, _: &[Column]) -> Result<(), SinkError> {
        self.ask("begin")
    }

    fn write(&mut self, _: &[f64]) -> Result<(), SinkError> {
        self.ask("write")
    }

    fn end(&mut self) -> Result<(), SinkError> {
        self.ask("end")
    }
}

/// Rows below no header or behind a gap, or the mark of the end behind them, would make a broken table look whole.
#[test]
fn a_sink_that_has_failed_gets_nothing_more() {
    let (stepper, start) = top(0.01);
    for (fails, expected) in [
        ("begin", &["begin"] as &[_]),
        ("write", &["begin", "write"]),
        ("end", &["begin", "write", "write", "write", "end"]),
    ] {
        for finishes in [true, false] {
            let asked = Rc::new(RefCell::new(Vec::new()));
            let sink = Once { fails, asked: asked.clone() };
            let mut recorder = Recorder::bare(&stepper, sink).in_blocks_of(2);
            let run = stepper.observed(&mut start.clone()).every(1, |now| recorder.record(now)).steps(3);
            assert_eq!(run.is_ok(), fails == "end");
            // Who goes on all the same is told each time.
            let run = stepper.observed(&mut start.clone()).every(1, |now| recorder.record(now)).steps(0);
            assert_eq!(run.is_ok(), fails == "end");
            if finishes {
                assert!(recorder.finish().is_err());
            } else {
                drop(recorder);
            }
            assert_eq!(*asked.borrow(), expected, "{fails}");
        }
    }
}

/// Names with commas and quotes, numbers that aren't any, and a table without rows.
#[test]
fn a_table_is_well_formed() {
    let (stepper, mut state) = top(0.01);
    let numbers = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -0.0, 1e300, 5e-324];
    let mut recorder = Recorder::bare(&stepper, Csv::new(Vec::new()))
        .quantity("a, \"b\"", "", |now| numbers[usize::try_from(now.steps()).unwrap()])
        .quantity("steps", "1", |now| u32::try_from(now.steps()).unwrap());
    assert_eq!(recorder.columns()[2].unit, "1");
    stepper.observed(&mut state).every(1, |now| recorder.record(now)).steps(5).unwrap();
    let text = String::from_utf8(recorder.finish().unwrap().into_inner().unwrap()).unwrap();
    assert_eq!(
        text,
        "t,\"a, \"\"b\"\"\",steps\n0.0,NaN,0.0\n0.01,inf,1.0\n0.02,-inf,2.0\n0.03,-0.0,3.0\n0.04,1e300,4.0\n0.05,5e-324,5.0\n"
    );
    let empty = Recorder::bare(&stepper, Csv::new(Vec::new())).finish().unwrap().into_inner().unwrap();
    assert_eq!(empty, b"t\n");
    let table = Recorder::bare(&stepper, Table::new()).finish().unwrap();
    assert_eq!((table.rows().len(), table.column("t").unwrap().len()), (0, 0));
    assert!(table.column("x").is_none());
}

/// Other scalars, other groups, another kind of integrator.
#[test]
fn whatever_steps_is_recorded() {
    let J = Inertia::from_principal_moments(Vector3::new(1.0_f32, 2.0, 2.5)).unwrap();
    let J_d = J.to_nonstandard();
    let scene: Sum<RigidBody<f32>, Drag<f32>> = RigidBody { J_d } + Drag { c: 0.5, J };
    let stepper = Stepper::new(scene, 1.0 / 64.0).unwrap();
    let mut state = stepper.start(SO3::identity(), Vector3::new(0.1, 1.0, 0.2)).unwrap();
    let mut recorder = Recorder::new(&stepper, Table::new());
    stepper.observed(&mut state).every(64, |now| recorder.record(now)).until(10.0).unwrap();
    let table = recorder.finish().unwrap();
    let energies: Vec<f64> = table.column("energy").unwrap().collect();
    assert!(energies.len() == 11 && energies.is_sorted_by(|a, b| a > b));

    let scene = HeavyTop::thesis();
    let gauss = CotangentGauss::<_, 2, 3>::new(scene, 0.05).unwrap();
    let mut state = gauss.start(SO3::identity(), VELOCITY).unwrap();
    let (mut attitude, mut momentum, mut single) = (state.attitude(), state.momentum(), state);
    let mut recorder = Recorder::new(&gauss, Table::new());
    gauss
        .observed(&mut state)
        .every(20, |now| recorder.record(now))
        .at([0.52], |now| {
            assert!(now.orthogonality_defect() < 1e-14);
        })
        .until(1.0)
        .unwrap();
    for _ in 0..20 {
        Integrator::step(&gauss, &mut single).unwrap();
        (attitude, momentum) = gauss.step(&attitude, &momentum).unwrap();
    }
    assert_eq!(state, single);
    assert_eq!(recorder.finish().unwrap().column("momentum_y").unwrap().last(), Some(single.momentum().y));
    // The sums of a run are compensated, and those of the map itself aren't.
    let apart = (state.attitude().matrix() - attitude.matrix()).norm();
    assert!(apart < 1e-14 && (state.momentum() - momentum).norm() < 1e-13, "{apart:e}");
    assert!(gauss.start(SO3::from_matrix_unchecked(nalgebra::Matrix3::zeros()), VELOCITY).is_err());
}

/// An integrator of which only the methods are known that each has to have.
struct Bare<'a, I>(&'a I);

impl<I: Integrator> Integrator for Bare<'_, I> {
    type Group = I::Group;
    type Advected = I::Advected;
    type State = I::State;

    fn step(&self, state: &mut I::State) -> Result<StepReport, StepError> {
        self.0.step(state)
    }

    fn run(&self, state: &mut I::State, steps: u64) -> Result<u64, StepError> {
        self.0.run(state, steps)
    }

    fn part(&self, state: &I::State, fraction: ScalarIn<I>) -> Result<Motion<I::Group, I::Advected>, StepError> {
        self.0.part(state, fraction)
    }

    fn adopt(&self, motion: &Motion<I::Group, I::Advected>) -> I::State {
        self.0.adopt(motion)
    }

    fn step_size(&self) -> ScalarIn<I> {
        self.0.step_size()
    }

    fn velocity(&self, motion: &Motion<I::Group, I::Advected>) -> <I::Group as LieGroup>::Vector {
        self.0.velocity(motion)
    }

    fn energy(&self, motion: &Motion<I::Group, I::Advected>) -> ScalarIn<I> {
        self.0.energy(motion)
    }
}

/// The end of a run that is shown, its iterations or its error, and at which steps it was.
type Shown<M> = (M, Result<u64, StepError>, Vec<u64>);

fn shown<I: Integrator>(integrator: &I, start: &I::State, plan: &[u64]) -> Shown<Motion<I::Group, I::Advected>> {
    let (mut state, mut calls) = (start.clone(), Vec::new());
    let (first, mut rest) = (plan[0], plan[1..].iter().copied());
    let made = integrator.run_shown(&mut state, first, &mut |motion| {
        calls.push(motion.steps());
        rest.next().unwrap_or(0)
    });
    (*state, made, calls)
}

/// Shown from within or call by call: the same bits, iterations, errors and calls, and none where there is nothing to do.
#[test]
fn runs_are_shown_alike_whatever_steps() {
    let attitude = UnitQuaternion::from_scaled_axis(Vector3::new(1e-3, 0.0, 0.0));
    for h in [0.01, 0.35] {
        let (any, _) = top(h);
        let stepper = Stepper::new(HeavyTop::thesis(), h).unwrap();
        // At the longer step it falls until it is too fast.
        let velocity = if h < 0.1 { VELOCITY } else { Vector3::zeros() };
        let start = stepper.start(attitude, velocity).unwrap();
        let any_start = any.start(attitude, velocity).unwrap();
        let hiding = any.clone().hiding_advected();
        let hiding_start = hiding.start(attitude, velocity).unwrap();
        for plan in [[0_u64, 5].as_slice(), &[1], &[4, 4, 1, 3], &[0], &[5, 100, 7]] {
            let (end, made, calls) = shown(&stepper, &start, plan);
            assert_eq!(shown(&Bare(&stepper), &start, plan), (end, made.clone(), calls.clone()), "{plan:?}");
            assert_eq!(shown(&any, &any_start, plan), (end, made.clone(), calls.clone()), "{plan:?}");
            assert_eq!(shown(&Bare(&any), &any_start, plan), (end, made.clone(), calls.clone()), "{plan:?}");
            let (hidden_end, hidden_made, hidden_calls) = shown(&hiding, &hiding_start, plan);
            assert_eq!((hidden_made, hidden_calls), (made.clone(), calls.clone()), "{plan:?}");
            let is_same = hidden_end.attitude() == end.attitude() && hidden_end.momentum() == end.momentum();
            assert!(is_same && hidden_end.steps() == end.steps(), "{plan:?}");
            assert_eq!(calls.is_empty(), plan[0] == 0 || (h > 0.1 && plan[0] > end.steps()), "{plan:?}");
            assert_eq!(made.is_err(), h > 0.1 && plan.contains(&100), "{plan:?}");
        }
    }
}

/// Rows have the same bits with an inertia in factors and without.
fn assert_row_is_both<I>(integrator: &I, motion: &Motion<I::Group, I::Advected>)
where
    I: Integrator<Group: LieGroup<Scalar = f64>>,
{
    let bits = |vector: &<I::Group as LieGroup>::Vector, energy: f64| {
        let mut bits = vec![energy.to_bits()];
        vector.each(&mut |entry: f64| bits.push(entry.to_bits()));
        bits
    };
    let expected = bits(&integrator.velocity(motion), integrator.energy(motion));
    for inertia in [None, integrator.factored_inertia()] {
        let (velocity, energy) = integrator.velocity_and_energy(motion, inertia.as_ref());
        assert!(expected.iter().any(|bits| f64::from_bits(*bits) != 0.0));
        assert_eq!(bits(&velocity, energy), expected, "{inertia:?}");
    }
}

#[test]
fn a_row_has_the_bits_of_velocity_and_energy() {
    let mut random = checks::random::Random::new(61);
    let J = Inertia::from_principal_moments(Vector3::new(1.0, 2.0, 2.5)).unwrap();
    let J_d = J.to_nonstandard();
    let whole = Inertia::new(nalgebra::Matrix3::new(2.0, 0.3, 0.1, 0.3, 1.7, 0.2, 0.1, 0.2, 1.5)).unwrap();
    let tilted = Stepper::new(RigidBody { J_d: whole.to_nonstandard() } + Drag { c: 0.1, J: whole }, 0.01).unwrap();
    let rotor = liestep::effects::Rotor { spin: Vector3::new(0.3, -0.2, 0.5) };
    let gyrostat = Stepper::new(RigidBody { J_d } + rotor, 0.01).unwrap();
    // Of an inertia that varies there are no factors.
    let sliding = SlidingTop { J_d, m: 1.2, g: 9.81, rho: Vector3::new(0.3, 0.2, 0.9), up: Vector3::z() };
    let sliding = Stepper::new(sliding, 0.01).unwrap();
    assert!(sliding.factored_inertia().is_none() && tilted.factored_inertia().is_some());
    let J = nalgebra::Matrix3::new(2.0, 0.3, 0.2, 0.3, 1.5, 0.1, 0.2, 0.1, 1.2);
    let (p, anchor) = (nalgebra::Point2::new(0.3, 0.1), nalgebra::Point2::new(2.0, -1.0));
    let plate = Stepper::new(TetheredPlate { J, k: 3.0, length: 0.5, p, anchor }, 0.01).unwrap();
    let (any, _) = top(0.01);
    let hiding = any.clone().hiding_advected();
    let gauss = CotangentGauss::<_, 2, 3>::new(HeavyTop::thesis(), 0.05).unwrap();
    let composed = Stepper::composed(HeavyTop::thesis(), 0.01, liestep::methods::CompositionScheme::SUZUKI_4).unwrap();
    for _ in 0..50 {
        let (attitude, velocity) = (random.rotation(), random.direction() * 3.0);
        assert_row_is_both(&tilted, &tilted.start(attitude, velocity).unwrap());
        assert_row_is_both(&gyrostat, &gyrostat.start(attitude, velocity).unwrap());
        assert_row_is_both(&sliding, &sliding.start(attitude, velocity).unwrap());
        assert_row_is_both(&plate, &plate.start(SE2::identity(), velocity).unwrap());
        assert_row_is_both(&any, &any.start(attitude, velocity).unwrap());
        assert_row_is_both(&hiding, &hiding.start(attitude, velocity).unwrap());
        assert_row_is_both(&gauss, &gauss.start(attitude, velocity).unwrap());
        assert_row_is_both(&composed, &composed.start(attitude, velocity).unwrap());
    }
}
