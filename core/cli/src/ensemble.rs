//! The ensemble of a file: members on all processors, or a share of them.

use std::fmt::Write as _;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};

use clap::ArgMatches;
use liestep::motion::AnyStepper;
use liestep_ensemble::{
    Ensemble, Failure, Local, Member, MemberFailure, Moments, Reduction, Report, Section, Store, Summary,
};
use liestep_scene::{Column, EndHistogram, Mistake, Scene, SceneEnsemble, Spread, Watch, visible};

use crate::failure::Failure as ProgramFailure;
use crate::files::{different_files, folder, name, scenes};
use crate::interrupt;
use crate::members::{Scenes, number};
use crate::output::{Progress, print};
use crate::tally::{bars, counts, of_event};

/// Simulates the members that are missing, or with `only_tells` reports the finished ones.
pub(crate) fn ensemble(given: &ArgMatches, only_tells: bool) -> Result<(), ProgramFailure> {
    let paths = different_files(given)?;
    let scenes = scenes(&paths)?;
    let (threads, (share, shares)) = if only_tells {
        (1, (0, 1))
    } else {
        let share = given.get_one::<(u64, u64)>("share").copied();
        (given.get_one::<usize>("threads").copied().unwrap_or_default(), share.unwrap_or((0, 1)))
    };
    // A run that is stopped from the start simulates nothing.
    let stop = Arc::new(AtomicBool::new(only_tells));
    if !only_tells {
        // Without a signal's handler Ctrl-C ends the program, and finished files are kept all the same.
        let _ = interrupt::sets(&stop);
    }
    for note in scenes.iter().filter_map(|scene| scene.ensemble()?.note.as_ref()) {
        eprintln!("note: {}", visible(&note.to_string()));
    }
    if let Some((path, _)) = paths.iter().zip(&scenes).find(|(_, scene)| scene.ensemble().is_none()) {
        return Err(Mistake::no_table(path, "ensemble").into());
    }
    let output = folder(given)?;
    let (mut stopped, mut missing) = (0, 0);
    for (path, scene) in paths.iter().zip(&scenes) {
        let Some(drawn) = scene.ensemble() else { continue };
        let local = Local::threads(threads).share(share, shares).stopped_by(&stop);
        let folder = output.inner(&name(path, "ensemble"));
        if only_tells && !folder.is_dir() {
            return Err(ProgramFailure::Output(format!(
                "{}: nothing is there; `liestep ensemble` makes it",
                folder.display()
            )));
        }
        let store = Store::folder(&folder).map_err(|error| cannot(path, &error))?;
        let store = if given.get_flag("verify") { store.verified() } else { store };
        let report = made(path, scene, drawn, (&local, shares > 1), (&store, &folder))?;
        stopped += report.outcome.stopped;
        missing += report.missing;
        if !only_tells && missing > 0 && stop.load(Ordering::Relaxed) {
            return Err(ProgramFailure::Stopped(kept(&report, &folder)));
        }
    }
    if missing > 0 {
        let by = if only_tells { "`liestep ensemble`" } else { "other shares" };
        print(&format!("{missing} chunks are left to {by}.\n"))?;
    }
    if stopped == 0 { Ok(()) } else { Err(ProgramFailure::Runs(format!("{stopped} members broke down"))) }
}

/// The message of a run that Ctrl-C has stopped: what is kept, and the command that goes on.
fn kept(Report { chunks, missing, outcome, .. }: &Report, folder: &Path) -> String {
    let members = outcome.finished + outcome.left + outcome.stopped + outcome.impossible;
    let (there, folder, again) = (chunks - missing, folder.display(), interrupt::command_line());
    format!(
        "stopped by Ctrl-C: {there} of {chunks} chunks, with {members} members, are kept in {folder}; `{again}` goes on there"
    )
}

fn cannot(path: &Path, error: &dyn std::fmt::Display) -> ProgramFailure {
    ProgramFailure::Output(format!("{}: {error}", path.display()))
}

