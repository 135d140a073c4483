//! Cases on which integrators of rigid bodies break: the errors of each after many steps, for our method and for
//! others.
//!
//! ```text
//! cargo run --release -p liestep-hard-cases --example hard-cases
//! cargo run --release -p liestep-hard-cases --example hard-cases -- --row T3 --long --out hard
//! ```
//!
//! Each row is a claim with a criterion that a program decides. The others are the updates of physics engines (the
//! explicit gyroscopic update, one implicit Newton step, the explicit update rescaled), the classical Runge–Kutta
//! method, and careless versions of this integrator; each has the same body and the same step, and its results aren't
//! judged. A row that misses its criterion is marked. Rows S to P are those of `tests/hard_cases`; R are rounding
//! errors that repeat at each step.

use std::path::PathBuf;
use std::process::ExitCode;

use cases::row::{Effort, Failure};
use cases::{report, rows};
use workbench::args::example;
use workbench::output::{Output, print};
use workbench::progress::Progress;

const HELP: &str = "Runs the hard cases, and writes a table of what is left of each

Options:
      --long       1e8 steps where the others have 1e6, and 3e7 of the chaotic top
      --row <ROW>  Only this row, as in T3
      --out <DIR>  The folder for the table [default: out/hard-cases]
  -h, --help       Print this
";

struct Arguments {
    long: bool,
    row: Option<String>,
    out: PathBuf,
}

fn main() -> ExitCode {
    example(HELP, |words| {
        let mut arguments = Arguments { long: false, row: None, out: "out/hard-cases".into() };
        while let Some(option) = words.option()? {
            match option.as_str() {
                "long" => arguments.long = true,
                "row" => arguments.row = Some(words.text()?),
                "out" => arguments.out = words.folder()?,
                _ => return Err(words.unknown()),
            }
        }
        run(&arguments)
    })
}

fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut output = Output::new(arguments.out.clone())?;
    let wanted = |id: &str| arguments.row.as_ref().is_none_or(|row| row.eq_ignore_ascii_case(id));
    let rows: Vec<_> = rows::ALL.into_iter().filter(|(id, _)| wanted(id)).collect();
    if rows.is_empty() {
        let ids: Vec<_> = rows::ALL.iter().map(|(id, _)| *id).collect();
        return Err(format!("--row is one of {}", ids.join(", ")).into());
    }
    let effort = Effort { long: arguments.long, verdict_only: false };
    let mut done = Vec::new();
    let mut progress = Progress::new(rows.len().try_into()?);
    for (id, measure) in rows {
        progress.add(0, id);
        done.push(measure(effort).map_err(|cause| format!("row {id}: {cause}"))?);
        progress.add(1, id);
    }
    drop(progress);
    output.write("hard-cases.md", &report::markdown(&done))?;
    print(&format!("{}\n\n{output}", report::text(&done)))?;
    Ok(())
}
