//! Cases on which integrators of rigid bodies break: what is left of each after these steps, of ours and of others'.
//!
//! ```text
//! cargo run --release --example hard-cases
//! cargo run --release --example hard-cases -- --row T3 --long --out hard
//! ```
//!
//! Each row is a claim with a criterion that a program decides. The others are what physics engines do (the explicit
//! gyroscopic update, one implicit Newton step, the explicit update rescaled), the classical Runge–Kutta method, and
//! careless versions of this integrator; each gets the same body and the same step, and is printed as it comes. A row
//! that misses its criterion says so. Rows S to P are those of `tests/hard_cases`, R is what rounding does where it is
//! always the same.

use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Duration;

use cases::curves::Curves;
use cases::row::{Effort, Failure};
use cases::{figure, report, rows};
use clap::Parser;
use indicatif::{ProgressBar, ProgressStyle};
use workbench::output::{Output, print};

/// Runs the hard cases, and writes a table and a figure of what is left of each.
#[derive(Parser)]
#[command(name = "hard-cases")]
struct Arguments {
    /// 1e8 steps where the others have 1e6, and 3e7 of the chaotic top.
    #[arg(long)]
    long: bool,
    /// Only this row, as in T3; the figure then has what that row measures.
    #[arg(long, value_name = "ROW")]
    row: Option<String>,
    /// The folder for the table and the figure.
    #[arg(long, value_name = "DIR", default_value = "out/hard-cases")]
    out: PathBuf,
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut output = Output::new(arguments.out.clone())?;
    let wanted = |id: &str| arguments.row.as_ref().is_none_or(|row| row.eq_ignore_ascii_case(id));
    let rows: Vec<_> = rows::ALL.into_iter().filter(|(id, _)| wanted(id)).collect();
    if rows.is_empty() {
        let ids: Vec<_> = rows::ALL.iter().map(|(id, _)| *id).collect();
        return Err(format!("--row is one of {}", ids.join(", ")).into());
    }
    let effort = Effort { long: arguments.long };
    let (mut done, mut curves) = (Vec::new(), Curves::default());
    let bar = progress(rows.len().try_into()?);
    for (id, measure) in rows {
        bar.set_message(id);
        done.push(measure(effort, &mut curves).map_err(|cause| format!("row {id}: {cause}"))?);
        bar.inc(1);
    }
    bar.finish_and_clear();
    output.write("hard-cases.md", &report::markdown(&done))?;
    output.write("hard-cases.csv", &report::csv(&done))?;
    if !curves.is_empty() {
        output.write("hard-cases.svg", &figure::figure(&curves)?)?;
    }
    print(&format!("{}\n\n{output}", report::text(&done)))?;
    Ok(())
}

fn progress(rows: u64) -> ProgressBar {
    let bar = ProgressBar::new(rows);
    let style = ProgressStyle::with_template("{bar:40} {pos}/{len}  {elapsed}  row {msg}");
    let bar = if let Ok(style) = style { bar.with_style(style) } else { bar };
    bar.enable_steady_tick(Duration::from_millis(500));
    bar
}
