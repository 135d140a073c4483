//! S5: the step of zero, and the step of `−h`.

use declarations::Motion;
use liestep::groups::LieGroup as _;
use workbench::heavy_top::rk4::{Body, OnQuaternion};
use workbench::measure::relative;
use workbench::run::Method as _;

use crate::rivals::{on_quaternion, started};
use crate::row::{Effort, Failure, Row, short};

const STEPS: u64 = 1_000_000;

/// The relative error of attitude, momentum and `w` after steps forwards and back.
fn error_on_return(motion: &Motion, h: f64, steps: u64) -> Result<f64, Failure> {
    let (there, mut state) = started(motion, h)?;
    let (back, before) = (there.inverse()?, state);
    for stepper in [there, back] {
        for _ in 0..steps {
            stepper.step(&mut state)?;
        }
    }
    let attitude = relative(&state.attitude().matrix(), &before.attitude().matrix());
    let momentum = relative(&state.momentum(), &before.momentum());
    Ok(attitude.max(momentum).max(relative(&state.advected(), &before.advected())))
}

pub(crate) fn s5(effort: Effort) -> Result<Row, Failure> {
    let motion = Motion::looping();
    let (standing, mut state) = started(&motion, 0.0)?;
    let before = (state.attitude(), state.momentum(), state.advected());
    standing.step(&mut state)?;
    let stands = (state.attitude(), state.momentum(), state.advected()) == before;

    let mut rk4 = on_quaternion(&motion, 1e-4);
    let start = rk4.sample();
    rk4.advance(effort.beside(STEPS))?;
    let turned = rk4.sample();
    let quaternion = nalgebra::UnitQuaternion::from_matrix(&turned.attitude);
    let mut rk4 = OnQuaternion::new(Body::of(&motion.top), -1e-4, &quaternion, turned.momentum);
    rk4.advance(effort.beside(STEPS))?;
    let end = rk4.sample();
    let theirs = relative(&end.attitude, &start.attitude).max(relative(&end.momentum, &start.momentum));
    let row = Row::new("S5", "a million steps there and back, looping top", "h = 0 is the identity; back to 1e-12")
        .holds("h = 0 is the identity", stands)
        .at_most("h = 1e-5: error", error_on_return(&motion, 1e-5, STEPS)?, 1e-12)
        .at_most("h = 1e-4: error", error_on_return(&motion, 1e-4, STEPS)?, 1e-12)
        .shows(format!(
            "h = 1e-2 (10⁴ s, where a rounding of the rate has grown with time): {}",
            short(error_on_return(&motion, 1e-2, effort.beside(STEPS))?)
        ));
    Ok(row.other(format!("RK4 (quaternion), h = 1e-4: {}", short(theirs))))
}
