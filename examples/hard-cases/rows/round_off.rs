//! R1 to R4: where roundings would add up instead of walking at random.
//!
//! `D = F − I` is formed from rounded coefficients, and `D + Dᵀ + DᵀD`, zero but for that, is of the size `ε θ²` for a
//! turn by `θ`. Where the turn is always the same, so is this, and would grow in proportion to `N`; the roundings of
//! the sum `R + R D` walk, like `ε √N`, and hide it up to about `θ⁻⁴` steps. Compensated sums take the walk away, not
//! this. The library takes one step towards the polar factor, `R (3I − RᵀR)/2`, once an attitude is 2¹¹ ε away; a step
//! in every thousand, beside it, is what more of that would give.

use declarations::{HeavyTop, Motion};
use liestep::methods::{CompositionScheme, SplittingScheme, SymmetricBody};
use liestep::motion::Plan;
use liestep::prelude::*;
use nalgebra::{Matrix3, Vector3};
use plotters::style::RGBColor;
use workbench::measure::{Tenths, float};
use workbench::newton_tolerance::energy;
use workbench::plot::{BLUE, GREEN, ORANGE, PURPLE};

use crate::curves::{Curve, Curves};
use crate::row::{Effort, Failure, Row, short};
use crate::walk::{FARTHEST, TopMotion, Walk};

/// Steps and looks; brings the attitude back to the rotations now and then, where it is to.
fn walk<P: Plan<HeavyTop>>(
    stepper: &Stepper<HeavyTop, P>,
    start: &StateOf<HeavyTop, P>,
    steps: u64,
    is_corrected: bool,
) -> Result<(Walk, f64), Failure> {
    let (top, mut state) = (stepper.scene(), *start);
    let (mut walk, mut energies) = (Walk::from_state(start, steps), Tenths::new(steps));
    let before = energy(top, &start.momentum(), &start.advected());
    for count in 1..=steps {
        stepper.step(&mut state)?;
        if is_corrected && count.is_multiple_of(PERIOD) {
            state = stepper.start_with_momentum(orthogonal(&state), state.momentum())?;
        }
        walk.after_step(count, &state);
        energies.after(count, || energy(top, &state.momentum(), &state.advected()) - before);
    }
    Ok((walk, energies.drift() / before.abs()))
}

/// What is left of a run: the criterion is for the library's step as it is.
fn told(row: Row, name: &str, (walk, energy): &(Walk, f64), is_judged: bool) -> Row {
    let (worst, deviations) = (walk.worst, walk.attitude_deviations());
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
        short(*energy)
    ))
}

/// How often the attitude is brought back to the rotations, in steps.
const PERIOD: u64 = 1000;

/// The attitude after a step towards its polar factor.
fn orthogonal(state: &TopMotion) -> SO3 {
    let r = state.attitude().matrix();
    SO3::from_matrix_unchecked(r * (Matrix3::identity() * 3.0 - r.transpose() * r) * 0.5)
}

const CRITERION: &str = "‖RᵀR − I‖ ≤ 2e-12, growing like √N (4 deviations of a walk)";

fn line(name: &'static str, colour: RGBColor, (walk, _): &(Walk, f64)) -> Curve {
    Curve { name, colour, points: walk.points(|d| d.orthogonality) }
}

pub(crate) fn r1(effort: Effort, curves: &mut Curves) -> Result<Row, Failure> {
    let (h, scheme) = (0.05, CompositionScheme::KAHAN_LI_8);
    let steps = effort.steps(500_000, 5_000_000);
    let motion = Motion::looping();
    let composition = Stepper::composed(motion.top.clone(), h, scheme)?;
    let start = composition.start(motion.attitude, motion.velocity)?;
    let plain = walk(&composition, &start, steps, false)?;
    let corrected = walk(&composition, &start, effort.beside(steps), true)?;
    let compensated = composition.clone().compensated();
    let kept = walk(&compensated, &compensated.adopt(&start), effort.beside(steps), false)?;
    let row = Row::new(
        "R1",
        "Kahan-Li 8 of (3.13), looping top, h = 0.05, 5e5 steps of 17 stages (5e6 with --long)",
        CRITERION,
    )
    .shows(format!("{:.1e} stages", 17.0 * float(steps)));
    let row = told(row, "plain", &plain, true);
    let row = told(row, "compensated", &kept, false);
    let row = told(row, "polar step every 1000", &corrected, false);
    curves.composed.extend([line("Kahan-Li 8", BLUE, &plain), line("compensated", GREEN, &kept)]);
    Ok(row)
}

