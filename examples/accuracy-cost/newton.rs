//! What stopping Newton's iteration early saves and costs: iterations a step, and the drift of what is kept.

use std::error::Error;
use std::fmt::Write as _;

use liestep::{SO3, Stepper};
use workbench::newton_tolerance::{EXPONENTS, Form, Guess, Left, by_the_library, run};
use workbench::table::{aligned, number};

use crate::scenes::Scene;

/// The step, s.
const H: f64 = 0.01;

/// A line of the table: where the iteration starts, where it stops, and what is left.
type Line = (&'static str, String, Left);

/// Of a top by (3.13).
pub fn measure(scene: &Scene, steps: u64) -> Result<Vec<Line>, Box<dyn Error>> {
    let top = scene.top();
    let stepper = Stepper::new(top.clone(), H)?;
    let state = stepper.start(SO3::from_matrix_unchecked(scene.attitude), scene.velocity)?;
    let mut lines = vec![("the library", "rounding".to_owned(), by_the_library(&stepper, state, steps)?)];
    let start = (state.momentum(), state.advected());
    for (name, guess) in [("last increment", Guess::Last), ("extrapolated", Guess::Extrapolated)] {
        for exponent in EXPONENTS {
            let stop = (guess, 10.0_f64.powi(exponent));
            lines.push((name, format!("1e{exponent}"), run(&top, H, start, stop, Form::Transport, steps)));
        }
    }
    Ok(lines)
}

/// For the terminal.
pub fn table(scene: &Scene, steps: u64, lines: &[Line]) -> String {
    let title = format!("Newton's tolerance, {}, h = {H} s, {steps} steps; drifts are relative", scene.name);
    let heading = ["start", "tolerance", "iterations", "energy", "p·w", "p₃"];
    let mut rows = vec![heading.map(str::to_owned).to_vec()];
    for (name, tolerance, left) in lines {
        let drifts = [left.energy, left.vertical, left.axial].map(number);
        let cells = [(*name).to_owned(), tolerance.clone(), format!("{:.2}", left.iterations)];
        rows.push(cells.into_iter().chain(drifts).collect());
    }
    format!("{title}\n\n{}", aligned(&rows))
}

/// As comma-separated values.
pub fn csv(lines: &[Line]) -> String {
    let mut text = "start,tolerance,iterations,energy_drift,vertical_drift,axial_drift\n".to_owned();
    for (name, tolerance, left) in lines {
        let Left { energy, vertical, axial, iterations } = left;
        // Writing to a string can't fail.
        let _ = writeln!(text, "{name},{tolerance},{iterations},{energy:e},{vertical:e},{axial:e}");
    }
    text
}
