//! P8: the rows in single precision.
//!
//! The thresholds are those of `f64` in units of epsilon: 10⁻¹⁴ is 45 ε, 10⁻¹³ is 450 ε.

use declarations::Motion;
use liestep::mechanics::{DiscreteLagrangian, InertiaError, Regular, Sum, inertia};
use liestep::prelude::*;
use nalgebra::{Matrix3, Vector3};
use workbench::measure::{Tenths, four_halvings, greater, order, relative, steps_in};

use crate::row::{Effort, Failure, Row};

const EPSILON: f64 = f32::EPSILON as f64;

/// A bound for `f64` in units of its epsilon.
fn units(bound: f64) -> f64 {
    bound / f64::EPSILON
}

#[allow(clippy::cast_possible_truncation)] // rounding is the purpose
fn single(value: f64) -> f32 {
    value as f32
}

/// Largest errors of the energy and of the spatial momentum of a free body, in units of epsilon.
fn free<L>(body: L, velocity: [f64; 3], h: f64, steps: u32) -> Result<[f64; 2], Failure>
where
    L: DiscreteLagrangian<Scalar = f32, Group = SO3<f32>, Advected = ()> + Regular,
{
    // The inertia is that of the program after rounding, and the measurement is in double precision, whose rounding is
    // negligible.
    let inverse = inertia(&body, &body.advected()).cast::<f64>().try_inverse().ok_or("a singular inertia")?;
    let stepper = Stepper::new(body, single(h))?;
    let mut state = stepper.start(SO3::identity(), Vector3::from(velocity).cast::<f32>())?;
    let kept = |state: &liestep::motion::Motion<SO3<f32>, ()>| {
        let momentum = state.momentum().cast::<f64>();
        (momentum.dot(&(inverse * momentum)), state.attitude().matrix().cast::<f64>() * momentum)
    };
    let (start, mut worst) = (kept(&state), [0.0; 2]);
    for _ in 0..steps {
        stepper.step(&mut state)?;
        let now = kept(&state);
        worst[0] = greater(worst[0], (now.0 / start.0 - 1.0).abs() / EPSILON);
        worst[1] = greater(worst[1], relative(&now.1, &start.1) / EPSILON);
    }
    Ok(worst)
}

/// B1 to B4, in principal axes and with a full tensor.
fn bodies(mut row: Row) -> Result<Row, Failure> {
    // The box has half-extents 0.1, 0.2, 0.3 and 1 kg.
    let of_box = [0.01 / 3.0, 0.04 / 3.0, 0.09 / 3.0];
    let [thick, thin] = [1e-4 / 16.0, 1e-5 / 16.0].map(|across| [across, across, 1.0 / 12.0]);
    let (rod, plate) = ([1.0, 0.5, 3.0], [1.0, 0.5, 0.3]);
    let cases = [
        ("B1", of_box, [1.0, 2.0, 3.0], 0.01, 500, 1e-14),
        ("B2 middle axis", of_box, [0.05, 5.0, 0.05], 0.005, 20_000, 1e-13),
        ("B2 fast spin", of_box, [20.0, 0.05, 0.05], 0.005, 20_000, 1e-13),
        ("B3 rod 100:1", thick, rod, 1.0 / 60.0, 10_000, 1e-13),
        ("B3 rod 316:1", thin, rod, 1.0 / 60.0, 10_000, 1e-13),
        ("B3 plate", [2.0, 1.0, 0.0], plate, 1.0 / 60.0, 10_000, 1e-13),
    ];
    for (name, diagonal, velocity, h, steps, bound) in cases {
        let J_d = DiagonalNonstandardInertia::from_diagonal(Vector3::from(diagonal).cast::<f32>())?;
        let full = RigidBody { J_d: J_d.into() };
        for (axes, [energy, momentum]) in
            [("", free(PrincipalBody { J_d }, velocity, h, steps)?), (", full", free(full, velocity, h, steps)?)]
        {
            row = row.at_most(&format!("{name}{axes}: energy, ε"), energy, units(bound)).at_most(
                &format!("{name}{axes}: momentum, ε"),
                momentum,
                units(bound),
            );
        }
    }
    let sphere = RigidBody { J_d: NonstandardInertia::from_diagonal(Vector3::repeat(0.2_f32))? };
    row = row.at_most("B4 sphere: energy, ε", free(sphere, [1.0, 2.0, 3.0], 0.01, 10_000)?[0], 0.0);
    // The smaller moment is zero to the rounding of `f32`.
    let needle = NonstandardInertia::<f32>::from_diagonal([1e-8 / 16.0, 1e-8 / 16.0, 1.0 / 12.0].into());
    Ok(row.holds("B3 rod 10⁴:1 is refused", matches!(needle, Err(InertiaError::Singular { .. }))))
}

