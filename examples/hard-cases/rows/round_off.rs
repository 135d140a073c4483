//! R1 to R3: where roundings could add up instead of walking at random, a constant step makes the same one again and again.

use liestep::{
    CompensatedState, CompensatedStepper, Composition, CompositionScheme, Effect as _, Inertia, LieGroup as _, SO3,
    Splitting, SplittingScheme, Stepper, SymmetricBody,
};
use nalgebra::{Matrix3, Vector3};

use crate::common::plot::{BLUE, GREEN, ORANGE, PURPLE};
use crate::curves::{Curve, Curves};
use crate::declarations::HeavyTop;
use crate::measure::{Tenths, float};
use crate::motion::Motion;
use crate::row::{Effort, Failure, Row, short};
use crate::walk::{TopState, Walk, energy};

/// Between the exponent of a walk and that of a drift.
const WALK: f64 = 0.75;

/// Steps and looks.
fn walk(
    top: &HeavyTop,
    start: &TopState,
    steps: u64,
    mut step: impl FnMut() -> Result<TopState, Failure>,
) -> Result<(Walk, f64), Failure> {
    let (mut walk, mut energies) = (Walk::from_state(start), Tenths::new(steps));
    let before = energy(top, &start.momentum(), &start.advected());
    for count in 1..=steps {
        let state = step()?;
        walk.after_step(count, &state);
        energies.after(count, || energy(top, &state.momentum(), &state.advected()) - before);
    }
    Ok((walk, energies.drift() / before.abs()))
}

/// The row of a run: bounds if it is one that the criterion is for.
fn told(row: Row, name: &str, (walk, energy): &(Walk, f64), bound: Option<f64>) -> Row {
    let worst = walk.worst;
    let sizes = format!(
        "{name}: p·w {}, p₃ {}, energy means {}, growth like N to the {:.2} (R), {:.2} (p·w)",
        short(worst.vertical),
        short(worst.axial),
        short(*energy),
        walk.exponent(|d| d.orthogonality),
        walk.exponent(|d| d.vertical)
    );
    let defect = format!("{name}: ‖RᵀR − I‖");
    match bound {
        Some(bound) => row
            .at_most(&defect, worst.orthogonality, bound)
            .at_most(&format!("{name}: exponent of its growth"), walk.exponent(|d| d.orthogonality), WALK),
        None => row.shows(format!("{defect} {}", short(worst.orthogonality))),
    }
    .shows(sizes)
}

/// A composition with the sums of each stage compensated. The library compensates single steps; the stages are those.
struct CompensatedComposition {
    stages: Vec<CompensatedStepper<HeavyTop>>,
}

impl CompensatedComposition {
    fn new(top: &HeavyTop, h: f64, scheme: &CompositionScheme) -> Result<Self, Failure> {
        let stages = scheme.stages().map(|gamma| Stepper::new(top.clone(), gamma * h).map(Stepper::compensated));
        Ok(Self { stages: stages.collect::<Result<_, _>>()? })
    }

    fn step(&self, state: &mut CompensatedState<SO3, Vector3<f64>>) -> Result<(), Failure> {
        for stage in &self.stages {
            stage.step(state)?;
        }
        Ok(())
    }
}

pub(crate) fn r1(effort: Effort, curves: &mut Curves) -> Result<Row, Failure> {
    let (h, scheme) = (0.05, CompositionScheme::KAHAN_LI_8);
    let steps = effort.steps(200_000, 2_000_000);
    let motion = Motion::looping()?;
    let composition = Composition::new(motion.top.clone(), h, scheme)?;
    let start = composition.start(motion.attitude, motion.velocity)?;
    let mut state = start;
    let plain = walk(&motion.top, &start, steps, || {
        composition.step(&mut state)?;
        Ok(state)
    })?;
    let compensated = CompensatedComposition::new(&motion.top, h, &scheme)?;
    let mut state = CompensatedState::from(start);
    let kept = walk(&motion.top, &start, steps, || {
        compensated.step(&mut state)?;
        Ok(*state.state())
    })?;
    let row = Row::new(
        "R1",
        "Kahan-Li 8 of (3.13), looping top, h = 0.05, 2e5 steps of 17 stages (2e6 with --long)",
        "‖RᵀR − I‖ ≤ 2e-12, growing like √N",
    );
    let row = told(row, "plain", &plain, Some(2e-12));
    let row = told(row, "compensated", &kept, Some(2e-12));
    let points = |walk: &Walk| walk.points(|d| d.orthogonality);
    curves.composed.extend([
        Curve { name: "Kahan-Li 8", colour: BLUE, points: points(&plain.0) },
        Curve { name: "compensated", colour: GREEN, points: points(&kept.0) },
    ]);
    Ok(row)
}

