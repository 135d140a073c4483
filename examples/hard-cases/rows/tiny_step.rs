//! T4: steps so small that `F` is the identity in most of its digits.

use declarations::Motion;
use liestep::prelude::*;
use nalgebra::Vector3;
use workbench::heavy_top::continuous::{phase, solution};
use workbench::measure::{relative, steps_in};
use workbench::run::Method as _;

use crate::rivals::{on_quaternion, started};
use crate::row::{Effort, Failure, Row, short};

const TIME: f64 = 0.01;

/// A step with products in place of sums: `R F`, `Fᵀ w`, `Fᵀ a`, as in the textbook form.
fn by_products(motion: &Motion, h: f64) -> Result<Vector3<f64>, Failure> {
    let (stepper, state) = started(motion, h)?;
    let (mut momentum, mut w, mut guess) = (state.momentum(), state.advected(), Vector3::zeros());
    let half_kick = motion.top.rho * (0.5 * h * motion.top.m * motion.top.g);
    for _ in 0..steps_in(TIME, h) {
        let step = stepper.flow().step(&momentum, &w, &guess)?;
        let f = SO3::from_increment(&step.increment).matrix();
        let turned = f.transpose() * (momentum + w.cross(&half_kick));
        w = f.transpose() * w;
        momentum = turned + w.cross(&half_kick);
        guess = step.coordinates;
    }
    Ok(momentum)
}

pub(crate) fn t4(_: Effort) -> Result<Row, Failure> {
    let (motion, h) = (Motion::looping(), 1e-8);
    let (stepper, mut plain) = started(&motion, h)?;
    let carrying = stepper.clone().compensated();
    let mut kept = carrying.start(motion.attitude, motion.velocity)?;
    // The error of Runge and Kutta's method over 200 steps of 0.0006 rad is about 10⁻¹⁶ of the turn of 0.12 rad; the
    // scheme's own is `(hΩ)²/6` of it, 3·10⁻¹⁶.
    let exact = solution(&motion.top, phase(&plain.momentum(), &plain.advected()), TIME, 200);
    let (exact, w): (Vector3<f64>, Vector3<f64>) = (exact.fixed_rows::<3>(0).into(), exact.fixed_rows::<3>(3).into());
    for _ in 0..steps_in(TIME, h) {
        stepper.step(&mut plain)?;
        carrying.step(&mut kept)?;
    }
    let mut rk4 = on_quaternion(&motion, h);
    rk4.advance(steps_in(TIME, h))?;
    // An increment of 10⁻⁷ is rounded to 10⁻²³; only its addition loses half a unit of the sum, at random. The numbers
    // of the vertical and of the attitude are of size one, and lose a million roundings of that size.
    let row = Row::new("T4", "h = 1e-8, a million steps", "momentum to 1e-14, relative")
        .at_most("error", relative(&plain.momentum(), &exact), 1e-14)
        .at_most("compensated: error", relative(&kept.momentum(), &exact), 1e-14)
        .at_most("vertical", relative(&plain.advected(), &w), 1e-13)
        .at_most("attitude", relative(&plain.attitude().matrix().row(2).transpose(), &w), 1e-13);
    let products = relative(&by_products(&motion, h)?, &exact);
    Ok(row
        .other(format!("the same equations with R F and Fᵀ a: {}", short(products)))
        .other(format!("RK4 (quaternion): {}", short(relative(&rk4.sample().momentum, &exact)))))
}
