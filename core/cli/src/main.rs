//! The program `liestep`: rigid-body scenes from files.
//!
//! ```text
//! cargo install --path core/cli
//! liestep run examples/scenes/sleeping-top.toml
//! ```
//!
//! `liestep help` lists the commands. [`Failure`] lists the exit codes.

mod command;
mod ensemble;
mod failure;
mod files;
mod fmu;
mod interrupt;
mod members;
mod output;
mod sweep;
mod table;
mod tally;

use std::path::Path;
use std::process::ExitCode;

use clap::ArgMatches;
use liestep::recording::{Column, Csv, Sink, SinkError};
use liestep_arrow::ArrowStream;
use liestep_derivation::suggestion;
use liestep_plot::output::Output;
use liestep_scene::{Form, Import, Mistake, Run, Scene, Sums, visible};

use failure::Failure;
use files::{different_files, files, folder, name};
use output::{Progress, print};

fn main() -> ExitCode {
    // A wrong command line ends the program here, with a message and the code 2.
    let matches = command::command().get_matches();
    match answer(&matches) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("error: {}", visible(&failure.to_string()));
            failure.code()
        }
    }
}

fn answer(matches: &ArgMatches) -> Result<(), Failure> {
    match matches.subcommand() {
        Some(("run", given)) => run(given),
        Some(("check", given)) => check(given),
        Some(("sweep", given)) => sweep::sweep(given),
        Some(("ensemble", given)) => ensemble::ensemble(given, false),
        Some(("report", given)) => ensemble::ensemble(given, true),
        Some(("derive", given)) => derive(given),
        Some(("fmu", given)) => fmu::fmu(given),
        Some(("import", given)) => import(given),
        Some(("replay", given)) => replay(given),
        Some(("completions", given)) => command::complete(given),
        _ => Err(Failure::Command("a command is required; see --help".to_owned())),
    }
}

/// Extension of a stream of Arrow IPC. Readers expect the file format, another one, in `.arrow`.
const ARROW_STREAM: &str = "arrows";

fn run(given: &ArgMatches) -> Result<(), Failure> {
    let paths = different_files(given)?;
    let scenes: Vec<Scene> = paths.iter().map(Scene::read).collect::<Result<_, _>>()?;
    let mut output = folder(given)?;
    for (number, (path, scene)) in (1..).zip(paths.iter().zip(&scenes)) {
        if paths.len() > 1 {
            eprintln!("[{number}/{}] {}", paths.len(), visible(&path.display().to_string()));
        }
        run_scene(given, path, scene, &mut output)?;
    }
    print(&output.to_string())
}

fn run_scene(given: &ArgMatches, path: &Path, scene: &Scene, output: &mut Output) -> Result<(), Failure> {
    let run = simulate(given, path, output, scene)?;
    let picture = scene.picture(&run).map_err(|cause| Failure::Output(cause.to_string()))?;
    output.write(&name(path, "svg"), &picture)?;
    tables_have_grown(given, path, output)?;
    if given.get_flag("csv") && scene.events().next().is_some() {
        let table = scene.event_table(&run).map_err(|cause| Failure::Output(cause.to_string()))?;
        output.write(&name(path, "events.csv"), &table)?;
    }
    if given.get_flag("html") {
        output.write(&name(path, "html"), &scene.page(&run))?;
    }
    notes(&run);
    print(&(scene.summary(&run) + &scene.end_error(&run)))?;
    if let Some(sweep) = scene.sweep() {
        eprintln!("note: `liestep sweep` runs the {} scenes of the file's sweep", sweep.points.len());
    }
    if let Some(ensemble) = scene.ensemble() {
        eprintln!("note: `liestep ensemble` runs the {} members of the file's ensemble", ensemble.members);
    }
    Ok(())
}

/// Prints remarks about the file.
fn notes(run: &Run) {
    run.notes().iter().for_each(|note| eprintln!("note: {}", visible(&note.to_string())));
}

/// The extensions of the requested tables.
fn tables(given: &ArgMatches) -> impl Iterator<Item = &'static str> {
    let kinds = ["csv", "arrow"].into_iter().filter(|table| given.get_flag(table));
    kinds.map(|kind| if kind == "arrow" { ARROW_STREAM } else { kind })
}

fn tables_have_grown(given: &ArgMatches, path: &Path, output: &mut Output) -> Result<(), Failure> {
    Ok(tables(given).try_for_each(|table| output.grown(&name(path, table)))?)
}

/// The run; its tables are written while it grows.
fn simulate(given: &ArgMatches, path: &Path, output: &Output, scene: &Scene) -> Result<Run, Mistake> {
    let mut progress = Progress::new();
    let mut show = |share| progress.show(&format_args!("{:>3.0} %", 100.0 * share));
    let sink = |kind: &'static str| -> Box<dyn Sink> {
        let file = output.grows(&name(path, kind));
        if kind == ARROW_STREAM { Box::new(ArrowStream::new(file)) } else { Box::new(Csv::new(file)) }
    };
    let mut tables = Tables(tables(given).map(sink).collect());
    let has_tables = !tables.0.is_empty();
    scene.run_with(&mut show, has_tables.then_some(&mut tables as &mut dyn Sink))
}

