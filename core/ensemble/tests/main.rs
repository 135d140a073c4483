//! The results of an ensemble are a function of its plan, and its failures are named.

mod common;
mod extended;
#[cfg(target_os = "linux")]
mod full_disk;
mod heads;
mod plans;
mod sections;
mod splittings;

use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

use common::{Folder, Top, axis, contents, made, top, tops, with_columns};
use liestep::mechanics::InertiaError;
use liestep::motion::{Factor, Integrator, StepReport};
use liestep::{StepError, Stepper};
use liestep_ensemble::{
    Engine, Ensemble, Failure, Fault, Histogram, Local, MakeChunk, MemberFailure, Report, Shard, Status, Store,
    StoreError, Summary, Table,
};
use nalgebra::Vector3;

const MEMBERS: u64 = 130;
const STEPS: u64 = 150;

fn run(ensemble: &Ensemble<Top>, engine: &Local<'_>, folder: &Folder) -> Report {
    ensemble.run(engine, &Store::folder(&folder.0).unwrap()).unwrap()
}

fn shards(ensemble: &Ensemble<Top>, folder: &Folder) -> Vec<Shard> {
    let store = Store::folder(&folder.0).unwrap();
    ensemble.shards(&store).unwrap().map(|shard| shard.unwrap()).collect()
}

/// The folder and the report of one thread, equal to those of more threads, of three shares, and one by one. `missing`
/// is left after each of the shares.
fn the_same(name: &str, [ensemble, alone]: [&Ensemble<Top>; 2], missing: [u64; 3]) -> (Folder, Report) {
    let first = Folder::new(name);
    let report = run(ensemble, &Local::threads(1), &first);
    let expected = contents(&first.0);
    for threads in [2, 7] {
        let folder = Folder::new(&format!("{name}-{threads}"));
        assert_eq!(run(ensemble, &Local::threads(threads), &folder), report);
        assert!(contents(&folder.0) == expected, "{threads} threads");
    }
    let folder = Folder::new(&format!("{name}-shares"));
    for (share, missing) in [2, 0, 1].into_iter().zip(missing) {
        let part = run(ensemble, &Local::threads(2).share(share, 3), &folder);
        assert_eq!(part.missing, missing, "share {share}");
    }
    assert!(contents(&folder.0) == expected, "shares");
    // The plan doesn't depend on lanes.
    let folder = Folder::new(&format!("{name}-alone"));
    assert_eq!(run(alone, &Local::threads(2), &folder), report);
    assert!(contents(&folder.0) == expected, "one by one");
    (first, report)
}

#[test]
fn files_and_sums_are_the_same_for_threads_shares_and_one_by_one() {
    let (ensemble, alone) = (tops(MEMBERS, STEPS), Ensemble::one_by_one("tops", MEMBERS, STEPS, top));
    let (folder, report) = the_same("one", [&ensemble, &with_columns(alone)], [5, 2, 0]);
    assert_eq!((report.chunks, report.made, report.missing), (7, 7, 0));
    assert_eq!((report.outcome.finished, report.outcome.failed()), (MEMBERS - 14, 14));
    assert_eq!(contents(&folder.0).len(), 7);
    // Finished chunks aren't computed again.
    let again = run(&ensemble, &Local::threads(2), &folder);
    assert_eq!(
        (again.made, again.outcome.finished, again.reduced("z")),
        (0, report.outcome.finished, report.reduced("z"))
    );
}

