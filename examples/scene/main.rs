//! Simulates the scene that a file describes, and draws it.
//!
//! ```text
//! cargo run --release --example scene -- examples/scenes/sleeping-top.toml
//! cargo run --release --example scene -- examples/scenes/*.toml --out pictures --csv
//! ```
//!
//! A file names a body, the effects on it, where the motion starts, the step or an accuracy, and what to draw; the
//! files in `examples/scenes` show every key. Numbers are in SI units, or texts with a unit: `"30 deg"`. An effect
//! that a file doesn't name is switched off: the run has the bits of the sum of just those that it names, of which a
//! program of its own would step faster. A mistake in a file is reported with its line and column.

mod scene;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use workbench::args::{Failure, Word, example};
use workbench::output::{Output, print};

const HELP: &str = "Simulates the scenes that files describe, and draws them

Arguments:
  <FILE>...        The scene files

Options:
      --out <DIR>  The folder for the pictures [default: out/scenes]
      --csv        Also write the samples as CSV, next to the pictures
  -h, --help       Print this
";

struct Arguments {
    files: Vec<PathBuf>,
    out: PathBuf,
    csv: bool,
}

fn main() -> ExitCode {
    example(HELP, |words| {
        let mut arguments = Arguments { files: Vec::new(), out: "out/scenes".into(), csv: false };
        while let Some(word) = words.word()? {
            match word {
                Word::Plain(file) => arguments.files.push(file.into()),
                Word::Option(option) => match option.as_str() {
                    "out" => arguments.out = words.folder()?,
                    "csv" => arguments.csv = true,
                    _ => return Err(words.unknown()),
                },
            }
        }
        if arguments.files.is_empty() {
            return Err("the required arguments were not provided: a scene file; see --help".into());
        }
        simulate(&arguments)
    })
}

fn simulate(arguments: &Arguments) -> Result<(), Failure> {
    // All files are read before the first is simulated, so a mistake in the last doesn't come after minutes.
    let scenes = arguments.files.iter().map(|path| scene::read(path)).collect::<Result<Vec<_>, _>>()?;
    let mut output = Output::new(arguments.out.clone())?;
    let count = scenes.len();
    for (number, (path, file)) in (1..).zip(arguments.files.iter().zip(&scenes)) {
        if count > 1 {
            eprintln!("[{number}/{count}] {}", path.display());
        }
        let run = scene::run(file).map_err(|stopped| format!("{}: {stopped}", path.display()))?;
        output.write(&name(path, "svg"), &scene::picture(file, &run)?)?;
        if arguments.csv {
            output.write(&name(path, "csv"), &scene::table(&run.samples))?;
        }
        print(&run.summary(file))?;
    }
    print(&output.to_string())?;
    Ok(())
}

/// The file's name with another ending.
fn name(path: &Path, extension: &str) -> String {
    let stem = path.file_stem().unwrap_or(path.as_os_str());
    format!("{}.{extension}", stem.to_string_lossy())
}
