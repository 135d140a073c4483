//! S1, S2: steps up to the fold, where the momentum equation loses its solution, and beyond.

use declarations::Motion;
use liestep::motion::Solvability;
use liestep::prelude::*;
use workbench::measure::{greater, relative};
use workbench::run::Method as _;

use crate::rivals::{energy_of, on_quaternion, started};
use crate::row::{Effort, Failure, Row, short};

/// The largest solvable step of a symmetric top by the closed criterion: with `κ = h a_3/(2 J_3)`,
/// `(h|a_⊥|/2)² ≤ max over X of (1 − X − κ²/X)(J_1² X + (J_3 − J_1)² κ²/X)`, where `X = q_0²`.
fn fold_of_symmetric_top(motion: &Motion) -> Result<f64, Failure> {
    let j = motion.top.moments();
    let momentum = j.component_mul(&motion.velocity);
    let w = motion.attitude.adjoint_transpose(&motion.top.up);
    largest(|h| {
        let a = momentum + w.cross(&motion.top.rho) * (0.5 * h * motion.top.m * motion.top.g);
        let kappa_squared = (h * a.z / (2.0 * j.z)).powi(2);
        let bound =
            |x: f64| (1.0 - x - kappa_squared / x) * (j.x.powi(2) * x + (j.z - j.x).powi(2) * kappa_squared / x);
        let best = (1..200_000).map(|i| bound(f64::from(i) / 200_000.0)).fold(f64::NEG_INFINITY, f64::max);
        Ok((0.5 * h * a.x.hypot(a.y)).powi(2) <= best)
    })
}

/// The first step of a motion: its iterations and its angle in degrees; an error if there is no solution.
fn first_step(motion: &Motion, h: f64) -> Result<Result<(u32, f64), StepError>, Failure> {
    let (stepper, mut state) = started(motion, h)?;
    let before = state.attitude();
    Ok(stepper.step(&mut state).map(|report| {
        let increment = before.inverse().compose(&state.attitude());
        (report.iterations, increment.log().norm().to_degrees())
    }))
}

/// The largest step up to 1 s for which the predicate holds; it does for small ones.
fn largest(holds: impl Fn(f64) -> Result<bool, Failure>) -> Result<f64, Failure> {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        if holds(middle)? { low = middle } else { high = middle }
    }
    Ok(low)
}

pub(crate) fn s1(_: Effort) -> Result<Row, Failure> {
    let motion = Motion::looping();
    let known = |h: f64| -> Result<Solvability, Failure> {
        let (stepper, state) = started(&motion, h)?;
        Ok(stepper.solvability(&state))
    };
    let certain = largest(|h| Ok(known(h)? == Solvability::Certain))?;
    let impossible = largest(|h| Ok(known(h)? != Solvability::Impossible))?;
    let (wide, state) = started(&motion, 1.0)?;
    let fold = wide.max_step(&state);

    let (mut angles, mut iterations) = (Vec::new(), 0);
    let fractions = (1..=198).map(|k| f64::from(k) / 200.0).chain([0.995, 0.998, 0.999]);
    for fraction in fractions {
        let h = fraction * fold;
        let (count, angle) = first_step(&motion, h)?.map_err(|error| format!("at {fraction} of the fold: {error}"))?;
        angles.push(angle);
        iterations = count.max(iterations);
    }
    let grows = angles.windows(2).all(|pair| pair[1] > pair[0]);
    let closed = fold_of_symmetric_top(&motion)?;
    let (mut named, mut told) = (0.0, true);
    for factor in [1.000_01, 1.001, 1.006, 1.01, 1.1, 1.5, 2.0, 3.0, 10.0, 100.0, 1e6] {
        let h = factor * closed;
        named = match first_step(&motion, h)? {
            Err(error @ StepError::BeyondSolvable { step, largest, .. }) => {
                told &= step.to_bits() == h.to_bits() && error.to_string().contains(&format!("{largest:e} s"));
                greater(named, (largest / closed - 1.0).abs())
            }
            _ => f64::NAN,
        };
    }
    let row = Row::new(
        "S1",
        "step scan of the looping top up to the fold",
        "solved on the right branch (below 91°) in 9 iterations up to 0.999 of the fold; beyond it an error that names \
         the largest step",
    )
    .near("guaranteed h", certain, 0.0615, 5e-5)
    .near("fold", fold, 0.0815, 5e-5)
    .near("fold by the closed criterion of a symmetric top", closed, 0.0815, 5e-5)
    .at_most("impossible", impossible, 0.0820)
    .at_most("Newton iterations", f64::from(iterations), 9.0)
    .at_most("angle in degrees", angles.into_iter().fold(0.0, greater), 91.0)
    .holds("the angle grows with the step", grows)
    .at_most("largest step named in errors, relative error", named, 1e-5)
    .holds("errors tell both steps", told);
    Ok(row)
}

pub(crate) fn s2(_: Effort) -> Result<Row, Failure> {
    let (motion, h) = (Motion::looping(), 0.1);
    let (stepper, mut state) = started(&motion, h)?;
    let before = state;
    let refused = stepper.step(&mut state);
    // The text of a float has all its digits and the sign of zero.
    let same = format!("{before:?}") == format!("{state:?}");
    let fold = fold_of_symmetric_top(&motion)?;
    let is_typed = matches!(refused, Err(StepError::BeyondSolvable { step, largest, .. })
        if (step - h).abs() < f64::EPSILON && (largest / fold - 1.0).abs() < 1e-5);
    let answer = refused.map_or_else(|error| error.to_string(), |report| format!("{report:?}"));

    let mut rk4 = on_quaternion(&motion, h);
    let start = rk4.sample();
    rk4.advance(2000)?;
    let end = rk4.sample();
    let energy = energy_of(&motion.top, &end) / energy_of(&motion.top, &start) - 1.0;
    let vertical = relative(&(end.attitude * end.momentum).row(2), &(start.attitude * start.momentum).row(2));
    let row = Row::new(
        "S2",
        "h = 0.1, as in the script of the thesis' author",
        "typed error at the first step, state unchanged to the bit",
    )
    .holds(&answer, is_typed)
    .holds("state unchanged", same);
    Ok(row.other(format!(
        "RK4 (quaternion) makes 2000 such steps: relative change of the energy {energy:+.1e}, of the vertical momentum {}",
        short(vertical)
    )))
}
