//! A body that spins about its middle axis and flips (Dzhanibekov's wing nut), beside the updates of physics engines.
//!
//! ```text
//! cargo run --release --example free-rigid-body
//! cargo run --release --example free-rigid-body -- --step 0.02 --time 1000 --out flips --csv
//! ```
//!
//! Nothing acts on the body, so that its energy and its angular momentum in space are constant, and the time between
//! flips follows from them. It prints and draws what is left of them after the same steps with the derived integrator,
//! with the explicit gyroscopic update, with one implicit Newton step on it, and with the explicit update rescaled to
//! the momentum's length. All rivals keep the attitude in a normalised quaternion.
//!
//! The explicit and the implicit update lose the energy and yet flip almost on time. That is no merit: the rates grow
//! (or shrink) while the motion nears (or leaves) the separatrix, where it lingers, and to first order in the step the
//! two effects on the period cancel. The rescaled update stops the growth alone, and its flips come late.

use std::process::ExitCode;

use liestep::prelude::*;
use nalgebra::{UnitQuaternion, Vector3};
use workbench::args::{Common, Failure, example};
use workbench::common_help;
use workbench::free_body::engines::{Engine, Moments, explicit, implicit, rescaled};
use workbench::free_body::figures::Figures;
use workbench::free_body::overview::overview;
use workbench::free_body::quantities::Series;
use workbench::output::{Output, print};
use workbench::plot::{BLUE, GREEN, ORANGE, PURPLE};
use workbench::run::run;
use workbench::table::{aligned, number, short};
use workbench::variational::Variational;

/// The period from J = diag(1, 2, 3) and Ω = (0.01, 2, 0.02), in s, there and back in two flips: that of the Jacobi
/// elliptic function that the middle rate is.
const PERIOD: f64 = 19.001_635_511_000_25;

const HELP: &str = concat!(
    "Simulates a free rigid body that flips, beside the updates of physics engines

Options:
",
    common_help!()
);

fn main() -> ExitCode {
    example(HELP, |words| {
        let mut arguments = Common::default();
        while let Some(option) = words.option()? {
            arguments.take(&option, words)?;
        }
        simulate(&arguments)
    })
}

fn simulate(arguments: &Common) -> Result<(), Failure> {
    let schedule = arguments.schedule()?;
    let mut output = Output::new(arguments.folder("free-rigid-body"))?;

    let inertia = DiagonalNonstandardInertia::from_principal_moments(Vector3::new(1.0, 2.0, 3.0))?;
    let stepper = Stepper::new(PrincipalBody { J_d: inertia }, schedule.step)?;
    let (attitude, rates) = (UnitQuaternion::identity(), Vector3::new(0.01, 2.0, 0.02));
    let state = stepper.start(attitude, rates)?;
    let body = Moments::of(stepper.scene());
    let h = schedule.step;

    let ours = run("variational", Variational { stepper: &stepper, state }, &schedule)?;
    let explicit = run("explicit", Engine { body, h, attitude, rates, update: explicit }, &schedule)?;
    let implicit = run("implicit", Engine { body, h, attitude, rates, update: implicit }, &schedule)?;
    let rescaled = run("rescaled", Engine { body, h, attitude, rates, update: rescaled }, &schedule)?;
    let series = [
        Series::new("variational", "variational.csv", BLUE, &body, &ours),
        Series::new("explicit gyroscopic", "explicit.csv", ORANGE, &body, &explicit),
        Series::new("implicit, one Newton step", "implicit.csv", GREEN, &body, &implicit),
        Series::new("explicit, rescaled", "rescaled.csv", PURPLE, &body, &rescaled),
    ];

    let figures = Figures { schedule, series: &series };
    output.write("free-rigid-body.svg", &overview(&figures)?)?;
    figures.write(&mut output)?;
    if arguments.csv {
        for method in &series {
            output.write(method.file, &method.csv())?;
        }
    }
    let (steps, end) = (schedule.steps, short(schedule.end()));
    print(&format!(
        "Free rigid body, J = diag(1, 2, 3), Ω(0) = (0.01, 2, 0.02), steps of {h} s to t = {end} s, {steps} in all.\n\n\
         {}\n\n{output}",
        summary(&series),
    ))?;
    Ok(())
}

/// The greatest deviations over the run, the flips, and what a step costs.
fn summary(series: &[Series]) -> String {
    let names =
        ["method", "Δ energy, rel.", "Δ RΠ, rel.", "flips", "period, s", "period off", "Newton its/step", "ns/step"];
    let mut rows = vec![names.map(str::to_owned).to_vec()];
    let largest = |errors: &mut dyn Iterator<Item = (f64, f64)>| {
        errors.map(|(_, e)| e).fold(0.0, |most: f64, e| if most.is_nan() || e <= most { most } else { e })
    };
    for s in series {
        let flips = s.flips();
        let (period, off) = period(&flips).map_or_else(
            || ("–".to_owned(), "–".to_owned()),
            |period| (format!("{period:.4}"), format!("{:+.1e}", period / PERIOD - 1.0)),
        );
        rows.push(vec![
            s.name.to_owned(),
            number(largest(&mut s.energy_error())),
            number(largest(&mut s.momentum_error())),
            flips.len().to_string(),
            period,
            off,
            if s.iterations > 0.0 { format!("{:.2}", s.iterations) } else { "–".to_owned() },
            format!("{:.0}", s.nanoseconds),
        ]);
    }
    let table = aligned(&rows);
    format!(
        "Greatest deviations in the run, the period of two flips (exact: {PERIOD:.4} s), the cost of a step:\n\n{table}"
    )
}

/// Twice the mean time between flips.
fn period(times: &[f64]) -> Option<f64> {
    let intervals = u32::try_from(times.len()).ok()?.checked_sub(1).filter(|&n| n > 0)?;
    Some(2.0 * (times.last()? - times.first()?) / f64::from(intervals))
}