pub(crate) fn r2(effort: Effort, curves: &mut Curves) -> Result<Row, Failure> {
    let h = 0.02;
    let steps = effort.steps(500_000, 5_000_000);
    let motion = Motion::looping()?;
    let inertia = motion.top.inertia();
    let kinetic = SymmetricBody::new(&Inertia::new(inertia)?)?;
    let splitting = Splitting::new(motion.top.clone(), kinetic, h, SplittingScheme::NYSTROM_11)?;
    let start = splitting.start(motion.attitude, motion.velocity)?;
    let mut state = start;
    let plain = walk(&motion.top, &start, steps, || {
        splitting.step(&mut state)?;
        Ok(state)
    })?;
    // One step towards the polar factor now and then takes the drift away; `w` is then that of the attitude again.
    let (mut state, mut count) = (start, 0_u32);
    let corrected = walk(&motion.top, &start, steps, || {
        splitting.step(&mut state)?;
        count += 1;
        if count.is_multiple_of(1000) {
            let r = state.attitude().matrix();
            let nearest = r * (Matrix3::identity() * 3.0 - r.transpose() * r) * 0.5;
            state = splitting.start_with_momentum(SO3::from_matrix_unchecked(nearest), state.momentum())?;
        }
        Ok(state)
    })?;
    let row = Row::new(
        "R2",
        "exact symmetric body and kicks, 11 stages of order 6, looping top, h = 0.02, 5e5 steps (5e6 with --long)",
        "‖RᵀR − I‖ ≤ 2e-12, growing like √N",
    );
    let row = told(row, "plain", &plain, Some(2e-12));
    let row = told(row, "with a polar step every 1000 steps", &corrected, None);
    curves.composed.push(Curve {
        name: "exact splitting",
        colour: ORANGE,
        points: plain.0.points(|d| d.orthogonality),
    });
    Ok(row)
}

pub(crate) fn r3(effort: Effort, curves: &mut Curves) -> Result<Row, Failure> {
    let steps = effort.steps(1_000_000, 10_000_000);
    let top = Motion::looping()?.top;
    let stepper = Stepper::new(top.clone(), 0.01)?;
    // Upright: neither momentum nor `w` changes, and each step adds the same `F − I`.
    let start = stepper.start(SO3::identity(), Vector3::z() * 5.0)?;
    let mut state = start;
    let plain = walk(&top, &start, steps, || {
        stepper.step(&mut state)?;
        Ok(state)
    })?;
    let carrying = stepper.compensated();
    let mut state = CompensatedState::from(start);
    let kept = walk(&top, &start, steps, || {
        carrying.step(&mut state)?;
        Ok(*state.state())
    })?;
    let row = Row::new(
        "R3",
        "upright spin, hΩ = 0.05: every step is the same rotation, a million steps (1e7 with --long)",
        "‖RᵀR − I‖ ≤ 2e-12, growing like √N",
    );
    let row = told(row, "plain", &plain, Some(2e-12));
    let row = told(row, "compensated", &kept, None);
    curves.composed.extend([
        Curve { name: "upright spin", colour: PURPLE, points: plain.0.points(|d| d.orthogonality) },
    ]);
    Ok(row.shows(format!("{:.0e} steps", float(steps))))
}