pub(crate) fn r2(effort: Effort, curves: &mut Curves) -> Result<Row, Failure> {
    let steps = effort.steps(1_000_000, 10_000_000);
    let motion = Motion::looping();
    let kinetic = SymmetricBody::new(&Inertia::new(motion.top.inertia(&motion.top.advected()))?)?;
    let splitting = Stepper::split(motion.top.clone(), 0.02, kinetic, SplittingScheme::NYSTROM_11)?;
    let start = splitting.start(motion.attitude, motion.velocity)?;
    let plain = walk(&splitting, &start, steps, false)?;
    let corrected = walk(&splitting, &start, effort.beside(steps), true)?;
    let row = Row::new(
        "R2",
        "exact symmetric body and kicks in 11 stages, looping top, h = 0.02, 1e6 steps (1e7 with --long)",
        CRITERION,
    );
    let row = told(row, "plain", &plain, true);
    let row = told(row, "polar step every 1000", &corrected, false);
    curves.composed.push(line("splitting", ORANGE, &plain));
    Ok(row)
}

/// A top at a step of 0.05 s: plain, and for other numbers of steps compensated, and with polar steps.
fn three(top: &HeavyTop, velocity: Vector3<f64>, (steps, beside): (u64, u64)) -> Result<[(Walk, f64); 3], Failure> {
    let stepper = Stepper::new(top.clone(), 0.05)?;
    let start = stepper.start(SO3::identity(), velocity)?;
    let (plain, corrected) = (walk(&stepper, &start, steps, false)?, walk(&stepper, &start, beside, true)?);
    let compensated = stepper.compensated();
    let kept = walk(&compensated, &compensated.adopt(&start), beside, false)?;
    Ok([plain, kept, corrected])
}

pub(crate) fn r3(effort: Effort, curves: &mut Curves) -> Result<Row, Failure> {
    let steps = effort.steps(10_000_000, 100_000_000);
    let top = Motion::looping().top;
    // Upright: neither momentum nor `w` changes, and each step adds the same `D`.
    let [plain, kept, corrected] = three(&top, Vector3::z(), (steps, effort.beside(steps)))?;
    let angle = 0.05_f64.asin();
    let row = Row::new("R3", "upright spin, a turn of 0.05 in every step, 1e7 steps (1e8 with --long)", CRITERION);
    let row = told(row, "plain", &plain, true);
    let row = told(row, "compensated", &kept, false).shows(format!(
        "compensated: ‖RᵀR − I‖ is {:.2} N ε θ²",
        kept.0.worst.orthogonality / (float(steps) * f64::EPSILON * angle * angle)
    ));
    let row = told(row, "polar step every 1000", &corrected, false);
    curves.composed.push(line("upright spin", PURPLE, &plain));
    Ok(row)
}

pub(crate) fn r4(effort: Effort, _: &mut Curves) -> Result<Row, Failure> {
    let steps = effort.steps(10_000_000, 100_000_000);
    let top = HeavyTop { g: 0.0, ..Motion::looping().top };
    // Without weight the symmetric body precesses regularly: the angle of a step is always the same, its axis turns.
    let [plain, kept, corrected] = three(&top, Vector3::new(1.0, 0.5, 2.0), (steps, effort.beside(steps)))?;
    let row = Row::new("R4", "free precession of a symmetric body, h = 0.05, 1e7 steps (1e8 with --long)", CRITERION);
    let row = told(row, "plain", &plain, true);
    let row = told(row, "compensated", &kept, false);
    Ok(told(row, "polar step every 1000", &corrected, false))
}
