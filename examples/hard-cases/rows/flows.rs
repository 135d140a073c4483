//! P5: two forms of the flow, and two forms of the scene.

use declarations::{FreeBody, FullTop, Motion};
use liestep::mechanics::{DiscreteLagrangian, Regular, inertia};
use liestep::motion::{DiscreteEulerPoincare, reconstruct};
use liestep::numbers::Entries as _;
use liestep::prelude::*;
use nalgebra::Vector3;
use workbench::measure::{greater, relative};

use crate::row::{Effort, Failure, Row};

const STEPS: u32 = 1000;

/// The bound for rounding errors. The flow on increments computes `μ` from `F` and so rounds it to `ε J/h`, relatively
/// `ε/(hΩ)`, in every step. Such errors walk to `√n ε/(hΩ)` in the rate and to `n^{3/2} ε` in the angle after `n`
/// steps, for any `h`.
fn rounding_after(steps: u32) -> f64 {
    4.0 * f64::from(steps).powf(1.5) * f64::EPSILON
}

/// The distances of the flows (2.5) and (2.8) along a motion, in units of rounding: of `F`, of the attitudes by (2.10),
/// of the momenta and of the parameters.
fn flows<L>(lagrangian: &L, motion: &Motion, h: f64) -> Result<f64, Failure>
where
    L: DiscreteLagrangian<Scalar = f64, Group = SO3> + Regular + Clone,
{
    let stepper = Stepper::new(lagrangian.clone(), h)?;
    let mut state = stepper.start(motion.attitude, motion.velocity)?;
    let (mut attitude, mut w) = (state.attitude(), state.advected());
    let mut f = stepper.flow().invert_legendre_minus(&state.momentum(), &w, &Vector3::zeros())?;
    let on_increments = DiscreteEulerPoincare::new(lagrangian.clone(), h)?;
    let mut worst = 0.0;
    for step in 1..=STEPS {
        let before = state.attitude();
        stepper.step(&mut state)?;
        let increment = before.inverse().compose(&state.attitude());
        attitude = reconstruct(&attitude, &f);
        let mut error = relative(&f.matrix(), &increment.matrix());
        error = greater(error, relative(&attitude.matrix(), &state.attitude().matrix()));
        (f, w) = on_increments.step(&f, &w)?;
        let momentum = lagrangian.legendre_minus(&f.matrix(), &w, h);
        error = greater(
            error,
            (momentum - state.momentum()).norm() * h / inertia(lagrangian, &lagrangian.advected()).norm(),
        );
        let (mut apart, mut size) = (0.0, 1.0);
        let _ = w.zip(&state.advected(), &mut |a, b| {
            apart += (a - b) * (a - b);
            size += b * b;
            a
        });
        error = greater(error, f64::sqrt(apart / size));
        worst = greater(worst, error / rounding_after(step));
    }
    Ok(worst)
}

/// The distances between the sum of the effects and (3.13).
fn sums(motion: &Motion, h: f64) -> Result<f64, Failure> {
    let top = &motion.top;
    let scene = PrincipalBody { J_d: top.J_d } + Gravity { m: top.m, g: top.g, rho: top.rho, up: top.up };
    let (summed, declared) = (Stepper::new(scene, h)?, Stepper::new(top.clone(), h)?);
    let mut one = summed.start(motion.attitude, motion.velocity)?;
    let mut other = declared.start(motion.attitude, motion.velocity)?;
    let mut worst = 0.0;
    for step in 1..=STEPS {
        summed.step(&mut one)?;
        declared.step(&mut other)?;
        let error = greater(
            relative(&one.momentum(), &other.momentum()),
            relative(&one.attitude().matrix(), &other.attitude().matrix()),
        );
        worst = greater(worst, error / rounding_after(step));
    }
    Ok(worst)
}

pub(crate) fn p5(_: Effort) -> Result<Row, Failure> {
    let mut row = Row::new(
        "P5",
        "(2.5) and (2.8); the sum of effects and (3.13), 1000 steps",
        "round-off, 4 n^{3/2} ε at step n",
    );
    let looping = Motion::looping();
    for (motion, steps) in [(&looping, [0.001, 0.01, 0.05].as_slice()), (&Motion::chaotic(), &[0.001, 0.01])] {
        for &h in steps {
            let name = format!("{}, h = {h}", motion.name);
            row = row.at_most(&format!("{name}: the two flows"), flows(&motion.top, motion, h)?, 1.0);
            row = row.at_most(&format!("{name}: sum and struct"), sums(motion, h)?, 1.0);
        }
    }
    let axes = nalgebra::Rotation3::from_euler_angles(0.3, -0.7, 1.1).into_inner();
    let full = FullTop::in_axes(&looping.top, &axes);
    row = row.at_most("full tensor: the two flows", flows(&full, &looping, 0.01)?, 1.0);
    for moments in [[3.0, 3.0, 4.0], [2.0, 3.0, 4.5]] {
        let body = FreeBody::with_moments(moments);
        row = row.at_most(&format!("free body {moments:?}: the two flows"), flows(&body, &looping, 0.01)?, 1.0);
    }
    Ok(row)
}