/// Simulates a folder's missing chunks, and prints a report, of this share while chunks are missing. Stored rows aren't
/// read.
fn made(
    path: &Path,
    scene: &Scene,
    drawn: &SceneEnsemble,
    local: (&Local<'_>, bool),
    store: (&Store, &Path),
) -> Result<Report, ProgramFailure> {
    let steps = scene.steps().unwrap_or_default();
    let failed = |mistake: Mistake| Failure::Other(mistake.to_string());
    let drawn_of = |own: &SceneEnsemble, member: &Member<'_>| {
        own.member(&mut |name: &str, spread: Spread| number(member, name, spread))
    };
    if let Some(whole) = scene.whole() {
        let own = drawn.clone();
        let make =
            move |member: &Member<'_>| drawn_of(&own, member).and_then(|scene| scene.in_lanes(&whole)).map_err(failed);
        let members = Ensemble::abreast(&drawn.identity, drawn.members, steps, make);
        return finished(path, scene, drawn, members, local, store);
    }
    let own = drawn.clone();
    let make = move |member: &Member<'_>| drawn_of(&own, member).and_then(|scene| scene.stepper()).map_err(failed);
    finished(path, scene, drawn, Ensemble::one_by_one(&drawn.identity, drawn.members, steps, make), local, store)
}

