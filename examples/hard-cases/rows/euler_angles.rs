//! T10: the top in Euler angles, (3.10) to (3.12), away from the poles and through one.

use declarations::{HeavyTop, Motion};
use liestep::Stepper;
use liestep::groups::LieGroup as _;
use nalgebra::Vector3;
use workbench::heavy_top::euler_angles::OnEulerAngles;
use workbench::measure::{four_halvings, greater, order, relative, steps_in};
use workbench::run::{Method as _, Sample};

use crate::rivals::{energy_of, started};
use crate::row::{Effort, Failure, Row};
use crate::rows::passage;

/// The duration, s; all motions of the thesis are far from the poles until then.
const TIME: f64 = 2.0;
/// A step whose own error is negligible beside that of the angles, s.
const FINE: f64 = 1.0 / 4096.0;

/// The attitude and momentum by the angles.
fn by_angles(motion: &Motion, t: f64, h: f64) -> Result<Sample, Failure> {
    let mut method = OnEulerAngles::new(&motion.top, h, &motion.attitude.matrix(), &motion.velocity);
    method.advance(steps_in(t, h))?;
    Ok(method.sample())
}

/// The distance of our end after steps of `h` from the angles' end.
fn error(motion: &Motion, end: &Sample, h: f64) -> Result<f64, Failure> {
    let (stepper, mut state) = started(motion, h)?;
    stepper.run(&mut state, steps_in(TIME, h))?;
    Ok(relative(&state.attitude().matrix(), &end.attitude).hypot(relative(&state.momentum(), &end.momentum)))
}

/// The relative changes of the energy and of the vertical momentum by steps of `h`, for the angles and for our method,
/// from a second before the nearest approach to the pole to most of a second after it.
fn through_the_pole(h: f64, miss: f64) -> Result<[(f64, f64); 2], Failure> {
    let top = HeavyTop::thesis();
    let stepper = Stepper::new(top.clone(), h)?;
    let mut state = passage::before(&stepper, 0.0, miss)?;
    let velocity: Vector3<f64> = stepper.velocity(&state);
    let start = Sample { attitude: state.attitude().matrix(), momentum: state.momentum() };
    let mut method = OnEulerAngles::new(&top, h, &start.attitude, &velocity);
    // The end isn't the mirror image of the start, where every reversible method has the initial energy.
    let steps = steps_in(1.75, h);
    method.advance(steps)?;
    stepper.run(&mut state, steps)?;
    let ours = Sample { attitude: state.attitude().matrix(), momentum: state.momentum() };
    let change = |end: &Sample| {
        let (before, after) = (energy_of(&top, &start), energy_of(&top, end));
        let vertical = |sample: &Sample| (sample.attitude * sample.momentum).z;
        let change = |a: f64, b: f64| if b.is_finite() { (b / a - 1.0).abs() } else { f64::INFINITY };
        (change(before, after), change(vertical(&start), vertical(end)))
    };
    Ok([change(&method.sample()), change(&ours)])
}

pub(crate) fn t10(_: Effort) -> Result<Row, Failure> {
    let mut row = Row::new(
        "T10",
        "Euler angles, (3.10) to (3.12): the thesis' tops for 2 s, and a passage within 5e-7 rad of straight up",
        "our order against them 2.00 ± 0.05; ours passes, RK4 on the angles doesn't",
    );
    let (mut off, mut apart) = (0.0, 0.0);
    for motion in &Motion::of_the_thesis() {
        let (attitude, velocity) = motion.at(1.0);
        let sample = by_angles(motion, 1.0, FINE)?;
        let momentum = motion.top.ordinary_inertia().as_matrix() * velocity;
        apart = greater(apart, relative(&sample.attitude, &attitude).hypot(relative(&sample.momentum, &momentum)));
        let end = by_angles(motion, TIME, FINE)?;
        let mut errors = Vec::new();
        for h in four_halvings(1.0 / 128.0) {
            errors.push((h, error(motion, &end, h)?));
        }
        off = greater(off, (order(&errors, 1e-9) - 2.0).abs());
    }
    row = row.at_most("the angles against 33 digits at t = 1, RK4 with h = 1/4096", apart, 1e-9).at_most(
        "six tops: farthest from order 2",
        off,
        0.05,
    );
    for h in [0.01, 0.001] {
        let [theirs, ours] = through_the_pole(h, passage::MISS)?;
        row = row
            .at_most(&format!("h = {h}: our energy changes by"), ours.0, 100.0 * h * h)
            .at_most(&format!("h = {h}: our vertical momentum by"), ours.1, 1e-12)
            .holds(&format!("h = {h}: the angles' energy changes by {:.1e}", theirs.0), theirs.0 > 1.0);
    }
    // The distance from the pole is varied.
    for miss in [0.1, 0.01, 0.001] {
        let [theirs, _] = through_the_pole(0.001, miss)?;
        row = row.other(format!("RK4 on the angles, h = 0.001, within {miss} rad: energy changes by {:.1e}", theirs.0));
    }
    Ok(row)
}
