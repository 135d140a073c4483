//! A top of one type, for nearly all tests of observed and recorded runs.

use declarations::HeavyTop;
use liestep::prelude::*;
use nalgebra::{UnitQuaternion, Vector3};

pub(crate) const VELOCITY: Vector3<f64> = Vector3::new(0.5, 2.0, 12.0);

pub(crate) type Top = Stepper<HeavyTop>;
pub(crate) type TopState = StateOf<HeavyTop>;

pub(crate) fn top(h: f64) -> (Top, TopState) {
    let stepper = Stepper::new(HeavyTop::thesis(), h).unwrap();
    let state = stepper.start(UnitQuaternion::from_scaled_axis(Vector3::new(0.8, 0.0, 0.0)), VELOCITY).unwrap();
    (stepper, state)
}
