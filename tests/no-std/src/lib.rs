//! A program for a target without a standard library: `cargo check` fails if a dependency brings that along.
//!
//! Two panic handlers are a compiler error, and the standard library has one.

#![no_std]

use core::panic::PanicInfo;

use liestep::nalgebra::{UnitQuaternion, Vector3};
use liestep::recording::{Frames, RecordError, Recorder, Table};
use liestep::{NonstandardInertia, SO3, SetupError, StepError, Stepper, force, lagrangian};

#[panic_handler]
fn panicked(_: &PanicInfo<'_>) -> ! {
    loop {
        core::hint::spin_loop();
    }
}

/// A declaration, whose expansion must not use the standard library, either.
#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)
        - 0.5 * h * m * g * w.dot(&(rho + F * rho)),
)]
#[derive(Clone, Copy, Debug)]
pub struct HeavyTop {
    J_d: NonstandardInertia,
    m: f64,
    g: f64,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

/// A force with a prescribed torque, without the standard library.
#[force(group = SO3, given(u = torque), work = 0.5 * h * u * (eta + eta_next)[2])]
#[derive(Clone, Copy, Debug)]
pub struct Wheel {
    torque: f64,
}

/// A frame of a display.
///
/// # Errors
///
/// A step that the top doesn't have, or a next step without a solution.
pub fn frame(top: HeavyTop, elapsed: f64) -> Result<Result<f64, StepError>, SetupError> {
    let stepper = Stepper::new(top + Wheel { torque: 0.1 }, 0.01)?;
    let state = stepper.start(UnitQuaternion::identity(), Vector3::new(0.0, 0.1, 20.0))?;
    let mut frames = Frames::new(stepper, state);
    Ok(frames.advance(elapsed).map(|now| now.attitude().as_matrix().m33))
}

/// A run, recorded as a table.
///
/// # Errors
///
/// A row that can't be written.
pub fn recorded(top: HeavyTop) -> Result<Table, RecordError> {
    let failed = |_| RecordError::Sink { cause: "there is no such top".into() };
    let stepper = Stepper::new(top, 0.01).map_err(failed)?;
    let mut state = stepper.start(UnitQuaternion::identity(), Vector3::new(0.0, 0.1, 20.0)).map_err(failed)?;
    let mut recorder = Recorder::new(&stepper, Table::new());
    let ended = stepper.observed(&mut state).every(10, |now| recorder.record(now)).until(1.0);
    ended.map_err(|error| RecordError::Sink { cause: error.into() })?;
    recorder.finish()
}
