//! T1: the tops of the thesis against references of 33 digits.

use declarations::Motion;
use liestep::groups::LieGroup as _;
use workbench::heavy_top::rk4::Body;
use workbench::measure::{four_halvings, greater, order, relative, steps_in};
use workbench::run::Method as _;

use crate::rivals::{on_quaternion, started};
use crate::row::{Effort, Failure, Row};

/// The level of errors below which the rounding of the longest run counts.
const PLATEAU: f64 = 1e-11;

fn error(motion: &Motion, t: f64, h: f64) -> Result<f64, Failure> {
    let (stepper, mut state) = started(motion, h)?;
    for _ in 0..steps_in(t, h) {
        stepper.step(&mut state)?;
    }
    let (attitude, velocity) = motion.at(t);
    Ok(relative(&state.attitude().matrix(), &attitude).hypot(relative(&stepper.velocity(&state), &velocity)))
}

fn rk4_error(motion: &Motion, t: f64, h: f64) -> Result<f64, Failure> {
    let mut method = on_quaternion(motion, h);
    method.advance(steps_in(t, h))?;
    let (attitude, velocity) = motion.at(t);
    let end = method.sample();
    let rates = Body::of(&motion.top).inverse_moments.component_mul(&end.momentum);
    Ok(relative(&end.attitude, &attitude).hypot(relative(&rates, &velocity)))
}

/// The order, and the error of the coarsest step.
fn measured(error: impl Fn(f64) -> Result<f64, Failure>, coarsest: f64) -> Result<(f64, f64), Failure> {
    let mut errors = Vec::new();
    for h in four_halvings(coarsest) {
        errors.push((h, error(h)?));
    }
    Ok((order(&errors, PLATEAU), errors[0].1))
}

pub(crate) fn t1(effort: Effort) -> Result<Row, Failure> {
    let mut row = Row::new(
        "T1",
        "the three tops of the thesis, both readings, t = 1, 10, 100",
        "order 2.00 ± 0.05 over four halvings",
    );
    let motions = Motion::of_the_thesis();
    // The phase error grows with time, so the last time needs the smallest steps.
    for (t, coarsest) in [(1.0, 1.0 / 200.0), (10.0, 1.0 / 1600.0), (100.0, 1.0 / 3200.0)] {
        let (mut off, mut orders) = (0.0, Vec::new());
        // Each motion has ten million steps up to the last time.
        let few = if effort.verdict_only && t > 50.0 { 1 } else { motions.len() };
        for motion in motions.iter().take(few) {
            let (order, _) = measured(|h| error(motion, t, h), coarsest)?;
            off = greater(off, (order - 2.0).abs());
            orders.push(format!("{} {order:.3}", motion.name));
        }
        row = row.at_most(&format!("t = {t}: farthest from 2"), off, 0.05).shows(orders.join(", "));
    }
    let looping = &motions[0];
    let coarsest = 1.0 / 200.0;
    let (slope, theirs) = measured(|h| rk4_error(looping, 10.0, h), coarsest)?;
    let ours = error(looping, 10.0, coarsest)?;
    Ok(row.other(format!(
        "RK4 (quaternion): order {slope:.2}; looping A, t = 10, h = 0.005: error {theirs:.1e} against {ours:.1e} of ours"
    )))
}
