//! T9: other units of mass and time.

use declarations::{HeavyTop, Motion};
use liestep::prelude::*;
use nalgebra::{Matrix3, Vector3};

use crate::row::{Effort, Failure, Row};

/// The attitude, the momentum and the vertical in the body frame.
type End = (Matrix3<f64>, Vector3<f64>, Vector3<f64>);

/// The end of a motion with masses and times multiplied, in the old units.
fn moved(motion: &Motion, mass: f64, time: f64) -> Result<End, Failure> {
    let top = &motion.top;
    let scaled = HeavyTop {
        J_d: DiagonalNonstandardInertia::from_diagonal(top.J_d.diagonal() * mass)?,
        m: top.m * mass,
        g: top.g / (time * time),
        ..top.clone()
    };
    let stepper = Stepper::new(scaled, 0.01 * time)?;
    let mut state = stepper.start(motion.attitude, motion.velocity / time)?;
    for _ in 0..100_000 {
        stepper.step(&mut state)?;
    }
    Ok((state.attitude().matrix(), state.momentum() * (time / mass), state.advected()))
}

pub(crate) fn t9(_: Effort) -> Result<Row, Failure> {
    let mut row = Row::new("T9", "mass × 2ᵏ, time × 2ᵏ, 10⁵ steps", "the same bits, k to ± 200 in mass");
    for motion in [Motion::looping(), Motion::chaotic()] {
        let original = moved(&motion, 1.0, 1.0)?;
        for k in [30, -30, 200, -200] {
            let same = moved(&motion, 2.0_f64.powi(k), 1.0)? == original;
            row = row.holds(&format!("{}: mass × 2^{k}", motion.name), same);
        }
        for k in [30, -40] {
            let same = moved(&motion, 1.0, 2.0_f64.powi(k))? == original;
            row = row.holds(&format!("{}: time × 2^{k}", motion.name), same);
        }
    }
    Ok(row)
}