/// Rows and failures are those of each member's own stepper, without an ensemble.
#[test]
fn members_are_what_they_are_alone() {
    let ensemble = tops(MEMBERS, STEPS).every(60);
    let folder = Folder::new("alone");
    run(&ensemble, &Local::threads(2), &folder);
    let mut rows = Vec::new();
    let mut failures = Vec::new();
    for shard in shards(&ensemble, &folder) {
        let columns = &shard.rows.columns;
        rows.extend((0..shard.rows.member.len()).map(|row| {
            let values = [0, 1, 2, 3].map(|column| columns[column][row].to_bits());
            (shard.rows.member[row], shard.rows.step[row], shard.rows.status[row], values)
        }));
        failures.extend(shard.outcome.failures);
    }
    let mut expected = Vec::new();
    let mut expected_failures = Vec::new();
    for (member, made) in made(MEMBERS) {
        let (stepper, mut state) = match made {
            Ok(made) => made,
            Err(failure) => {
                expected.push((member, 0, Status::Impossible, [f64::NAN.to_bits(); 4]));
                expected_failures.push(MemberFailure { member, steps: 0, was_made: false, failure });
                continue;
            }
        };
        let mut keep = |step, status, state: &common::State| {
            let [x, y, z] = axis(state);
            expected.push((member, step, status, [x, y, z, stepper.energy(state)].map(f64::to_bits)));
        };
        keep(0, Status::Going, &state);
        let mut stopped = None;
        for step in 1..=STEPS {
            if let Err(error) = stepper.step(&mut state) {
                stopped = Some((step - 1, error));
                break;
            }
            if step == 60 || step == 120 {
                keep(step, Status::Going, &state);
            }
        }
        match stopped {
            None => keep(STEPS, Status::Finished, &state),
            Some((steps, error)) => {
                keep(steps, Status::Stopped, &state);
                expected_failures.push(MemberFailure { member, steps, was_made: true, failure: error.into() });
            }
        }
    }
    assert_eq!(rows, expected);
    assert_eq!(failures, expected_failures);
    // Failures are read back as the library's own errors.
    assert_eq!(failures.len(), 14);
    assert!(matches!(
        failures[0],
        MemberFailure { member: 3, failure: Failure::Inertia(InertiaError::TriangleInequality { .. }), .. }
    ));
    assert!(failures[1..].iter().all(|failed| failed.member % 10 == 5
        && failed.steps > 0
        && matches!(failed.failure, Failure::Step(StepError::BeyondSolvable { largest, step, .. }) if largest < step)));
}

/// Reductions equal those computed from the files alone.
#[test]
fn sums_are_those_of_the_files() {
    let ensemble = tops(MEMBERS, STEPS);
    let folder = Folder::new("sums");
    let report = run(&ensemble, &Local::threads(2), &folder);
    let mut ends = Vec::new();
    for (_, path) in Store::folder(&folder.0).unwrap().files().unwrap() {
        let table = Table::read(path).unwrap();
        let (z, steps) = (table.column("z").unwrap(), table.column("step").unwrap());
        let finished = table.column("status").unwrap().iter().filter(|status| (*status - 1.0).abs() < 0.5).count();
        let last = ends.len();
        ends.extend(z.iter().zip(steps).filter(|(_, steps)| **steps > 149.5).map(|(z, _)| *z));
        assert_eq!(finished, ends.len() - last);
    }
    assert_eq!(ends.len() as u64, report.outcome.finished);
    let Some(Summary::Moments(moments)) = report.reduced("z") else { panic!("{report:?}") };
    #[allow(clippy::cast_precision_loss)] // a hundred
    let mean = ends.iter().sum::<f64>() / ends.len() as f64;
    assert!((moments.mean - mean).abs() < 1e-14, "{moments:?}, {mean}");
    let squares: f64 = ends.iter().map(|z| (z - mean).powi(2)).sum();
    assert!((moments.squares - squares).abs() < 1e-13, "{moments:?}, {squares}");
    let Some(Summary::Histogram(Histogram { counts, below, above, .. })) = report.reduced("zs") else {
        panic!("{report:?}")
    };
    assert_eq!((counts.iter().sum::<u64>(), *below, *above), (report.outcome.finished, 0, 0));
    assert_eq!(counts[7], ends.iter().filter(|z| **z >= 0.75).count() as u64);
    assert!(report.reduced("y").is_none());
}

