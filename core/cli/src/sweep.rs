//! Every scene of a sweep, on all processors.

use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use clap::ArgMatches;
use liestep_scene::{Mistake, SceneFile, Sweep};

use crate::failure::Failure;
use crate::output::print;
use crate::{files, folder, name, scenes};

pub(crate) fn sweep(given: &ArgMatches) -> Result<(), Failure> {
    let paths = files(given);
    let scenes = scenes(&paths)?;
    let sweeps: Vec<(&Path, &Sweep)> = paths
        .iter()
        .zip(&scenes)
        .map(|(path, scene)| {
            let sweep = scene.sweep().ok_or_else(|| Mistake::no_table(path, "sweep"))?;
            Ok((path.as_path(), sweep))
        })
        .collect::<Result<_, Mistake>>()?;
    let mut output = folder(given)?;
    let mut stopped = 0;
    for (path, sweep) in sweeps {
        let points: Vec<&SceneFile> = sweep.points().iter().map(|(_, scene)| scene).collect();
        let ends = in_parallel(&points, |scene| scene.run().map(|run| scene.end(&run)));
        let mut text = sweep.names().join(",");
        for name in points.first().map(|scene| scene.end_names()).unwrap_or_default() {
            text.extend([",", &name]);
        }
        text.push('\n');
        for ((values, scene), end) in sweep.points().iter().zip(ends) {
            text.push_str(&values.join(","));
            match end {
                Ok(end) => text.extend(end.iter().map(|value| format!(",{value:e}"))),
                Err(mistake) => {
                    stopped += 1;
                    text.extend(scene.end_names().iter().map(|_| ","));
                    let point: Vec<_> =
                        sweep.names().iter().zip(values).map(|(name, value)| format!("{name} = {value}")).collect();
                    eprintln!("note: {} gave no row: {mistake}", point.join(", "));
                }
            }
            text.push('\n');
        }
        output.write(&name(path, "csv"), &text)?;
    }
    print(&output.to_string())?;
    if stopped == 0 { Ok(()) } else { Err(Failure::Runs(format!("{stopped} scenes of the sweep stopped"))) }
}

/// The answers in their order, whoever gives them.
fn in_parallel<T: Sync, R: Send>(questions: &[T], answer: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let next = AtomicUsize::new(0);
    let answers: Vec<Mutex<Option<R>>> = questions.iter().map(|_| Mutex::new(None)).collect();
    let threads = thread::available_parallelism().map_or(1, usize::from).min(questions.len());
    thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                while let Some((question, place)) = {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    questions.get(number).zip(answers.get(number))
                } {
                    let answer = answer(question);
                    if let Ok(mut place) = place.lock() {
                        *place = Some(answer);
                    }
                }
            });
        }
    });
    // A thread that panicked has ended the scope with its panic, so each has an answer.
    answers.into_iter().filter_map(|answer| answer.into_inner().ok().flatten()).collect()
}
