//! The heavy top of the thesis, for 200 s, beside two Runge–Kutta methods of order 4 at the same step.
//!
//! ```text
//! cargo heavy-top
//! cargo heavy-top --case cuspidal --reading b --step 0.02 --out top --csv
//! ```
//!
//! It prints the conservation errors of each method and the time of a step, and draws figures 3.4 to 3.10 again:
//! rigidity, vertical momentum, energy, body rates, and the path of the tip on the sphere. One rival represents the
//! attitude by a quaternion that it normalises, as a careful user would; the other by the nine entries of `R`, as in
//! the thesis.
//!
//! At a small step the rivals, of order 4, have the smaller energy error. The growth of that error, the momentum and,
//! for the nine entries, the rigidity show the difference; so does `--step 0.05`.
//!
//! Every figure names its reading of the thesis' `diag(2, 2, 1)`: as `J_d` (A, as in (3.13)) or as `J` (B).

use std::path::PathBuf;
use std::process::ExitCode;

use workbench::args::{Failure, example};
use workbench::heavy_top::cases::{Case, Reading};
use workbench::heavy_top::figures::Figures;
use workbench::heavy_top::overview::overview;
use workbench::heavy_top::quantities::Series;
use workbench::heavy_top::runs::all_methods;
use workbench::output::{Output, print};
use workbench::run::Schedule;
use workbench::table::{aligned, number, short};

const HELP: &str = "Simulates the heavy top of the thesis and draws its figures 3.4 to 3.10 again

Options:
      --case <CASE>     The initial condition, named as in the thesis: looping, cuspidal or unidirectional
                        [default: looping]
      --reading <A|B>   What the thesis' diag(2, 2, 1) stands for: the nonstandard inertia J_d or the ordinary J
                        [default: a]
      --step <SECONDS>  The step, s [default: 0.01]
      --time <SECONDS>  The time to simulate, s [default: 200]
      --out <DIR>       The folder for the figures [default: out/heavy-top]
      --csv             Also write every series as CSV, next to the figures
  -h, --help            Print this
";

struct Arguments {
    case: Case,
    reading: Reading,
    /// The step, s.
    step: f64,
    /// The duration, s.
    time: f64,
    out: PathBuf,
    csv: bool,
}

fn main() -> ExitCode {
    example(HELP, |words| {
        let (case, reading, out) = (Case::Looping, Reading::A, "out/heavy-top".into());
        let mut arguments = Arguments { case, reading, step: 0.01, time: 200.0, out, csv: false };
        while let Some(option) = words.option()? {
            match option.as_str() {
                "case" => arguments.case = words.one_of(&Case::NAMED)?,
                "reading" => arguments.reading = words.one_of(&Reading::NAMED)?,
                "step" => arguments.step = words.seconds()?,
                "time" => arguments.time = words.seconds()?,
                "out" => arguments.out = words.folder()?,
                "csv" => arguments.csv = true,
                _ => return Err(words.unknown()),
            }
        }
        simulate(&arguments)
    })
}

fn simulate(arguments: &Arguments) -> Result<(), Failure> {
    let Arguments { case, reading, .. } = *arguments;
    let schedule = Schedule::new(arguments.step, arguments.time)?;
    let mut output = Output::new(arguments.out.clone())?;

    let series = all_methods(case, reading, &schedule)?;
    let figures = Figures { case, reading, schedule, series: &series };
    output.write("heavy-top.svg", &overview(&figures)?)?;
    figures.write(&mut output)?;
    for other in Case::NAMED.map(|(_, case)| case).into_iter().filter(|other| *other != case) {
        match all_methods(other, reading, &schedule) {
            Ok(series) => Figures { case: other, reading, schedule, series: &series }.write_tip(&mut output)?,
            // The requested case succeeded; another may turn too fast for the step.
            Err(cause) => eprintln!("note: no path of the tip for the case {other}: {cause}"),
        }
    }
    if arguments.csv {
        for method in &series {
            output.write(method.file, &method.csv())?;
        }
    }
    let (h, steps) = (schedule.step, schedule.steps);
    let end = short(schedule.end());
    let caveat = case.caveat(reading).map_or_else(String::new, |text| format!("{text}\n"));
    print(&format!(
        "Heavy top: {case}, {reading}, steps of {h} s to t = {end} s, {steps} in all.\n{caveat}\n{}\n\n{output}",
        summary(&series),
    ))?;
    Ok(())
}

/// The greatest deviations over the run, and the time of a step.
fn summary(series: &[Series]) -> String {
    let mut rows = vec![
        ["method", "‖RᵀR − I‖", "Δ e₃·RΠ, rel.", "Δ energy, rel.", "growing", "Newton its/step", "ns/step"]
            .map(str::to_owned)
            .to_vec(),
    ];
    for s in series {
        let start = s.first();
        rows.push(vec![
            s.name.to_owned(),
            number(s.largest(|q| q.defect)),
            number(s.largest(|q| ((q.vertical - start.vertical) / start.vertical).abs())),
            number(s.largest(|q| ((q.energy - start.energy) / start.energy).abs())),
            times(s.growth(|q| (q.energy - start.energy).abs())),
            if s.iterations > 0.0 { format!("{:.2}", s.iterations) } else { "–".to_owned() },
            format!("{:.0}", s.nanoseconds),
        ]);
    }
    let table = aligned(&rows);
    format!(
        "Greatest deviations in the run, and the cost of a step. Growing: how much larger the energy's deviation is in\n\
         the last tenth of the run than in the first; 1 for an oscillation, 10 for a steady drift.\n\n{table}"
    )
}

fn times(factor: f64) -> String {
    if factor.is_finite() { format!("{factor:.1}×") } else { "–".to_owned() }
}