/// An engine that computes nothing, and records the number of chunks of each call.
struct ChunkCounter(Mutex<Vec<usize>>);

impl Engine for ChunkCounter {
    fn distribute(&self, missing: &[u64], _: &MakeChunk<'_>, _: &(dyn Fn() + Sync)) -> Result<(), StoreError> {
        self.0.lock().unwrap().push(missing.len());
        Ok(())
    }
}

/// Damaged files: a truncated one, one with a flipped bit, one of another plan, and one that isn't a shard.
#[test]
fn damaged_files_are_named_and_made_anew() {
    let ensemble = tops(MEMBERS, STEPS);
    let folder = Folder::new("damaged");
    run(&ensemble, &Local::threads(2), &folder);
    let expected = contents(&folder.0);
    let store = Store::folder(&folder.0).unwrap();
    let files = store.files().unwrap();
    let (cut, turned) = (files[1].1.clone(), files[4].1.clone());
    let bytes = std::fs::read(&cut).unwrap();
    std::fs::write(&cut, &bytes[..bytes.len() / 2]).unwrap();
    let whole = std::fs::read(&turned).unwrap();
    for place in [0, 9, whole.len() / 3, whole.len() - 20] {
        let mut bytes = whole.clone();
        bytes[place] ^= 4;
        std::fs::write(&turned, bytes).unwrap();
        assert_eq!(Store::read(&turned), Err(Fault::Altered(turned.clone())), "byte {place}");
    }
    // A store trusts the names unless it verifies.
    assert_eq!(run(&ensemble, &Local::threads(2), &folder).made, 0);
    let store = store.verified();
    let named: Vec<Fault> = ensemble.shards(&store).unwrap().filter_map(Result::err).collect();
    let faults = vec![Fault::Truncated(cut.clone()), Fault::Altered(turned.clone())];
    assert_eq!(named, faults);
    assert!(named[0].to_string().contains("truncated") && named[1].to_string().contains("digest"));
    let report = ensemble.run(&Local::threads(2), &store).unwrap();
    assert_eq!((report.made, report.missing, &report.faults), (2, 0, &faults));
    // The damaged files are there under another name.
    let aside = |path: &Path| PathBuf::from(format!("{}.damaged", path.display()));
    assert_eq!(std::fs::read(aside(&cut)).unwrap(), bytes[..bytes.len() / 2]);
    assert_ne!(std::fs::read(aside(&turned)).unwrap(), whole);
    std::fs::remove_file(aside(&cut)).unwrap();
    std::fs::remove_file(aside(&turned)).unwrap();
    assert!(contents(&folder.0) == expected);
    // A file of another plan: nothing is touched.
    let foreign = tops(MEMBERS, STEPS).seed(8);
    let other = Folder::new("foreign");
    run(&foreign, &Local::threads(2), &other);
    let (_, from) = Store::folder(&other.0).unwrap().files().unwrap().remove(2);
    let to = folder.0.join("00000").join(from.file_name().unwrap());
    std::fs::copy(&from, &to).unwrap();
    let refused = ensemble.run(&Local::threads(2), &store).unwrap_err();
    assert!(matches!(&refused, StoreError::Foreign { path } if *path == to), "{refused}");
    assert!(to.exists());
    // Other processes that wait for numbers get an empty list.
    let told = ChunkCounter(Mutex::new(Vec::new()));
    assert!(ensemble.run(&told, &store).is_err());
    assert_eq!(*told.0.lock().unwrap(), [0]);
    let named: Vec<Fault> = ensemble.shards(&store).unwrap().filter_map(Result::err).collect();
    assert_eq!(named, [Fault::Foreign(to.clone())]);
    std::fs::remove_file(&to).unwrap();
    // An empty file with a shard's name is no shard.
    let empty = folder.0.join("00000").join("00000002-20-860389c57a9c1205860389c57a9c1205.arrow");
    std::fs::write(&empty, b"").unwrap();
    assert!(matches!(Store::read(&empty), Err(Fault::Unreadable(..))));
    assert_eq!(run(&ensemble, &Local::threads(2), &folder).made, 0);
    assert!(!empty.exists() && aside(&empty).exists());
    // A folder can't be read as a file.
    assert!(matches!(Store::read(&folder.0.join("00000")), Err(Fault::Io(..))));
}

