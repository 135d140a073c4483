//! R1 to R4: rounding errors that would accumulate instead of walking at random.
//!
//! `D = F − I` is computed from rounded coefficients, so `D + Dᵀ + DᵀD` isn't zero but has the size `ε θ²` for a turn
//! by `θ`. If the turn is constant, so is this error, and it would grow in proportion to `N`; the rounding errors of
//! the sum `R + R D` walk, like `ε √N`, and dominate up to about `θ⁻⁴` steps. Compensated sums remove the walk, but not
//! the constant error. The library takes one step towards the polar factor, `R (3I − RᵀR)/2`, once an attitude is 2¹¹ ε
//! away; the variant with such a step in every thousand shows the effect of taking more.

use declarations::{HeavyTop, Motion};
use liestep::mechanics::inertia;
use liestep::methods::{CompositionScheme, SplittingScheme, SymmetricBody};
use liestep::motion::Plan;
use liestep::prelude::*;
use liestep::with::Compensable;
use nalgebra::Vector3;
use workbench::measure::float;

use crate::row::{Effort, Failure, Row, short};
use crate::walk::{FARTHEST, Run};

/// Adds the rounding errors of a run to a row: the criterion is for the library's unmodified step.
fn told(row: Row, name: &str, run: &Run, is_judged: bool) -> Row {
    let (worst, deviations) = (run.walk.worst, run.walk.attitude_deviations());
    let defect = format!("{name}: ‖RᵀR − I‖");
    let row = if is_judged {
        row.at_most(&defect, worst.orthogonality, 2e-12).at_most(
            &format!("{name}: in deviations of a walk"),
            deviations,
            FARTHEST,
        )
    } else {
        row.shows(format!("{defect} {}, {deviations:.1} deviations of a walk", short(worst.orthogonality)))
    };
    row.shows(format!(
        "{name}: p·w {}, p₃ {}, energy means {}",
        short(worst.vertical),
        short(worst.axial),
        short(run.energies.drift() / run.energy.abs())
    ))
}

const CRITERION: &str = "‖RᵀR − I‖ ≤ 2e-12, growing like √N (4 deviations of a walk)";

/// Runs of a method from a start: plain, and for other numbers of steps compensated, and with polar steps.
fn walked<P: Plan<HeavyTop> + Compensable>(
    row: Row,
    stepper: Stepper<HeavyTop, P>,
    (attitude, velocity): (SO3, Vector3<f64>),
    (steps, beside): (u64, u64),
) -> Result<(Row, Run), Failure> {
    let start = stepper.start(attitude, velocity)?;
    let row = told(row, "plain", &Run::of(&stepper, &start, steps, false)?, true);
    let row = told(row, "polar step every 1000", &Run::of(&stepper, &start, beside, true)?, false);
    let compensated = stepper.compensated();
    let kept = Run::of(&compensated, &compensated.adopt(&start), beside, false)?;
    Ok((told(row, "compensated", &kept, false), kept))
}

pub(crate) fn r1(effort: Effort) -> Result<Row, Failure> {
    let steps = effort.steps(500_000, 5_000_000);
    let motion = Motion::looping();
    let composition = Stepper::composed(motion.top, 0.05, CompositionScheme::KAHAN_LI_8)?;
    let row = Row::new(
        "R1",
        "Kahan-Li 8 of (3.13), looping top, h = 0.05, 5e5 steps of 17 stages (5e6 with --long)",
        CRITERION,
    )
    .shows(format!("{:.1e} stages", 17.0 * float(steps)));
    let start = (motion.attitude, motion.velocity);
    Ok(walked(row, composition, start, (steps, effort.beside(steps)))?.0)
}

pub(crate) fn r2(effort: Effort) -> Result<Row, Failure> {
    let steps = effort.steps(1_000_000, 10_000_000);
    let motion = Motion::looping();
    let kinetic = SymmetricBody::new(&Inertia::new(inertia(&motion.top, &motion.top.advected()))?)?;
    let splitting = Stepper::split(motion.top, 0.02, kinetic, SplittingScheme::NYSTROM_11)?;
    let row = Row::new(
        "R2",
        "exact symmetric body and kicks in 11 stages, looping top, h = 0.02, 1e6 steps (1e7 with --long)",
        CRITERION,
    );
    let start = (motion.attitude, motion.velocity);
    Ok(walked(row, splitting, start, (steps, effort.beside(steps)))?.0)
}

pub(crate) fn r3(effort: Effort) -> Result<Row, Failure> {
    let steps = effort.steps(10_000_000, 100_000_000);
    let row = Row::new("R3", "upright spin, a turn of 0.05 in every step, 1e7 steps (1e8 with --long)", CRITERION);
    // In the upright spin neither momentum nor `w` changes, and each step adds the same `D`.
    let (stepper, start) = (Stepper::new(Motion::looping().top, 0.05)?, (SO3::identity(), Vector3::z()));
    let (row, kept) = walked(row, stepper, start, (steps, effort.beside(steps)))?;
    let angle = 0.05_f64.asin();
    Ok(row.shows(format!(
        "compensated: ‖RᵀR − I‖ is {:.2} N ε θ²",
        kept.walk.worst.orthogonality / (float(steps) * f64::EPSILON * angle * angle)
    )))
}

pub(crate) fn r4(effort: Effort) -> Result<Row, Failure> {
    let steps = effort.steps(10_000_000, 100_000_000);
    let row = Row::new("R4", "free precession of a symmetric body, h = 0.05, 1e7 steps (1e8 with --long)", CRITERION);
    // Without weight the symmetric body precesses regularly: the angle of a step is constant, and its axis rotates.
    let weightless = Stepper::new(HeavyTop { g: 0.0, ..Motion::looping().top }, 0.05)?;
    let start = (SO3::identity(), Vector3::new(1.0, 0.5, 2.0));
    Ok(walked(row, weightless, start, (steps, effort.beside(steps)))?.0)
}