type Scene = Sum<PrincipalBody<f32>, Gravity<f32>>;
/// The state of a scene in which gravity advects the vertical.
type TurningState = State<SO3<f32>, ((), Vector3<f32>)>;

/// The top of a motion, and its initial state.
fn started(motion: &Motion, h: f64) -> Result<(Stepper<Scene>, TurningState), Failure> {
    let top = &motion.top;
    let body = PrincipalBody { J_d: DiagonalNonstandardInertia::from_diagonal(top.J_d.diagonal().cast::<f32>())? };
    let gravity = Gravity { m: single(top.m), g: single(top.g), rho: top.rho.cast(), up: top.up.cast() };
    let stepper = Stepper::new(body + gravity, single(h))?;
    let attitude = SO3::from_matrix_unchecked(motion.attitude.matrix().cast::<f32>());
    let state = stepper.start(attitude, motion.velocity.cast::<f32>())?;
    Ok((stepper, state))
}

/// T1: the errors of attitude and velocity after a second, above the rounding level of `f32`.
fn orders(mut row: Row) -> Result<Row, Failure> {
    for motion in Motion::of_the_thesis().iter().take(3) {
        let (attitude, velocity) = motion.at(1.0);
        let mut errors = Vec::new();
        for h in four_halvings(1.0 / 100.0) {
            let (stepper, mut state) = started(motion, h)?;
            for _ in 0..steps_in(1.0, h) {
                stepper.step(&mut state)?;
            }
            let found: Matrix3<f64> = state.attitude().matrix().cast();
            let velocities = relative(&stepper.velocity(&state).cast::<f64>(), &velocity);
            errors.push((h, relative(&found, &attitude).hypot(velocities)));
        }
        // The plateau is that of a thousand roundings and their effect on the attitude, well below the smallest error.
        row = row.near(&format!("T1 {}: order", motion.name), order(&errors, 200.0 * EPSILON), 2.0, 0.05);
    }
    Ok(row)
}

/// S1, S2: up to 0.999 of the fold a step is solved, in as many iterations as in `f64`; above it is refused, and the
/// error names a solvable step.
fn folds(mut row: Row, motion: &Motion) -> Result<Row, Failure> {
    let (wide, state) = started(motion, 1.0)?;
    let fold = f64::from(wide.max_step(&state));
    row = row.near("S1 fold", fold, 0.0815, 5e-5);
    let (stepper, mut state) = started(motion, 0.1)?;
    let named = match stepper.step(&mut state) {
        Err(StepError::BeyondSolvable { largest, .. }) => largest,
        _ => f64::NAN,
    };
    row = row.near("S2 largest step named", named, 0.0815, 1e-4);
    let (mut iterations, mut angle, mut refused) = (0.0, 0.0, true);
    for fraction in [0.1, 0.3, 0.6, 0.9, 0.99, 0.999] {
        let (stepper, mut state) = started(motion, named * fraction)?;
        let before = state.attitude();
        iterations = greater(iterations, f64::from(stepper.step(&mut state)?.iterations));
        let turn = before.inverse().compose(&state.attitude()).log().norm().to_degrees();
        angle = greater(angle, f64::from(turn));
    }
    for factor in [1.001, 1.1, 2.0, 100.0] {
        let (stepper, mut state) = started(motion, named * factor)?;
        let before = state;
        refused &= matches!(stepper.step(&mut state), Err(StepError::BeyondSolvable { .. })) && state == before;
    }
    Ok(row
        .at_most("S1 iterations up to 0.999 of the fold", iterations, 9.0)
        .at_most("S1 angle in degrees", angle, 91.0)
        .holds("S2 refused, state unchanged", refused))
}

/// S4: rest without gravity, and hanging.
fn at_rest(motion: &Motion) -> Result<bool, Failure> {
    let (stepper, _) = started(motion, 0.01)?;
    let Sum { first: body, second: gravity } = *stepper.scene();
    let tilted = SO3::from_matrix_unchecked(motion.attitude.matrix().cast::<f32>());
    let hanging = Gravity { up: -gravity.rho, ..gravity };
    let mut stays = true;
    for (gravity, attitude) in [(Gravity { g: 0.0, ..gravity }, tilted), (hanging, SO3::identity())] {
        let stepper = Stepper::new(body + gravity, 0.01)?;
        let mut state = stepper.start(attitude, Vector3::zeros())?;
        let seen = |state: &TurningState| (state.attitude(), state.momentum(), state.advected());
        let before = seen(&state);
        for _ in 0..1000 {
            stepper.step(&mut state)?;
            stays &= seen(&state) == before;
        }
    }
    Ok(stays)
}