/// Files of others stay, whatever their names; the partial file of a killed run is removed.
#[test]
fn files_of_others_survive() {
    let ensemble = tops(MEMBERS, STEPS);
    let folder = Folder::new("others");
    run(&ensemble, &Local::threads(2), &folder);
    let own = contents(&folder.0);
    let names = [
        "2024/2024-12.arrow", // of a month
        "00000/2024-12.arrow",
        "00000/1-20-cbf29ce484222325cbf29ce484222325.arrow", // a number without leading zeros
        "00000/00000001-20-CBF29CE484222325CBF29CE484222325.arrow", // digests in capitals
        "00000/00000001-020-cbf29ce484222325cbf29ce484222325.arrow",
        "00000/+0000001-20-cbf29ce484222325cbf29ce484222325.arrow",
        "00000/00000001-20-cbf29ce484222325.arrow", // one digest alone
        "00001/00000001-20-cbf29ce484222325cbf29ce484222325.arrow", // in the folder of another number
        "00000/film.part",
        "00000/00000001-20-cbf29ce484222325cbf29ce484222325.arrow.part",
        "00000/notes.damaged",
    ];
    for name in names {
        let path = folder.0.join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, name).unwrap();
    }
    std::fs::write(folder.0.join("00000/00000001-20-cbf29ce484222325cbf29ce484222325.arrow.host-1-0.part"), "half")
        .unwrap();
    let report = run(&ensemble, &Local::threads(2), &folder);
    assert_eq!((report.made, report.missing, &report.faults), (0, 0, &vec![]));
    let mut found = contents(&folder.0);
    for name in names {
        assert_eq!(found.remove(Path::new(name)).as_deref(), Some(name.as_bytes()), "{name}");
    }
    assert!(found == own);
}

/// Two whole files of a chunk, as by members that aren't reproducible, are refused, and neither is counted.
#[test]
fn two_files_of_one_chunk_are_refused() {
    let folder = Folder::new("twice");
    let store = Store::folder(&folder.0).unwrap();
    let ensemble = tops(MEMBERS, STEPS);
    let mut shard = ensemble.chunk(3, &|| false).unwrap();
    store.write(&shard).unwrap();
    shard.rows.columns[0][0] += 1.0;
    store.write(&shard).unwrap();
    let (_, second) = store.files().unwrap().remove(1);
    let refused = ensemble.run(&Local::threads(1), &store).unwrap_err();
    assert!(matches!(&refused, StoreError::Twice { path } if *path == second), "{refused}");
    assert_eq!(store.files().unwrap().len(), 2);
}

/// A plan with other results has another fingerprint, also if functions differ in their values only. One of more members
/// has the same.
#[test]
fn another_plan_has_another_fingerprint() {
    let plans = [
        tops(MEMBERS, STEPS),
        tops(MEMBERS, STEPS + 1),
        tops(MEMBERS, STEPS).seed(8),
        tops(MEMBERS, STEPS).every(10),
        tops(MEMBERS, STEPS).chunks_of(21),
        tops(MEMBERS, STEPS).keep(["w"], |_| [1.0]),
        tops(MEMBERS, STEPS).keep(["w"], |_| [2.0]),
        tops(MEMBERS, STEPS).over(Table::new([("m".to_owned(), vec![1.0])]).unwrap()),
        tops(MEMBERS, STEPS).over(Table::new([("m".to_owned(), vec![2.0])]).unwrap()),
        with_columns(Ensemble::new("other tops", MEMBERS, STEPS, top)),
        with_columns(Ensemble::new("tops", MEMBERS, STEPS, |member| {
            let (stepper, state) = top(member)?;
            let heavier = *stepper.scene();
            let stepper = Stepper::new(heavier, 0.01)?;
            Ok((stepper, state))
        })),
    ];
    for members in [1, 2, MEMBERS, MEMBERS + 1] {
        assert_eq!(plans[0].fingerprint(), tops(members, STEPS).fingerprint());
    }
    assert_unlike(&plans);
}

