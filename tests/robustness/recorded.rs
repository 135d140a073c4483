//! Tables of runs: their contents, their sinks, and failures of writing.

use std::cell::RefCell;
use std::io::{self, Write};
use std::ops::ControlFlow;
use std::rc::Rc;

use declarations::{HeavyTop, SlidingTop, TetheredPlate};
use liestep::effects::{Drag, RigidBody};
use liestep::groups::{LieGroup, SE2};
use liestep::mechanics::Sum;
use liestep::methods::CotangentGauss;
use liestep::motion::{Integrator, Moment, Motion};
use liestep::numbers::Entries as _;
use liestep::prelude::*;
use liestep::recording::{Background, Column, Csv, RecordError, Recorder, RunError, Sink, SinkError, Table};
use nalgebra::{UnitQuaternion, Vector3};

use crate::one_top::{Top, TopState, VELOCITY, top};

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

/// A run in two parts writes the same as one run, and so does a separate thread.
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

/// A pendulum that falls until it is too fast for its steps: rows up to then are written, and the state is the last
/// one.
#[test]
fn a_run_that_fails_keeps_what_it_has() {
    let (stepper, _) = top(0.35);
    let attitude = UnitQuaternion::from_scaled_axis(Vector3::new(1e-3, 0.0, 0.0));
    let mut state = stepper.start(attitude, Vector3::zeros()).unwrap();
    let mut single = state;
    let steps = (0..100).take_while(|_| stepper.step(&mut single).is_ok()).count();
    assert!((5..100).contains(&steps), "{steps}");
    let written = Rc::new(RefCell::new(Vec::new()));
    let mut recorder = Recorder::new(&stepper, Csv::new(FileBytes(written.clone())));
    let error = stepper.observed(&mut state).every(4, |now| recorder.record(now)).steps(1_000_000).unwrap_err();
    assert!(matches!(error, RunError::Step { cause: StepError::BeyondSolvable { .. }, .. }), "{error}");
    assert_eq!(usize::try_from(state.steps()).unwrap(), steps);
    assert_eq!(state, single);
    drop(recorder);
    let rows = String::from_utf8(written.take()).unwrap().lines().count() - 1;
    assert_eq!(rows, steps / 4 + 1);
}

struct FileBytes(Rc<RefCell<Vec<u8>>>);

