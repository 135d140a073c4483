//! P4: the effect of stopping Newton's iteration early.

use declarations::Motion;
use workbench::newton_tolerance::{Drifts, EXPONENTS, Form, Guess, by_the_library, run};

use crate::rivals::started;
use crate::row::{Effort, Failure, Row, short};

const H: f64 = 0.01;

fn told(name: &str, exponent: i32, left: &Drifts) -> String {
    format!(
        "{name}, 1e{exponent}: {:.2} iterations, drift {}, p₃ {}, p·w {}",
        left.iterations,
        short(left.energy),
        short(left.axial),
        short(left.vertical)
    )
}

pub(crate) fn p4(effort: Effort) -> Result<Row, Failure> {
    let steps = effort.steps(1_000_000, 10_000_000);
    let motion = Motion::looping();
    let (stepper, state) = started(&motion, H)?;
    let start = (state.momentum(), state.advected());
    let Drifts { energy: drift, iterations, vertical, axial } = by_the_library(&stepper, state, steps)?;
    let mut row = Row::new(
        "P4",
        "Newton's tolerance against the energy's drift, looping top, h = 0.01, a million steps",
        "shown as a table; by default the drift is round-off (1e-11 E), where early stopping shows in it and in p₃",
    )
    .at_most(&format!("default, {iterations:.2} iterations a step: drift"), drift, 1e-11)
    .at_most("default: p₃", axial, 0.0)
    .at_most("default: p·w", vertical, 1e-12);
    for (name, guess) in [("from the last increment", Guess::Last), ("extrapolated", Guess::Extrapolated)] {
        // The criterion is for one combination.
        let judged = |exponent: i32| (guess, exponent) == (Guess::Last, -1);
        for exponent in EXPONENTS.into_iter().filter(|exponent| judged(*exponent) || !effort.verdict_only) {
            let left = run(&motion.top, H, start, (guess, 10.0_f64.powi(exponent)), Form::Transport, steps);
            if judged(exponent) {
                // One iteration a step leads to a drift, which the Casimirs don't show.
                row = row
                    .holds("from the last increment, 1e-1: E and p₃ drift", left.energy > 1e-7 && left.axial > 1e-7)
                    .at_most("from the last increment, 1e-1: p·w", left.vertical, 1e-12);
            }
            row = row.shows(told(name, exponent, &left));
        }
    }
    for exponent in [-8, -4, 0] {
        let stop = (Guess::Last, 10.0_f64.powi(exponent));
        let left = run(&motion.top, H, start, stop, Form::Printed, effort.beside(steps.min(1_000_000)));
        row = row.other(told("μ⁺ by (3.18) as printed", exponent, &left));
    }
    Ok(row)
}
