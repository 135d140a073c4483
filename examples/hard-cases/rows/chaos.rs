//! T7: an asymmetric top in chaotic motion.

use declarations::Motion;
use workbench::measure::{Tenths, float};
use workbench::run::Method as _;

use crate::rivals::{energy_of, on_quaternion};
use crate::row::{Effort, Failure, Row, short};
use crate::walk::Run;

const H: f64 = 0.02;

/// The largest change of the energy in the first and in the last tenth.
fn amplitudes(energies: &Tenths) -> [f64; 2] {
    [energies.first, energies.last].map(|window| window.highest.abs().max(window.lowest.abs()))
}

pub(crate) fn t7(effort: Effort) -> Result<Row, Failure> {
    let steps = effort.steps(3_000_000, 30_000_000);
    let motion = Motion::chaotic();
    let mut row = Row::new(
        "T7",
        "chaotic asymmetric top, h = 0.02, 3e6 steps (3e7 with --long)",
        "max |ΔE| doesn't grow (2 %); compensated, Casimirs to 1e-13",
    )
    .shows(format!("{:.0e} steps", float(steps)));
    for (name, compensated) in [("plain", false), ("compensated", true)] {
        let Run { energies, walk, .. } = Run::along(&motion, H, steps, compensated)?;
        let [first, last] = amplitudes(&energies);
        let what = format!("{name}: max |ΔE| {first:.4e} J in the first tenth, {last:.4e} J in the last; growth");
        row = row.at_most(&what, last / first - 1.0, 0.02);
        // The criterion is for compensated sums.
        row = if compensated {
            row.at_most("compensated: |w|", walk.worst.length, 1e-13).at_most(
                "compensated: p·w",
                walk.worst.vertical,
                1e-13,
            )
        } else {
            row.shows(format!("plain: |w| {}, p·w {}", short(walk.worst.length), short(walk.worst.vertical)))
        };
    }
    let mut rk4 = on_quaternion(&motion, H);
    let start = energy_of(&motion.top, &rk4.sample());
    rk4.advance(effort.beside(steps))?;
    let change = energy_of(&motion.top, &rk4.sample()) - start;
    Ok(row.other(format!("RK4 (quaternion): energy {change:+.1e} J of {start:.1} J at the end")))
}
