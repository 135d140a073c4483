//! The members of a file's ensemble, on all processors or a share of them here.

use std::fmt::Write as _;
use std::path::Path;
use std::sync::Mutex;

use clap::ArgMatches;
use liestep::SO3;
use liestep::motion::{AnyStepper, Integrator as _, Moment};
use liestep_ensemble::{Failed, Failure, Local, Reduced, Reduction, Report, Store};
use liestep_scene::{Column, Drawn, Mistake, SceneFile, Spread};

use crate::failure::Failure as Ended;
use crate::output::{Output, Progress, print};
use crate::{different_files, folder, name, scenes};

/// So many failures are printed; all are in the files.
const SHOWN: usize = 10;

pub(crate) fn ensemble(given: &ArgMatches) -> Result<(), Ended> {
    let paths = different_files(given)?;
    let scenes = scenes(&paths)?;
    let threads = given.get_one::<usize>("threads").copied().unwrap_or_default();
    let (share, shares) = given.get_one::<(u64, u64)>("shard").copied().unwrap_or((0, 1));
    for (path, scene) in paths.iter().zip(&scenes) {
        if scene.ensemble().is_none() {
            return Err(Mistake::no_table(path, "ensemble").into());
        }
    }
    let output = folder(given)?;
    let (mut failed, mut missing) = (0, 0);
    for (path, scene) in paths.iter().zip(&scenes) {
        let Some(drawn) = scene.ensemble() else { continue };
        let report = made(path, scene, drawn, &Local::threads(threads).share(share, shares), &output)?;
        failed += report.failed;
        missing += report.missing;
    }
    if missing > 0 {
        print(&format!("{missing} chunks are left to other shares.\n"))?;
    }
    if failed == 0 { Ok(()) } else { Err(Ended::Runs(format!("{failed} members weren't finished"))) }
}

/// Makes what is missing in the folder of a file's shards, and prints what is there then.
fn made(path: &Path, scene: &SceneFile, drawn: &Drawn, local: &Local<'_>, output: &Output) -> Result<Report, Ended> {
    let cannot = |error: &dyn std::fmt::Display| Ended::Output(format!("{}: {error}", path.display()));
    if scene.events().next().is_some() {
        eprintln!("note: {}: events aren't looked for in an ensemble", path.display());
    }
    let plan = plan(scene, drawn);
    let folder = output.inner(&name(path, "ensemble"));
    let store = Store::folder(&folder).map_err(|error| cannot(&error))?;
    let progress = Mutex::new(Progress::new());
    let told = |now: liestep_ensemble::Progress| {
        if let Ok(mut progress) = progress.lock() {
            #[allow(clippy::cast_precision_loss)] // a share
            progress.show(now.done as f64 / now.chunks as f64);
        }
    };
    let report = plan.run_telling(local, &store, &told).map_err(|error| cannot(&error))?;
    drop(progress);
    for fault in &report.faults {
        eprintln!("note: {fault}; it was made anew");
    }
    let mut failures: Vec<Failed> = Vec::new();
    if report.failed > 0 {
        for shard in store.shards(plan.fingerprint()).map_err(|error| cannot(&error))? {
            let shard = shard.map_err(|fault| cannot(&fault))?;
            failures.extend(shard.failures.into_iter().take(SHOWN - failures.len()));
            if failures.len() == SHOWN {
                break;
            }
        }
    }
    for Failed { member, steps, failure } in &failures {
        eprintln!("note: member {member} failed after {steps} steps: {failure}");
    }
    print(&told_of(scene, drawn, &report, &folder.display().to_string()))?;
    Ok(report)
}

type Member = AnyStepper<SO3, ()>;

/// What is run: the file as a whole tells it from others.
fn plan(scene: &SceneFile, drawn: &Drawn) -> liestep_ensemble::Ensemble<Member> {
    let own = drawn.clone();
    let make = move |member: &liestep_ensemble::Member<'_>| {
        let mut draw = |name: &str, spread: Spread| match spread {
            Spread::Uniform { from, to } => member.uniform(name, from..to),
            Spread::Normal { mean, deviation } => member.normal(name, mean, deviation),
        };
        let started = own.member(&mut draw).and_then(|scene| scene.stepper());
        started.map_err(|mistake| Failure::Other(mistake.to_string()))
    };
    let steps = scene.steps().unwrap_or_default();
    let mut plan =
        liestep_ensemble::Ensemble::one_by_one(drawn.text(), drawn.members(), steps, make).seed(drawn.seed());
    if let Some(every) = drawn.every() {
        plan = plan.every(every);
    }
    if let Some(members) = drawn.chunk() {
        plan = plan.chunks_of(members);
    }
    let names: Vec<_> = columns(scene).map(|(_, _, name)| name).collect();
    let all = scene.columns().to_vec();
    plan = plan.keep_named(&names, move |run, row| {
        let numbers = SceneFile::numbers(&all, &Moment::of_step(run.stepper, run.state));
        row.iter_mut().zip(numbers).for_each(|(place, number)| *place = number);
    });
    for (column, place, name) in columns(scene).filter(|(column, ..)| has_moments(*column)) {
        plan = plan.reduce(name, Reduction::Moments, move |run| {
            let numbers = SceneFile::numbers(&[column], &Moment::of_step(run.stepper, run.state));
            numbers.get(place).copied().unwrap_or(f64::NAN)
        });
    }
    plan.keep(["t"], |run| [run.stepper.time(run.state)])
}

/// A quaternion and its opposite are one attitude, and which of them a member ends with means nothing.
fn has_moments(column: Column) -> bool {
    column != Column::Quaternion
}

/// Each number of the scene's columns: its column, its place there and its name.
fn columns(scene: &SceneFile) -> impl Iterator<Item = (Column, usize, &'static str)> + '_ {
    let numbers = |column: Column| column.names().iter().enumerate().map(move |(place, name)| (column, place, *name));
    scene.columns().iter().copied().flat_map(numbers)
}

fn told_of(scene: &SceneFile, drawn: &Drawn, report: &Report, folder: &str) -> String {
    let mut text = format!(
        "{}\n  {} members drawn by the seed {}: {} finished, {} failed\n",
        scene.title(),
        drawn.members(),
        drawn.seed(),
        report.finished,
        report.failed
    );
    if report.missing == 0 && report.finished > 0 {
        let _ =
            writeln!(text, "  {:<20}{:>16}{:>16}{:>16}{:>16}", "at the end", "mean", "deviation", "least", "largest");
        for (_, _, name) in columns(scene) {
            if let Some(Reduced::Moments(moments)) = report.reduced(name) {
                let spread = moments.variance().sqrt();
                let [mean, least, largest] = [moments.mean, moments.least, moments.largest];
                let _ = writeln!(text, "  {name:<20}{mean:>16.6e}{spread:>16.6e}{least:>16.6e}{largest:>16.6e}");
            }
        }
    }
    let _ =
        writeln!(text, "Written to {folder}: {} chunks, {} of them now", report.chunks - report.missing, report.made);
    text
}
