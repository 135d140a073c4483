//! T3: many steps of the looping top.

use declarations::Motion;
use workbench::measure::float;
use workbench::run::{Method, Sample};

use crate::rivals::{energy_of, on_matrix, on_quaternion};
use crate::row::{Effort, Failure, Row, short};
use crate::walk::{FARTHEST, Run, Walk};

const STEP: f64 = 0.01;

fn theirs<M: Method>(motion: &Motion, mut method: M, steps: u64) -> Result<(Walk, f64), Failure> {
    let vertical = |sample: &Sample| sample.attitude.row(2).transpose();
    let start = method.sample();
    let mut walk = Walk::from(&start.momentum, &vertical(&start), steps);
    let energy = energy_of(&motion.top, &start);
    // Samples are taken every hundred steps.
    for step in (100..=steps).step_by(100) {
        method.advance(100)?;
        let sample = method.sample();
        walk.after(step, || (sample.attitude, sample.momentum, vertical(&sample)));
    }
    let drift = energy_of(&motion.top, &method.sample()) / energy - 1.0;
    Ok((walk, drift))
}

pub(crate) fn t3(effort: Effort) -> Result<Row, Failure> {
    let steps = effort.steps(10_000_000, 100_000_000);
    let motion = Motion::looping();
    let plain = Run::along(&motion, STEP, steps, false)?;
    let compensated = effort.steps(1_000_000, 100_000_000);
    let kept = Run::along(&motion, STEP, compensated, true)?;
    // The nine entries leave the rotations soon, so a million steps suffice.
    let (quaternion, change) = theirs(&motion, on_quaternion(&motion, STEP), effort.beside(compensated))?;
    let (matrix, _) = theirs(&motion, on_matrix(&motion, STEP), effort.beside(steps.min(1_000_000)))?;

    let (worst, energy) = (plain.walk.worst, plain.energy);
    let mut row = Row::new(
        "T3",
        "looping top, h = 0.01, ten million steps (1e8 with --long)",
        "‖RᵀR − I‖ ≤ 2e-12, |w| and p·w ≤ 3e-12, energy window means within 1e-10 E, extremes to 4 digits, growth like \
         √N (4 deviations of a walk), p₃ to the last bit; with compensated sums all of them to 1e-16 √N",
    )
    .shows(format!("{:.0e} steps", float(steps)))
    .at_most("‖RᵀR − I‖", worst.orthogonality, 2e-12)
    .at_most("|w|", worst.length, 3e-12)
    .at_most("p·w", worst.vertical, 3e-12)
    .at_most("energy window means, relative", plain.energies.drift() / energy, 1e-10)
    .at_most("energy extremes, relative", plain.energies.extremes(), 5e-4)
    .at_most("steps that changed p₃", float(plain.axial), 0.0)
    .at_most("RRᵀ − I, in deviations of a walk", plain.walk.attitude_deviations(), FARTHEST)
    .at_most("|w|² and p·w, in deviations of a walk", plain.walk.casimir_deviations(), FARTHEST);
    let kept_worst = kept.walk.worst;
    // The expected walk of independent increments, each with an error of one ε of the angle of a step.
    let walked = 1e-16 * float(compensated).sqrt();
    row = row
        .shows(format!("compensated, {:.0e} steps", float(compensated)))
        .at_most("compensated: ‖RᵀR − I‖", kept_worst.orthogonality, walked)
        .at_most("compensated: |w|", kept_worst.length, walked)
        .at_most("compensated: p·w", kept_worst.vertical, walked)
        .at_most("compensated: p₃", kept_worst.axial, walked.min(1e-13))
        .at_most("compensated: energy window means, relative", kept.energies.drift() / energy, 1e-10)
        .at_most("compensated: energy extremes, relative", kept.energies.extremes(), 5e-4)
        .at_most("compensated: RRᵀ − I, in deviations of a walk", kept.walk.attitude_deviations(), FARTHEST)
        .at_most("compensated: |w|² and p·w, in deviations of a walk", kept.walk.casimir_deviations(), FARTHEST)
        .shows(format!(
            "compensated: p₃ is off by {} (in {:.0e} steps by a unit of its last digit or more)",
            short(kept_worst.axial),
            float(kept.axial)
        ));
    for (name, walk) in [("quaternion", &quaternion), ("nine entries", &matrix)] {
        let worst = walk.worst;
        row = row.other(format!(
            "RK4 ({name}): ‖RᵀR − I‖ {}, p·w {}, p₃ {}",
            short(worst.orthogonality),
            short(worst.vertical),
            short(worst.axial)
        ));
    }
    Ok(row.other(format!("RK4 (quaternion): energy at the end off by {change:+.1e}")))
}
