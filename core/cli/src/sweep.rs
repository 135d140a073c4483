//! The scenes of a sweep, on all processors.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;
use std::thread;

use clap::ArgMatches;
use liestep_plot::output::Output;
use liestep_scene::{Mistake, Scene, Sweep};

use crate::failure::Failure;
use crate::files::{different_files, folder, name};
use crate::output::print;
use crate::table::{digits, printed};

pub(crate) fn sweep(given: &ArgMatches) -> Result<(), Failure> {
    let paths = different_files(given)?;
    let scenes: Vec<Scene> = paths.iter().map(Scene::read).collect::<Result<_, _>>()?;
    if let Some((path, _)) = paths.iter().zip(&scenes).find(|(_, scene)| scene.sweep().is_none()) {
        return Err(Mistake::no_table(path, "sweep").into());
    }
    let mut output = folder(given)?;
    let mut stopped = 0;
    for (path, sweep) in paths.iter().zip(scenes.iter().filter_map(Scene::sweep)) {
        stopped += rows(path, sweep, &mut output)?;
    }
    print(&output.to_string())?;
    if stopped == 0 { Ok(()) } else { Err(Failure::Runs(format!("{stopped} scenes of the sweep stopped"))) }
}

/// Writes the table of a sweep and prints it; returns how many of its scenes stopped.
fn rows(path: &Path, sweep: &Sweep<Scene>, output: &mut Output) -> Result<usize, Failure> {
    // The table of a sweep has another name than that of a single run.
    let name = name(path, "sweep.csv");
    let (mut file, mut stopped) = (output.grows(&name), 0);
    let points = &sweep.points;
    let ends = points.first().map(|(_, scene)| scene.end_names()).unwrap_or_default();
    let head: Vec<&str> = sweep.names.iter().chain(&ends).map(String::as_str).collect();
    file.add(&format!("{}\n", head.join(",")))?;
    let mut table = Vec::new();
    in_order(
        points,
        |(_, scene): &(Vec<String>, Scene)| scene.run().map(|run| scene.end(&run)),
        |(values, _), end| {
            let (mut row, mut cells) = (values.join(","), values.clone());
            match end {
                Ok(end) => {
                    row.extend(end.iter().map(|value| format!(",{value:?}")));
                    cells.extend(end.iter().map(|value| digits(*value)));
                }
                Err(mistake) => {
                    stopped += 1;
                    row.push_str(&",".repeat(ends.len()));
                    let point: Vec<_> =
                        sweep.names.iter().zip(values).map(|(name, value)| format!("{name} = {value}")).collect();
                    eprintln!("note: {} gave no row: {mistake}", point.join(", "));
                }
            }
            row.push('\n');
            table.push(cells);
            Ok(file.add(&row)?)
        },
    )?;
    drop(file);
    output.grown(&name)?;
    print(&printed(&head, &table, &name))?;
    Ok(stopped)
}

/// Computes answers on all threads, and passes them to `take` in order, as early as possible.
fn in_order<T: Sync, R: Send>(
    questions: &[T],
    answer: impl Fn(&T) -> R + Sync,
    mut take: impl FnMut(&T, R) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let (next, answer) = (&AtomicUsize::new(0), &answer);
    let threads = thread::available_parallelism().map_or(1, usize::from).min(questions.len());
    thread::scope(|scope| {
        let (sender, answers) = mpsc::channel();
        for number in 0..threads {
            let sender = sender.clone();
            let started = thread::Builder::new().spawn_scoped(scope, move || {
                while let Some((number, question)) = {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    questions.get(number).map(|question| (number, question))
                } {
                    // The receiver is gone if a row couldn't be written.
                    if sender.send((number, answer(question))).is_err() {
                        break;
                    }
                }
            });
            // Fewer threads answer all questions, too.
            match started {
                Err(error) if number == 0 => return Err(Failure::Runs(format!("no thread starts: {error}"))),
                Err(_) => break,
                Ok(_) => {}
            }
        }
        drop(sender);
        let mut waiting = BTreeMap::new();
        let mut due = 0;
        for (number, answer) in answers {
            waiting.insert(number, answer);
            while let Some(answer) = waiting.remove(&due) {
                take(&questions[due], answer)?;
                due += 1;
            }
        }
        Ok(())
    })
}