/// Simulates the chunks of members, in lanes or one by one, and prints their outcome.
fn finished(
    path: &Path,
    scene: &Scene,
    drawn: &SceneEnsemble,
    members: Ensemble<AnyStepper>,
    (local, is_share): (&Local<'_>, bool),
    (store, folder): (&Store, &Path),
) -> Result<Report, ProgramFailure> {
    let plan = plan(scene, drawn, members);
    let progress = Mutex::new(Progress::new());
    let told = |now: liestep_ensemble::Progress| {
        if let Ok(mut progress) = progress.lock() {
            progress.show(&now);
        }
    };
    let report = plan.run_telling(local, store, &told).map_err(|error| cannot(path, &error))?;
    drop(progress);
    for fault in &report.faults {
        eprintln!("note: {fault}; it is set aside, and `liestep ensemble` makes it anew");
    }
    let (unmade, stopped): (Vec<_>, Vec<_>) = report.outcome.failures.iter().partition(|failed| !failed.was_made);
    if let Some(MemberFailure { member, failure, .. }) = unmade.first() {
        eprintln!("note: {} can't exist; the first of them is member {member}: {failure}", report.outcome.impossible);
    }
    for MemberFailure { member, steps, failure, .. } in stopped {
        eprintln!("note: member {member} failed after {steps} steps: {failure}");
    }
    let is_share = is_share && report.missing > 0;
    print(&told_of(scene, drawn, &report, (is_share, &folder.display().to_string())))?;
    Ok(report)
}

/// The plan of an ensemble, which the file's values identify.
fn plan(scene: &Scene, drawn: &SceneEnsemble, members: Ensemble<AnyStepper>) -> Ensemble<AnyStepper> {
    let mut plan = members.seed(drawn.seed);
    if let Some(every) = drawn.every {
        plan = plan.every(every);
    }
    if let Some(members) = drawn.chunk {
        plan = plan.chunks_of(members);
    }
    let names: Vec<_> = columns(drawn).map(|(_, _, name)| name).collect();
    let own = Scenes::new(scene, drawn);
    plan = plan.keep_named(&names, {
        let (own, kept) = (Arc::clone(&own), drawn.columns.clone());
        move |run, row| {
            let numbers = own.numbers(run, &kept);
            row.iter_mut().zip(numbers).for_each(|(place, number)| *place = number);
        }
    });
    let draws: Vec<(String, Spread)> = drawn.draws().map(|(name, spread)| (name.to_owned(), spread)).collect();
    let (names, seed) = (draws.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>(), drawn.seed);
    plan = plan.keep_named(&names, {
        let draws = draws.clone();
        move |run, row| {
            let member = Member::of(run.member, seed);
            row.iter_mut().zip(&draws).for_each(|(place, (name, spread))| *place = number(&member, name, *spread));
        }
    });
    // A quaternion and its opposite are the same attitude, so means of them have no meaning.
    for (column, place, name) in columns(drawn).filter(|(.., name)| !name.starts_with("q_")) {
        let own = Arc::clone(&own);
        plan = plan.reduce(name, Reduction::Moments, move |run| {
            own.numbers(run, std::slice::from_ref(&column)).get(place).copied().unwrap_or(f64::NAN)
        });
    }
    for EndHistogram { column: name, range, parts, .. } in &drawn.histograms {
        let Some((column, place, _)) = columns(drawn).find(|(.., own)| own == name) else { continue };
        let (own, kind) = (Arc::clone(&own), Reduction::Histogram { range: range.clone(), bins: *parts });
        plan = plan.reduce(&name_of(name), kind, move |run| {
            own.numbers(run, std::slice::from_ref(&column)).get(place).copied().unwrap_or(f64::NAN)
        });
    }
    let plan = plan.keep(["t"], |run| [run.stepper.time(run.state)]);
    scene.events().zip(scene.watches()).fold(plan, |plan, event| plan.section(section(&own, drawn, event)))
}

/// The name of a column's histogram beside its moments.
fn name_of(column: &str) -> String {
    format!("{column} (histogram)")
}

/// The section of an event: its times, and the members' columns then.
fn section(scenes: &Arc<Scenes>, drawn: &SceneEnsemble, (name, watch): (&str, Watch)) -> Section<AnyStepper> {
    let Watch { event, function, stops, .. } = watch;
    let section = Section::new(event, function);
    let section = if stops { section.until() } else { section };
    let section = section.keep([&format!("{name}_t")], |now| [now.time()]);
    columns(drawn).fold(section, |section, (column, place, own)| {
        let scenes = Arc::clone(scenes);
        section.keep([&format!("{name}_{own}")], move |now| {
            [scenes.file().numbers(std::slice::from_ref(&column), now).get(place).copied().unwrap_or(f64::NAN)]
        })
    })
}

/// The numbers of the members' columns: each with its column, its place there and its name.
fn columns(drawn: &SceneEnsemble) -> impl Iterator<Item = (Column, usize, &str)> {
    let numbers = |column| Column::names(column).enumerate().map(|(place, name)| (Column::clone(column), place, name));
    drawn.columns.iter().flat_map(numbers)
}

/// The line of a column of this name and unit, and one of the members that have no number there.
fn at_the_end(name: &str, unit: &str, moments: &Moments) -> String {
    // Angles are in degrees, as in the summary of a run.
    let (unit, size) = if unit == "rad" { ("deg", 1.0_f64.to_degrees()) } else { (unit, 1.0) };
    // Without any number the mean is zero.
    let mean = if moments.count == 0 { f64::NAN } else { moments.mean };
    let numbers = [mean, moments.variance().sqrt(), moments.least, moments.largest];
    let [mean, spread, least, largest] = numbers.map(|number| match number * size {
        number if number.is_finite() => format!("{number:.6e}"),
        _ => "–".to_owned(),
    });
    let line = format!("  {name:<20}{mean:>16}{spread:>16}{least:>16}{largest:>16}  {unit}");
    let mut text = format!("{}\n", line.trim_end());
    if moments.not_finite > 0 {
        let _ = writeln!(text, "  {:<20}{} members have no number there", "", moments.not_finite);
    }
    text
}

fn told_of(scene: &Scene, drawn: &SceneEnsemble, report: &Report, (is_share, folder): (bool, &str)) -> String {
    let of_share = if is_share { ", in this share" } else { "" };
    let SceneEnsemble { members, seed, .. } = drawn;
    let mut text = format!(
        "{}\n  {members} members drawn by the seed {seed}{of_share}: {}\n",
        scene.title(),
        counts(&report.outcome)
    );
    if !is_share && report.outcome.finished > 0 {
        let _ =
            writeln!(text, "  {:<20}{:>16}{:>16}{:>16}{:>16}", "at the end", "mean", "deviation", "least", "largest");
        for ((_, _, name), listed) in columns(drawn).zip(Column::listed(&drawn.columns)) {
            if let Some(Summary::Moments(moments)) = report.reduced(name) {
                text.push_str(&at_the_end(name, &listed.unit, moments));
            }
        }
        for one in &drawn.histograms {
            if let Some(Summary::Histogram(counted)) = report.reduced(&name_of(&one.column)) {
                text.push_str(&bars(one, counted));
            }
        }
    }
    if !is_share {
        let events = scene.events().zip(&report.outcome.passages);
        text.extend(events.map(|(name, passages)| of_event(name, &report.outcome, passages)));
    }
    let _ =
        writeln!(text, "Written to {folder}: {} chunks, {} of them now", report.chunks - report.missing, report.made);
    text
}

#[cfg(test)]
mod tests {
    use super::{Moments, at_the_end};

    #[test]
    fn members_without_a_number_are_counted() {
        let of = |count, not_finite, mean, [least, largest]: [f64; 2]| {
            let moments = Moments { count, not_finite, mean, squares: 0.0, least, largest };
            at_the_end("angle", "rad", &moments).split_whitespace().map(str::to_owned).collect::<Vec<_>>().join(" ")
        };
        let none = of(0, 3, 0.0, [f64::INFINITY, f64::NEG_INFINITY]);
        assert_eq!(none, "angle – – – – deg 3 members have no number there");
        let all = of(2, 0, 0.5, [0.5; 2]);
        assert_eq!(all, "angle 2.864789e1 0.000000e0 2.864789e1 2.864789e1 deg");
    }
}
