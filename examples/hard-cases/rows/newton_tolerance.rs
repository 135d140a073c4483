//! P4: what stopping Newton's iteration early costs.

use liestep::Stepper;

use crate::common::plot::{BLUE, ORANGE};
use crate::curves::{Curve, Curves};
use crate::measure::{Tenths, float};
use crate::motion::Motion;
use crate::rivals::GREY;
use crate::row::{Effort, Failure, Row, short};
use crate::tolerance::{Form, Guess, Left, run};

const H: f64 = 0.01;

/// The drift of the library's own step.
fn of_the_library(motion: &Motion, steps: u64) -> Result<(f64, f64), Failure> {
    let stepper = Stepper::new(motion.top.clone(), H)?;
    let mut state = stepper.start(motion.attitude, motion.velocity)?;
    let (start, mut energies, mut iterations) = (stepper.energy(&state), Tenths::new(steps), 0);
    for step in 1..=steps {
        iterations += u64::from(stepper.step(&mut state)?.iterations);
        energies.after(step, || stepper.energy(&state) - start);
    }
    Ok((energies.drift() / start, float(iterations) / float(steps)))
}

fn told(name: &str, exponent: i32, left: &Left) -> String {
    format!(
        "{name}, 1e{exponent}: {:.2} iterations, drift {}, p₃ {}, p·w {}",
        left.iterations,
        short(left.energy),
        short(left.axial),
        short(left.vertical)
    )
}

pub(crate) fn p4(effort: Effort, curves: &mut Curves) -> Result<Row, Failure> {
    let steps = effort.steps(1_000_000, 10_000_000);
    let motion = Motion::looping()?;
    let stepper = Stepper::new(motion.top.clone(), H)?;
    let state = stepper.start(motion.attitude, motion.velocity)?;
    let start = (state.momentum(), state.advected());
    let (drift, iterations) = of_the_library(&motion, steps)?;
    let mut row = Row::new(
        "P4",
        "Newton's tolerance against the energy's drift, looping top, h = 0.01, a million steps",
        "shown as a table; by default the drift is round-off (1e-10 E)",
    )
    .at_most(&format!("default, {iterations:.2} iterations a step: drift"), drift, 1e-10);
    for (name, guess, colour) in
        [("from the last increment", Guess::Last, ORANGE), ("extrapolated", Guess::Extrapolated, BLUE)]
    {
        let mut points = Vec::new();
        for exponent in [-12, -10, -8, -7, -6, -5, -4, -3, -2, -1, 0] {
            let left = run(&motion.top, H, start, (guess, 10.0_f64.powi(exponent)), Form::Transport, steps);
            points.push((f64::from(exponent), left.energy));
            // One iteration more or less is what makes the difference.
            if exponent % 2 == 0 {
                row = row.shows(told(name, exponent, &left));
            }
        }
        curves.tolerance.push(Curve { name, colour, points });
    }
    for exponent in [-8, -4, 0] {
        let stop = (Guess::Last, 10.0_f64.powi(exponent));
        let left = run(&motion.top, H, start, stop, Form::Printed, steps.min(1_000_000));
        row = row.other(told("μ⁺ by (3.18) as printed", exponent, &left));
    }
    curves.tolerance.push(Curve { name: "the library", colour: GREY, points: vec![(-12.0, drift), (0.0, drift)] });
    Ok(row)
}