/// Asserts that no two plans have one fingerprint.
fn assert_unlike(plans: &[Ensemble<Top>]) {
    let mut fingerprints: Vec<u64> = plans.iter().map(Ensemble::fingerprint).collect();
    fingerprints.sort_unstable();
    fingerprints.dedup();
    assert_eq!(fingerprints.len(), plans.len());
}

/// An error in writing one shard leaves the others.
#[test]
fn a_shard_that_cannot_be_written_loses_no_other() {
    let ensemble = tops(MEMBERS, STEPS);
    let folder = Folder::new("full");
    let store = Store::folder(&folder.0).unwrap();
    run(&ensemble, &Local::threads(1), &folder);
    let expected = contents(&folder.0);
    let (_, last) = store.files().unwrap().pop().unwrap();
    // A folder takes up the shard's name.
    std::fs::remove_file(&last).unwrap();
    std::fs::create_dir(&last).unwrap();
    let error = ensemble.run(&Local::threads(2), &store).unwrap_err();
    assert!(matches!(error, StoreError::Io { .. }), "{error}");
    std::fs::remove_dir(&last).unwrap();
    assert_eq!(contents(&folder.0).len(), 6, "nothing is left of it");
    let report = run(&ensemble, &Local::threads(2), &folder);
    assert_eq!((report.made, report.missing), (1, 0));
    assert!(contents(&folder.0) == expected);
}

#[test]
fn a_run_can_be_watched_and_stopped() {
    let ensemble = tops(MEMBERS, STEPS);
    let folder = Folder::new("stopped");
    let store = Store::folder(&folder.0).unwrap();
    let stop = AtomicBool::new(false);
    let seen = Mutex::new(Vec::new());
    let watch = |progress: liestep_ensemble::Progress| {
        seen.lock().unwrap().push((progress.done, progress.chunks));
        stop.store(progress.done == 3, Ordering::Relaxed);
    };
    let report = ensemble.run_telling(&Local::threads(1).stopped_by(&stop), &store, &watch).unwrap();
    assert_eq!(*seen.lock().unwrap(), [(1, 7), (2, 7), (3, 7)]);
    assert_eq!((report.made, report.missing), (3, 4));
    assert_eq!(run(&ensemble, &Local::threads(2), &folder).made, 4);
}

/// A top whose longer runs fail, as a splitting's may for lack of digits.
#[derive(Clone)]
struct TopWithoutRuns(Top);

impl Integrator for TopWithoutRuns {
    type Scalar = f64;
    type Motion = <Top as Integrator>::Motion;
    type Velocity = Vector3<f64>;
    type Inertia = <Top as Integrator>::Inertia;
    type State = common::State;

    fn step(&self, state: &mut Self::State) -> Result<StepReport, StepError> {
        self.0.step(state)
    }

    fn run(&self, _: &mut Self::State, _: u64) -> Result<u64, StepError> {
        Err(StepError::Singular)
    }

    fn part(&self, state: &Self::State, fraction: f64) -> Result<Self::Motion, StepError> {
        self.0.part(state, fraction)
    }

    fn adopt(&self, motion: &Self::Motion) -> Self::State {
        self.0.adopt(motion)
    }

    fn step_size(&self) -> f64 {
        self.0.step_size()
    }

    fn steps(motion: &Self::Motion) -> u64 {
        motion.steps()
    }

