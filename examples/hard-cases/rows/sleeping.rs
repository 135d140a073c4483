//! T5: the sleeping top on both sides of its critical speed.

use declarations::HeavyTop;
use liestep::Stepper;
use nalgebra::{UnitQuaternion, Vector3};
use workbench::heavy_top::rk4::{Body, OnQuaternion};
use workbench::measure::float;
use workbench::run::Method as _;

use crate::row::{Effort, Failure, Row, short};

const H: f64 = 0.01;

/// The critical speed `√(4 m g l J_1)/J_3`.
fn critical_speed() -> f64 {
    (4.0 * 9.81 * 3.0_f64).sqrt() / 4.0
}

fn start(fraction: f64) -> (UnitQuaternion<f64>, Vector3<f64>) {
    (UnitQuaternion::from_scaled_axis(Vector3::x() * 1e-9), Vector3::z() * (fraction * critical_speed()))
}

/// The tilt in radians after each step.
fn tilts(fraction: f64, steps: usize) -> Result<Vec<f64>, Failure> {
    let stepper = Stepper::new(HeavyTop::thesis(), H)?;
    let (attitude, velocity) = start(fraction);
    let mut state = stepper.start(attitude, velocity)?;
    let mut tilts = Vec::with_capacity(steps);
    for _ in 0..steps {
        stepper.step(&mut state)?;
        tilts.push(state.advected().xy().norm());
    }
    Ok(tilts)
}

/// The tilts by Runge–Kutta.
fn rk4_tilts(fraction: f64, steps: usize) -> Result<Vec<f64>, Failure> {
    let body = Body::of(&HeavyTop::thesis());
    let (attitude, velocity) = start(fraction);
    let mut method = OnQuaternion::new(body, H, &attitude, velocity.component_div(&body.inverse_moments));
    let mut tilts = Vec::with_capacity(steps);
    for _ in 0..steps {
        method.advance(1)?;
        tilts.push(method.sample().attitude.fixed_view::<1, 2>(2, 0).norm());
    }
    Ok(tilts)
}

/// The growth rate of the tilt from 1e-6 to 1e-4 rad, where the decaying mode is negligible and the motion is linear.
fn growth_rate(tilts: &[f64]) -> f64 {
    let reached = |tilt: f64| tilts.iter().position(|&t| t > tilt);
    let (Some(start), Some(end)) = (reached(1e-6), reached(1e-4)) else { return f64::NAN };
    #[allow(clippy::cast_precision_loss)] // some thousand steps
    let time = H * (end - start) as f64;
    (tilts[end] / tilts[start]).ln() / time
}

/// The rate of the linearised continuous top, 1/s.
fn continuous_rate(fraction: f64) -> f64 {
    let (j1, spin) = (3.0, 4.0 * fraction * critical_speed());
    (9.81 / j1 - (spin / (2.0 * j1)).powi(2)).sqrt()
}

pub(crate) fn t5(effort: Effort) -> Result<Row, Failure> {
    let mut row = Row::new(
        "T5",
        "sleeping top on both sides of ω_c = 2.712471, h = 0.01",
        "growth rate .788 at .9 ω_c, .254 at .99 ω_c, none at 1.01 ω_c",
    )
    .near("ω_c", critical_speed(), 2.712_471, 5e-7);
    for (fraction, known) in [(0.9, 0.788_03), (0.99, 0.254_10)] {
        row = row.near(&format!("rate at {fraction} ω_c"), growth_rate(&tilts(fraction, 10_000)?), known, 1e-5).other(
            format!(
                "RK4 at {fraction} ω_c: {:.5} (continuous top {:.5})",
                growth_rate(&rk4_tilts(fraction, 10_000)?),
                continuous_rate(fraction)
            ),
        );
    }
    let steps: u32 = if effort.long { 10_000_000 } else { 200_000 };
    let largest = |tilts: &[f64]| tilts.iter().copied().fold(0.0, f64::max);
    // The two frequencies beat, and near the threshold they nearly agree: the largest tilt is the initial one times
    // their mean over half their difference.
    for fraction in [1.01, 1.1, 2.0] {
        let tilts = tilts(fraction, steps as usize)?;
        let (first, second) = tilts.split_at(tilts.len() / 2);
        let what = format!("{fraction} ω_c, {:.0e} steps: largest tilt", float(u64::from(steps)));
        row = row.at_most(&what, largest(&tilts), 1e-8).at_most(
            "its change from the first half to the second",
            (largest(second) / largest(first) - 1.0).abs(),
            1e-3,
        );
    }
    let theirs = rk4_tilts(1.01, if effort.verdict_only { 2 } else { steps as usize })?;
    let (first, second) = theirs.split_at(theirs.len() / 2);
    Ok(row.other(format!("RK4 at 1.01 ω_c: largest tilt {} and {}", short(largest(first)), short(largest(second)))))
}
