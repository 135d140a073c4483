//! T7: an asymmetric top in chaotic motion.

use declarations::HeavyTop;
use declarations::Motion;
use liestep::Stepper;
use liestep::motion::Plan;
use workbench::measure::{Tenths, float};
use workbench::run::Method as _;

use crate::curves::Curves;
use crate::rivals::{energy_of, on_quaternion};
use crate::row::{Effort, Failure, Row, short};
use crate::walk::Walk;

const H: f64 = 0.02;

/// The largest change of the energy in the first and in the last tenth, and the Casimirs.
fn ours(motion: &Motion, steps: u64, compensated: bool) -> Result<(Tenths, Walk), Failure> {
    let stepper = Stepper::new(motion.top.clone(), H)?;
    if compensated { stepped(&stepper.compensated(), motion, steps) } else { stepped(&stepper, motion, steps) }
}

fn stepped<P: Plan<HeavyTop>>(
    stepper: &Stepper<HeavyTop, P>,
    motion: &Motion,
    steps: u64,
) -> Result<(Tenths, Walk), Failure> {
    let mut state = stepper.start(motion.attitude, motion.velocity)?;
    let start = stepper.energy(&state);
    let (mut energies, mut walk) = (Tenths::new(steps), Walk::from_state(&state, steps));
    for step in 1..=steps {
        stepper.step(&mut state)?;
        energies.after(step, || stepper.energy(&state) - start);
        walk.after_step(step, &state);
    }
    Ok((energies, walk))
}

fn amplitudes(energies: &Tenths) -> [f64; 2] {
    [energies.first, energies.last].map(|window| window.highest.abs().max(window.lowest.abs()))
}

pub(crate) fn t7(effort: Effort, _: &mut Curves) -> Result<Row, Failure> {
    let steps = effort.steps(3_000_000, 30_000_000);
    let motion = Motion::chaotic();
    let mut row = Row::new(
        "T7",
        "chaotic asymmetric top, h = 0.02, 3e6 steps (3e7 with --long)",
        "max |ΔE| doesn't grow (2 %); compensated, Casimirs to 1e-13",
    )
    .shows(format!("{:.0e} steps", float(steps)));
    for (name, compensated) in [("plain", false), ("compensated", true)] {
        let (energies, walk) = ours(&motion, steps, compensated)?;
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