/// S5: the distances from the start after a million steps forwards and back: attitude, momentum and vertical, in ε.
fn there_and_back(motion: &Motion, h: f64) -> Result<[f64; 3], Failure> {
    let (there, mut state) = started(motion, h)?;
    let ((back, _), before) = (started(motion, -h)?, state);
    for stepper in [there, back] {
        for _ in 0..1_000_000 {
            stepper.step(&mut state)?;
        }
    }
    let errors = [
        f64::from((state.attitude().matrix() - before.attitude().matrix()).norm()) / 3.0_f64.sqrt(),
        relative(&state.momentum().cast::<f64>(), &before.momentum().cast::<f64>()),
        relative(&state.advected().1.cast::<f64>(), &before.advected().1.cast::<f64>()),
    ];
    Ok(errors.map(|error| error / EPSILON))
}

/// The largest of the medians of three errors over an octave of step sizes. The distance is a walk of roundings, and
/// neighbouring step sizes differ by a factor of ten.
fn median(motion: &Motion, h: f64) -> Result<f64, Failure> {
    let runs: Result<Vec<_>, Failure> =
        (0..9).map(|k| there_and_back(motion, h / 2_f64.powf(f64::from(k) / 8.0))).collect();
    let runs = runs?;
    let medians = [0, 1, 2].map(|part| {
        let mut units: Vec<_> = runs.iter().map(|units| units[part]).collect();
        units.sort_by(f64::total_cmp);
        units[4]
    });
    Ok(medians.into_iter().fold(0.0, greater))
}

/// T3: a million steps.
fn million(row: Row, motion: &Motion) -> Result<Row, Failure> {
    const STEPS: u64 = 1_000_000;
    let (stepper, mut state) = started(motion, 0.01)?;
    let (axial, vertical) = (state.momentum().z, state.momentum().dot(&state.advected().1));
    // The measurement is in double precision, whose rounding is negligible.
    let (moments, weight) = (motion.top.moments(), f64::from(single(motion.top.m * motion.top.g)));
    let energy = |state: &TurningState| {
        let (p, w) = (state.momentum().cast::<f64>(), state.advected().1.cast::<f64>());
        0.5 * p.dot(&p.component_div(&moments)) + weight * w.dot(&motion.top.rho)
    };
    let (start, mut energies) = (energy(&state), Tenths::new(STEPS));
    let (mut changed, mut casimirs, mut orthogonality) = (0_u32, 0.0, 0.0);
    for step in 1..=STEPS {
        stepper.step(&mut state)?;
        energies.after(step, || energy(&state) - start);
        changed += u32::from(state.momentum().z.to_bits() != axial.to_bits());
        let relative = f64::from(state.momentum().dot(&state.advected().1) / vertical - 1.0).abs();
        casimirs = greater(greater(casimirs, relative), f64::from(state.advected().1.norm() - 1.0).abs());
        orthogonality = greater(orthogonality, f64::from(state.orthogonality_defect()));
    }
    // The bound is for a walk of 10⁶ roundings; in `f64` it is 10⁻¹⁰ for ten times as many.
    Ok(row
        .at_most("T3, 10⁶ steps: steps that changed p₃", f64::from(changed), 0.0)
        .at_most("T3: energy window means, ε", energies.drift() / start / EPSILON, 450.0)
        .at_most("T3: ‖RᵀR − I‖, ε", orthogonality / EPSILON, units(2e-12))
        .at_most("T3: Casimirs, ε", casimirs / EPSILON, units(3e-12)))
}

pub(crate) fn p8(_: Effort) -> Result<Row, Failure> {
    let motion = Motion::looping();
    let mut row = Row::new("P8", "f32", "thresholds of f64 in units of epsilon; the same errors");
    row = folds(orders(bodies(row)?)?, &motion)?.holds("S4 at rest, weightless and hanging", at_rest(&motion)?);
    for h in [1e-5, 1e-4] {
        let what = format!("S5, a million steps of {h} there and back: median of nine near ones, ε");
        row = row.at_most(&what, median(&motion, h)?, units(1e-12));
    }
    million(row, &motion)
}
