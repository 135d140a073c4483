//! Planned motions, and one that is estimated from its readings.
//!
//! ```text
//! cargo run --release -p liestep-examples --example manoeuvres                       all of them
//! cargo run --release -p liestep-examples --example manoeuvres -- slew sun           some
//! ```
//!
//! | task | subject |
//! |---|---|
//! | `slew` | the shortest half turn of a sphere with a bounded torque about each axis, and that about one axis |
//! | `sun` | the least effort of a turn during which an instrument must not look into the sun |
//! | `top` | a hanging top is swung up to stand on its tip, by a torque that couldn't hold it level |
//! | `cat` | a body without angular momentum turns by two wheels alone, whose final angles are the initial ones |
//! | `load` | a flyer moves a load on a cable from rest to rest |
//! | `horizon` | attitude and a gyroscope's bias from the last two seconds, compared with a Kalman filter |
//!
//! Each example writes its picture into the folder, and its numbers.

#![allow(clippy::cast_precision_loss)] // hundreds of steps

mod cat;
mod horizon;
mod load;
mod slew;

use std::process::ExitCode;

use liestep_control::{ControlPlan, Verdict};
use workbench::args::{Failure, Word, example};
use workbench::output::{Output, print};
use workbench::plot::{Colour, Line, Panel, Path, PlotResult, Vertical, heading, legend, px, render, sphere};

const HELP: &str = "Plans motions, and finds one again from its readings

Arguments:
  [NAME]...             slew, sun, top, cat, load, horizon [default: all]

Options:
      --out <DIR>       The folder for the pictures [default: out/manoeuvres]
  -h, --help            Print this
";

/// A report, and a picture.
type Drawing = Result<(String, String), Failure>;
/// A manoeuvre with its name.
type Manoeuvre = (&'static str, fn() -> Drawing);
const ALL: [Manoeuvre; 6] = [
    ("slew", slew::half_turn),
    ("sun", slew::sun),
    ("top", slew::top),
    ("cat", cat::cat),
    ("load", load::load),
    ("horizon", horizon::horizon),
];

fn main() -> ExitCode {
    example(HELP, |words| {
        let (mut folder, mut chosen) = ("out/manoeuvres".into(), Vec::new());
        while let Some(word) = words.word()? {
            match word {
                Word::Option(name) if name == "out" => folder = words.folder()?,
                Word::Option(_) => return Err(words.unknown()),
                Word::Plain(name) => {
                    let known = ALL.into_iter().find(|(known, _)| name == *known);
                    chosen.push(known.ok_or_else(|| format!("no manoeuvre '{}'; see --help", name.display()))?);
                }
            }
        }
        let mut output = Output::new(folder)?;
        for (name, run) in if chosen.is_empty() { ALL.to_vec() } else { chosen } {
            let (report, picture) = run()?;
            output.write(&format!("{name}.svg"), &picture)?;
            print(&format!("{name}: {report}\n"))?;
        }
        Ok(print(&output.to_string())?)
    })
}

/// A summary of a plan's search, or the reason for its failure.
fn found<M: liestep::gradients::Plant>(plan: &ControlPlan<M>) -> Result<String, Failure> {
    match plan.verdict {
        Verdict::Converged => Ok(format!(
            "{} steps, {} iterations, residual {:.0e}",
            plan.inputs.len(),
            plan.iterations,
            plan.residual.largest()
        )),
        ref other => Err(format!("no plan: {other:?}").into()),
    }
}

/// A part of a picture: a path on the sphere, or lines with their names.
enum Part<'a> {
    Way(Path<'a>),
    Lines(Panel<'a>, &'a [(&'a str, Colour)]),
}

/// Parts of a picture side by side.
fn picture(title: &str, below: &str, parts: &[Part<'_>]) -> Result<String, Failure> {
    let drawn: PlotResult<String> = render((900, 420), |area| {
        heading(area, title, below)?;
        let (_, body) = area.split_vertically(px(56));
        for (area, part) in body.split_evenly((1, parts.len())).iter().zip(parts) {
            match part {
                Part::Way(path) => sphere(area, path)?,
                Part::Lines(panel, names) => {
                    panel.draw(area)?;
                    legend(area, (70, 34), names)?;
                }
            }
        }
        Ok(())
    });
    drawn
}

/// Inputs over time, one line for each component: they are constant over a step.
fn given<'a, const N: usize>(
    (title, up, names): (&'a str, &'a str, &'a [(&'a str, Colour)]),
    step: f64,
    values: &[[f64; N]],
) -> Part<'a> {
    let line = |component: usize| {
        let held = |(n, value): (usize, &[f64; N])| [n, n + 1].map(|n| (n as f64 * step, value[component]));
        Line { colour: names[component].1, width: 3, points: values.iter().enumerate().flat_map(held).collect() }
    };
    Part::Lines(Panel::over_time(title, up, Vertical::Linear, (0..N).map(line).collect()), names)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_plan_is_found() {
        for (name, run) in &ALL[..5] {
            let (report, picture) = run().unwrap_or_else(|error| panic!("{name}: {error}"));
            assert!(!report.is_empty() && picture.starts_with("<svg"));
        }
    }
}
