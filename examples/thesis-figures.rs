//! Figures 3.1 to 3.10 of the thesis, one by one.
//!
//! ```text
//! cargo run --release -p liestep-examples --example thesis-figures -- --out examples/figures/thesis
//! ```
//!
//! `examples/figures/thesis/README.md` displays them, with the thesis' text on each and the reasons for differences.

use std::path::PathBuf;
use std::process::ExitCode;

use workbench::args::{Failure, example};
use workbench::heavy_top::cases::{Case, Reading};
use workbench::heavy_top::drawings;
use workbench::heavy_top::figures::{Figures, precessions};
use workbench::heavy_top::quantities::Series;
use workbench::heavy_top::runs::all_methods;
use workbench::output::{Output, print};
use workbench::run::Schedule;

const HELP: &str = "Draws figures 3.1 to 3.10 of the thesis

Options:
      --out <DIR>  The folder for the figures [default: out/thesis-figures]
  -h, --help       Print this
";

/// The step of most figures and the thesis' time, s.
const STEP: f64 = 0.01;
const TIME: f64 = 200.0;

/// A step by which Runge–Kutta in nine entries loses its path within the thesis' 200 s; by 0.01 s it doesn't.
const COARSE: f64 = 0.05;

/// The duration of about one revolution, s.
const ROUND: f64 = 25.0;

fn main() -> ExitCode {
    example(HELP, |words| {
        let mut out = PathBuf::from("out/thesis-figures");
        while let Some(option) = words.option()? {
            match option.as_str() {
                "out" => out = words.folder()?,
                _ => return Err(words.unknown()),
            }
        }
        draw(&mut Output::new(out)?)
    })
}

fn draw(output: &mut Output) -> Result<(), Failure> {
    output.write("3-1.svg", &drawings::euler_angles()?)?;
    output.write("3-2.svg", &drawings::top()?)?;

    let round = Schedule::new(STEP, ROUND)?;
    let kinds = [
        ("looping: case 3.8, J_d = diag(2, 2, 1)", Case::Looping, Reading::A),
        ("cuspidal: case 3.9, J_d = diag(2, 2, 1)", Case::Cuspidal, Reading::A),
        ("unidirectional: case 3.10, J = diag(2, 2, 1)", Case::Unidirectional, Reading::B),
    ];
    let mut runs = Vec::new();
    for (name, case, reading) in kinds {
        runs.push((name, all_methods(case, reading, &round)?));
    }
    let paths: Vec<(&str, &Series)> = runs.iter().map(|(name, series)| (*name, &series[0])).collect();
    output.write("3-3.svg", &precessions(&paths, ROUND)?)?;

    let schedule = Schedule::new(STEP, TIME)?;
    let series = all_methods(Case::Looping, Reading::A, &schedule)?;
    let figures = Figures { case: Case::Looping, reading: Reading::A, schedule, series: &series };
    output.write("3-4.svg", &figures.rigidity()?)?;
    output.write("3-5.svg", &figures.momentum()?)?;
    output.write("3-6.svg", &figures.energy()?)?;
    output.write("3-7.svg", &figures.body_rates()?)?;

    let schedule = Schedule::new(COARSE, TIME)?;
    for (file, (_, case, reading)) in ["3-8.svg", "3-9.svg", "3-10.svg"].into_iter().zip(kinds) {
        output.write(file, &path(case, reading, schedule)?)?;
    }
    print(&format!("{output}"))?;
    Ok(())
}

fn path(case: Case, reading: Reading, schedule: Schedule) -> Result<String, Failure> {
    let series = all_methods(case, reading, &schedule)?;
    Figures { case, reading, schedule, series: &series }.tip()
}