impl Write for FileBytes {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.borrow_mut().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// A writer to a full disk.
struct FullDisk;

impl Write for FullDisk {
    fn write(&mut self, _: &[u8]) -> io::Result<usize> {
        Err(io::ErrorKind::StorageFull.into())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Counts the rows of each block, and the ends of the table.
#[derive(Debug, Default)]
struct CallCounter {
    columns: usize,
    rows: Vec<usize>,
    ended: u32,
}

impl CallCounter {
    fn seen(&self) -> (&[usize], u32) {
        (&self.rows, self.ended)
    }
}

impl Sink for CallCounter {
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
    let mut state = start;
    let mut recorder = Recorder::new(&stepper, Csv::new(FullDisk)).in_blocks_of(usize::MAX);
    let error = stepper.observed(&mut state).every(1, |now| recorder.record(now)).steps(10).unwrap_err();
    assert!(matches!(error, RunError::Observer { .. }) && state.steps() == 0, "{error}");
    assert!(error.to_string().contains("no storage space"), "{error}");
    drop(recorder);

    // A separate thread reports the error with a later block.
    let mut recorder = Recorder::new(&stepper, Background::new(Csv::new(FullDisk))).in_blocks_of(1);
    let error = stepper.observed(&mut start.clone()).every(1, |now| recorder.record(now)).steps(1000).unwrap_err();
    assert!(error.to_string().contains("no storage space"), "{error}");
    assert!(recorder.finish().is_err());

    let mut recorder = Recorder::new(&stepper, Table::new()).quantity("energy", "kJ", |now| 1e-3 * now.energy());
    let mut state = start;
    let error = stepper.observed(&mut state).every(1, |now| recorder.record(now)).steps(10).unwrap_err();
    assert!(error.to_string().contains("two columns are called `energy`") && state.steps() == 0, "{error}");
    assert!(matches!(recorder.finish(), Err(RecordError::SameName { .. })));

    // Rows of different lengths would be ambiguous.
    let mut calls = CallCounter::default();
    let mut recorder = Recorder::new(&stepper, &mut calls);
    recorder.record(&Moment::of_step(&stepper, &start)).unwrap();
    recorder.record(&Moment::of_step(&stepper, &start)).unwrap();
    let mut recorder = recorder.quantity("late", "1", |_| 0.0).quantity("later", "1", |_| 0.0);
    let error = stepper.observed(&mut start.clone()).every(1, |now| recorder.record(now)).steps(10).unwrap_err();
    assert!(error.to_string().contains("the column `late` was added behind the first row"), "{error}");
    assert!(matches!(recorder.finish(), Err(RecordError::Late { .. })));
    // The previous rows are written, and the table has ended once, even if the user doesn't finish it.
    assert_eq!(calls.seen(), (&[2][..], 1));
    let mut calls = CallCounter::default();
    let mut recorder = Recorder::bare(&stepper, &mut calls);
    recorder.record(&Moment::of_step(&stepper, &start)).unwrap();
    drop(recorder.quantity("late", "1", |_| 0.0));
    assert_eq!(calls.seen(), (&[1][..], 1));

    // The length of blocks may change between two rows.
    let mut calls = CallCounter::default();
    let mut recorder = Recorder::new(&stepper, &mut calls);
    recorder.record(&Moment::of_step(&stepper, &start)).unwrap();
    let mut recorder = recorder.in_blocks_of(3);
    stepper.observed(&mut start.clone()).every(1, |now| recorder.record(now)).steps(5).unwrap();
    let mut recorder = recorder.in_blocks_of(1);
    stepper.observed(&mut start.clone()).every(1, |now| recorder.record(now)).steps(2).unwrap();
    recorder.finish().unwrap();
    assert_eq!(calls.seen(), (&[3, 3, 2, 1, 1][..], 1));

    // An observer of the user's own.
    let error = stepper.observed(&mut start.clone()).every(3, |_| Err::<(), _>("enough")).steps(10).unwrap_err();
    assert!(matches!(error, RunError::Observer { time: 0.0, .. }) && error.to_string().ends_with("enough"));
    let mut state = start;
    let stop_after_five = |steps| if steps > 5 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
    let ended = stepper.observed(&mut state).every(3, |now| stop_after_five(now.steps())).steps(10).unwrap();
    assert_eq!(ended.steps, 6);
}

/// A sink that reports its end, and its drop.
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

/// An incomplete file isn't marked as complete.
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

/// A sink that fails once, and logs its calls.
struct FailingSink {
    fails: &'static str,
    asked: Rc<RefCell<Vec<&'static str>>>,
}

impl FailingSink {
    fn ask(&self, what: &'static str) -> Result<(), SinkError> {
        let mut asked = self.asked.borrow_mut();
        asked.push(what);
        let is_first = asked.iter().filter(|asked| **asked == what).count() == 1;
        if is_first && what == self.fails { Err("once".into()) } else { Ok(()) }
    }
}

impl Sink for FailingSink {
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

/// After a failed header, a missing block or a failed end no further rows are written, so that a broken table can't
/// look complete.
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
            let sink = FailingSink { fails, asked: asked.clone() };
            let mut recorder = Recorder::bare(&stepper, sink).in_blocks_of(2);
            let run = stepper.observed(&mut start.clone()).every(1, |now| recorder.record(now)).steps(3);
            assert_eq!(run.is_ok(), fails == "end");
            // A caller who continues receives the error each time.
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

/// Names with commas and quotes, numbers that aren't finite, quantities in their order, and a table without rows.
#[test]
fn a_table_is_well_formed() {
    let (stepper, mut state) = top(0.01);
    let numbers = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -0.0, 1e300, 5e-324];
    let asked = RefCell::new(Vec::new());
    let mut recorder = Recorder::bare(&stepper, Csv::new(Vec::new()))
        .quantity("a, \"b\"", "", |now| {
            asked.borrow_mut().push(1);
            numbers[usize::try_from(now.steps()).unwrap()]
        })
        .quantity("steps", "1", |now| {
            asked.borrow_mut().push(2);
            u32::try_from(now.steps()).unwrap()
        });
    assert_eq!(recorder.columns()[2].unit, "1");
    stepper.observed(&mut state).every(1, |now| recorder.record(now)).steps(5).unwrap();
    let text = String::from_utf8(recorder.finish().unwrap().into_inner().unwrap()).unwrap();
    assert_eq!(
        text,
        "t,\"a, \"\"b\"\"\",steps\n0.0,NaN,0.0\n0.01,inf,1.0\n0.02,-inf,2.0\n0.03,-0.0,3.0\n0.04,1e300,4.0\n0.05,5e-324,5.0\n"
    );
    assert_eq!(asked.take(), [1, 2].repeat(6));
    let empty = Recorder::bare(&stepper, Csv::new(Vec::new())).finish().unwrap().into_inner().unwrap();
    assert_eq!(empty, b"t\n");
    let table = Recorder::bare(&stepper, Table::new()).finish().unwrap();
    assert_eq!((table.rows().len(), table.column("t").unwrap().len()), (0, 0));
    assert!(table.column("x").is_none());
}

/// Other scalars, other groups, and another kind of integrator.
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
    // The sums of a run are compensated, those of the map itself aren't.
    let apart = (state.attitude().matrix() - attitude.matrix()).norm();
    assert!(apart < 1e-14 && (state.momentum() - momentum).norm() < 1e-13, "{apart:e}");
    assert!(gauss.start(SO3::from_matrix_unchecked(nalgebra::Matrix3::zeros()), VELOCITY).is_err());
}

/// A row has the bits of velocity and energy, which come with a factorised inertia or without.
fn assert_row_is_both<G, A, I>(integrator: &I, motion: &Motion<G, A>)
where
    G: LieGroup<Scalar = f64>,
    I: Integrator<Scalar = f64, Motion = Motion<G, A>, Velocity = G::Vector>,
    Motion<G, A>: Clone,
{
    let (first, mut expected) = (G::factors().iter().map(|factor| factor.kind.columns()).sum::<usize>(), Vec::new());
    integrator.velocity(motion).each(&mut |entry: f64| expected.push(entry.to_bits()));
    assert!(expected.iter().any(|bits| f64::from_bits(*bits) != 0.0));
    let (mut attitude, mut row) = (vec![0.0; first], vec![0.0; first + 2 * G::DIMENSION + 2]);
    integrator.write(motion, &integrator.inertia(), &mut attitude, &mut row);
    let written: Vec<u64> = row[first..first + G::DIMENSION].iter().map(|number| number.to_bits()).collect();
    assert_eq!(written, expected);
    assert_eq!(row[first + 2 * G::DIMENSION].to_bits(), integrator.energy(motion).to_bits());
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
    // An inertia that varies has no factors.
    let sliding = SlidingTop { J_d, m: 1.2, g: 9.81, rho: Vector3::new(0.3, 0.2, 0.9), up: Vector3::z() };
    let sliding = Stepper::new(sliding, 0.01).unwrap();
    assert!(sliding.inertia().is_none() && tilted.inertia().is_some());
    let J = nalgebra::Matrix3::new(2.0, 0.3, 0.2, 0.3, 1.5, 0.1, 0.2, 0.1, 1.2);
    let (p, anchor) = (nalgebra::Point2::new(0.3, 0.1), nalgebra::Point2::new(2.0, -1.0));
    let plate = Stepper::new(TetheredPlate { J, k: 3.0, length: 0.5, p, anchor }, 0.01).unwrap();
    let (heavy, _) = top(0.01);
    let any = heavy.clone().into_any().on_group::<SO3, Vector3<f64>>().unwrap();
    let gauss = CotangentGauss::<_, 2, 3>::new(HeavyTop::thesis(), 0.05).unwrap();
    let composed = Stepper::composed(HeavyTop::thesis(), 0.01, liestep::methods::CompositionScheme::SUZUKI_4).unwrap();
    for _ in 0..50 {
        let (attitude, velocity) = (random.rotation(), random.direction() * 3.0);
        assert_row_is_both(&tilted, &tilted.start(attitude, velocity).unwrap());
        assert_row_is_both(&gyrostat, &gyrostat.start(attitude, velocity).unwrap());
        assert_row_is_both(&sliding, &sliding.start(attitude, velocity).unwrap());
        assert_row_is_both(&plate, &plate.start(SE2::identity(), velocity).unwrap());
        assert_row_is_both(&any, &any.start(attitude, velocity).unwrap());
        assert_row_is_both(&heavy, &heavy.start(attitude, velocity).unwrap());
        assert_row_is_both(&gauss, &gauss.start(attitude, velocity).unwrap());
        assert_row_is_both(&composed, &composed.start(attitude, velocity).unwrap());
    }
}