/// A sink that writes several tables of one run.
struct Tables(Vec<Box<dyn Sink>>);

impl Sink for Tables {
    fn begin(&mut self, columns: &[Column]) -> Result<(), SinkError> {
        self.0.iter_mut().try_for_each(|table| table.begin(columns))
    }

    fn write(&mut self, rows: &[f64]) -> Result<(), SinkError> {
        self.0.iter_mut().try_for_each(|table| table.write(rows))
    }

    fn end(&mut self) -> Result<(), SinkError> {
        // Every table is ended, even after one that fails.
        self.0.iter_mut().map(|table| table.end()).fold(Ok(()), Result::and)
    }
}

/// Checks all files, and reports the mistakes of each.
fn check(given: &ArgMatches) -> Result<(), Failure> {
    let mut wrong: Option<Failure> = None;
    for path in files(given) {
        match checked(path) {
            Ok(about) => print(&format!("{}: {about}", path.display()))?,
            Err(failure) => {
                if let Some(before) = wrong.replace(failure) {
                    eprintln!("error: {}", visible(&before.to_string()));
                }
            }
        }
    }
    wrong.map_or(Ok(()), Err)
}

/// A description of a file, after the first step of each of its scenes.
fn checked(path: &Path) -> Result<String, Failure> {
    let scene = Scene::read(path)?;
    let about = scene.about() + "\n";
    // The trial runs for an accuracy take as long as a run, so they are left out.
    if scene.asks_for_accuracy() {
        return Ok(about);
    }
    let first = scene.first(1)?;
    notes(&first);
    for (_, point) in scene.sweep().map(|sweep| sweep.points.as_slice()).unwrap_or_default() {
        point.first(1)?;
    }
    Ok(about + &scene.changes(&first))
}

/// The forms of a derivation, by their flags.
const fn forms(sums: Sums) -> [(&'static str, Form); 7] {
    [
        ("latex", Form::Latex),
        ("rust", Form::Rust),
        ("c", Form::C(sums)),
        ("header", Form::Header(sums)),
        ("gpu", Form::Gpu(sums)),
        ("js", Form::JavaScript),
        ("certificate", Form::Certificate),
    ]
}

fn derive(given: &ArgMatches) -> Result<(), Failure> {
    let Some(name) = given.get_one::<String>("NAME") else {
        let names: Vec<_> = liestep_scene::derived().collect();
        return print(&(names.join("\n") + "\n"));
    };
    let sums = if given.get_flag("compensated") { Sums::Compensated } else { Sums::Rounded };
    let form = forms(sums).into_iter().find(|(flag, _)| given.get_flag(flag)).map(|(_, form)| form);
    if let Some(form) = form
        && let Some(written) = liestep_scene::written(name, form)
    {
        return print(&written.map_err(|cause| Failure::Command(cause.to_string()))?);
    }
    if let Some(text) = liestep_scene::derivation(name) {
        return print(&format!("{name}\n\n{text}"));
    }
    if Path::new(name).extension().is_some_and(|ending| ending == "toml") {
        let scene = Scene::read(name)?;
        let Some(form) = form else { return print(&scene.derivation()) };
        let none = || "of several bodies there is the derivation as text: leave the form out".to_owned();
        let written = scene.written(form).ok_or_else(|| Failure::Command(none()))?;
        return print(&written.map_err(|cause| Failure::Command(cause.to_string()))?);
    }
    let names: Vec<_> = liestep_scene::derived().collect();
    let nearest = suggestion(name, names.iter().map(String::as_str));
    let message = format!("'{name}' is neither a scene file (*.toml) nor one of {}{nearest}", names.join(", "));
    Err(Failure::Command(message))
}

/// Writes scenes of models. Each is read again before it is written, so that it is one.
fn import(given: &ArgMatches) -> Result<(), Failure> {
    let paths = different_files(given)?;
    let floats = given.get_flag("floating");
    let imports = paths.iter().map(|path| liestep_scene::import(path, floats)).collect::<Result<Vec<_>, _>>()?;
    let mut output = folder(given)?;
    for (path, Import { text, remarks }) in paths.iter().zip(&imports) {
        for remark in remarks {
            eprintln!("note: {}: {}", visible(&path.display().to_string()), visible(remark));
        }
        let written = name(path, "toml");
        Scene::parse(&written, text)?;
        output.write(&written, text)?;
    }
    print(&output.to_string())
}

fn replay(given: &ArgMatches) -> Result<(), Failure> {
    let paths = different_files(given)?;
    let recordings: Vec<_> = paths.iter().map(liestep_scene::Recording::read).collect::<Result<_, _>>()?;
    let mut output = folder(given)?;
    for (path, recording) in paths.iter().zip(&recordings) {
        output.write(&name(path, "html"), &recording.page())?;
    }
    print(&output.to_string())
}
