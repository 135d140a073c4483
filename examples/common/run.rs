//! A run of a method: its samples, and what a step costs.
//!
//! Recording and timing don't mix: each block of steps is first made without any output, and that is timed; then the
//! same block is made again from its start, with samples kept. A method is a pure function of its state, so both end
//! in the same place; a debug build checks that.

use std::fmt;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use liestep::StepError;
use nalgebra::{Matrix3, Vector3};

use super::args::Schedule;

/// Attitude (body to space) and angular momentum (body frame, kg m²/s).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sample {
    pub(crate) attitude: Matrix3<f64>,
    pub(crate) momentum: Vector3<f64>,
}

/// Something that steps.
pub(crate) trait Method: Clone {
    /// Makes so many steps, and returns how many Newton iterations that took; none for an explicit method.
    fn advance(&mut self, steps: u64) -> Result<u64, Stopped>;

    /// The state as every method can give it.
    fn sample(&self) -> Sample;
}

/// A run that ended early.
#[derive(Debug)]
pub(crate) struct Stopped {
    /// The last time that was reached, s.
    pub(crate) time: f64,
    /// Why it wasn't passed.
    pub(crate) cause: StepError,
}

impl fmt::Display for Stopped {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the variational step failed at t = {} s: {}", self.time, self.cause)
    }
}

impl std::error::Error for Stopped {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        Some(&self.cause)
    }
}

/// What a run has left.
pub(crate) struct Record {
    /// Times in s, and the state at each.
    pub(crate) samples: Vec<(f64, Sample)>,
    /// Newton iterations a step.
    pub(crate) iterations: f64,
    /// The time of a step, ns.
    pub(crate) nanoseconds: f64,
}

/// Long enough that reading the clock costs nothing beside it.
const BLOCK: u64 = 1000;

/// Steps that take long enough for somebody to wonder.
const LONG: u64 = 2_000_000;

/// Runs a method to the end of the schedule.
pub(crate) fn run<M: Method>(name: &str, mut method: M, schedule: &Schedule) -> Result<Record, Stopped> {
    let bar = progress(name, schedule.steps);
    let block = schedule.stride * BLOCK.div_ceil(schedule.stride);
    let mut samples = vec![(0.0, method.sample())];
    let (mut done, mut iterations, mut elapsed) = (0, 0, Duration::ZERO);
    while done < schedule.steps {
        let end = schedule.steps.min(done + block);
        let mut timed = method.clone();
        let start = Instant::now();
        iterations += timed.advance(end - done)?;
        elapsed += start.elapsed();
        while done < end {
            let stride = schedule.stride.min(end - done);
            method.advance(stride)?;
            done += stride;
            samples.push((schedule.time_after(done), method.sample()));
        }
        debug_assert!(same(&method.sample(), &timed.sample()), "the same steps ended in different states");
        bar.set_position(done);
    }
    bar.finish_and_clear();
    #[allow(clippy::cast_precision_loss)] // both are far below 2⁵³
    let (steps, iterations) = (schedule.steps as f64, iterations as f64);
    Ok(Record { samples, iterations: iterations / steps, nanoseconds: elapsed.as_secs_f64() * 1e9 / steps })
}

/// Bit for bit, where it is finite: an explicit method may have blown up, and NaN isn't equal to itself.
fn same(a: &Sample, b: &Sample) -> bool {
    a == b || !(a.momentum + a.attitude.column(0)).iter().all(|x| x.is_finite())
}

fn progress(name: &str, steps: u64) -> ProgressBar {
    if steps < LONG {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(steps).with_message(name.to_owned());
    let template = "{msg:<28} {bar:40} {percent:>3} %  {eta} left";
    match ProgressStyle::with_template(template) {
        Ok(style) => bar.with_style(style),
        Err(_) => bar,
    }
}
