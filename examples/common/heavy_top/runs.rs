//! A case of the thesis by three methods.

use liestep::Stepper;

use super::cases::{Case, Reading};
use super::quantities::Series;
use super::rk4::{Body, OnMatrix, OnQuaternion};
use crate::args::Failure;
use crate::plot::{BLUE, GREEN, ORANGE};
use crate::run::{Schedule, run};
use crate::variational::Variational;

/// The variational run and its two rivals.
pub fn all_methods(case: Case, reading: Reading, schedule: &Schedule) -> Result<[Series; 3], Failure> {
    let stepper = Stepper::new(reading.top()?, schedule.step)?;
    let (attitude, velocity) = case.start();
    let state = stepper.start(attitude, velocity)?;
    let body = Body::of(stepper.scene());
    let (h, momentum) = (schedule.step, state.momentum());
    let ours = run("variational", Variational { stepper: &stepper, state }, schedule)?;
    let quaternion = run("RK4, quaternion", OnQuaternion::new(body, h, &attitude, momentum), schedule)?;
    let matrix = run("RK4, nine entries of R", OnMatrix::new(stepper.scene(), h, &attitude, momentum), schedule)?;
    Ok([
        Series::new("variational", "variational.csv", BLUE, &body, &ours),
        Series::new("RK4, quaternion renormalised", "rk4-quaternion.csv", GREEN, &body, &quaternion),
        Series::new("RK4, nine entries of R", "rk4-matrix.csv", ORANGE, &body, &matrix),
    ])
}