    fn factors(&self) -> Vec<Factor> {
        self.0.factors()
    }

    fn inertia(&self) -> Self::Inertia {
        self.0.inertia()
    }

    fn write(&self, motion: &Self::Motion, inertia: &Self::Inertia, attitude: &mut [f64], row: &mut [f64]) {
        self.0.write(motion, inertia, attitude, row);
    }

    fn velocity(&self, motion: &Self::Motion) -> Vector3<f64> {
        self.0.velocity(motion)
    }

    fn energy(&self, motion: &Self::Motion) -> f64 {
        self.0.energy(motion)
    }
}

/// Errors of longer runs stop no member whose steps have none.
#[test]
fn members_go_as_far_as_their_steps_do() {
    let stepwise = Ensemble::one_by_one("tops", 20, STEPS, |member| {
        let (stepper, state) = top(member)?;
        Ok((TopWithoutRuns(stepper), state))
    });
    let stepwise =
        stepwise.seed(7).chunks_of(20).keep(["x", "y", "z"], |run| axis(run.state)).chunk(0, &|| false).unwrap();
    let expected = tops(20, STEPS).chunk(0, &|| false).unwrap();
    assert_eq!(stepwise.outcome.finished, 17);
    assert_eq!(stepwise.outcome.failures, expected.outcome.failures);
    assert_eq!(stepwise.rows.step, expected.rows.step);
    let bits = |shard: &Shard| -> Vec<u64> { shard.rows.columns[..3].iter().flatten().map(|x| x.to_bits()).collect() };
    assert_eq!(bits(&stepwise), bits(&expected));
}

/// A member that ends at a recorded time has no second row for it.
#[test]
fn a_member_has_one_row_for_each_step() {
    for (steps, every) in [(STEPS, 1), (40, 40), (0, 5)] {
        let shard = tops(20, steps).every(every).chunk(0, &|| false).unwrap();
        let mut rows: Vec<(u64, u64)> =
            shard.rows.member.iter().copied().zip(shard.rows.step.iter().copied()).collect();
        let count = rows.len();
        rows.dedup();
        assert_eq!(rows.len(), count, "{steps} steps, every {every}");
        let ends = shard.rows.status.iter().filter(|status| **status != Status::Going).count();
        assert_eq!(ends, 20);
        assert!(shard.rows.columns.iter().all(|column| column.len() == count));
    }
    let stopped = tops(20, STEPS).every(1).chunk(0, &|| false).unwrap();
    assert!(stopped.rows.status.contains(&Status::Stopped));
}

/// A request to stop is answered while members run.
#[test]
fn a_long_member_can_be_stopped() {
    let asked = AtomicU64::new(0);
    let is_stopped = || asked.fetch_add(1, Ordering::Relaxed) == 100;
    assert!(tops(1, 1_000_000_000).chunk(0, &is_stopped).is_none());
}

/// An error of one worker stops the others within their chunks.
#[test]
fn an_error_stops_the_other_workers() {
    let is_there = AtomicBool::new(false);
    let until = Instant::now() + Duration::from_secs(60);
    let told = AtomicBool::new(false);
    let wait = |done: &dyn Fn() -> bool| {
        while !done() && Instant::now() < until {
            std::thread::yield_now();
        }
        done()
    };
    let make: &MakeChunk<'_> = &|chunk, is_stopped| match chunk {
        0 => {
            wait(&|| is_there.load(Ordering::Relaxed));
            Err(StoreError::Unwritable { reason: "full".to_owned() })
        }
        1 => {
            is_there.store(true, Ordering::Relaxed);
            told.store(wait(is_stopped), Ordering::Relaxed);
            Ok(())
        }
        _ => panic!("it was given up before"),
    };
    let made = Local::threads(2).distribute(&[0, 1, 2], make, &|| ());
    assert!(matches!(made, Err(StoreError::Unwritable { .. })));
    assert!(told.into_inner());
}
