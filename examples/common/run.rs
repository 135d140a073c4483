//! A run of a method: its samples, and what a step costs.
//!
//! Recording and timing don't mix: each block of steps is first made without any output, and that is timed; then the
//! same block is made again from its start, with samples kept. A method is a pure function of its state, so both end
//! in the same place; a debug build checks that.

use std::fmt;
use std::time::Instant;

use liestep::StepError;
use nalgebra::{Matrix3, Vector3};

use crate::args::{Schedule, Stretch};
use crate::progress::Progress;
use crate::table::short;
use crate::tenths::float;

/// Attitude (body to space) and angular momentum (body frame, kg m²/s).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    pub attitude: Matrix3<f64>,
    pub momentum: Vector3<f64>,
}

/// Something that steps.
pub trait Method: Clone {
    /// Makes this number of steps, and returns the number of Newton iterations; none for an explicit method.
    fn advance(&mut self, steps: u64) -> Result<u64, Stopped>;

    /// The state as every method can give it.
    fn sample(&self) -> Sample;
}

/// A run that ended early.
#[derive(Debug)]
pub struct Stopped {
    /// The last time that was reached, s.
    pub time: f64,
    /// Why it wasn't passed.
    pub cause: StepError,
}

impl fmt::Display for Stopped {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the variational step failed at t = {} s: {}", short(self.time), self.cause)
    }
}

impl std::error::Error for Stopped {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        Some(&self.cause)
    }
}

/// What a run has left.
pub struct Record {
    /// Times in s, and the state at each.
    pub samples: Vec<(f64, Sample)>,
    /// Newton iterations a step.
    pub iterations: f64,
    /// The time of a step, ns: the median over the blocks, which other programs on the machine disturb least.
    pub nanoseconds: f64,
}

/// Long enough that reading the clock costs nothing beside it.
const BLOCK: u64 = 1000;

/// Runs a method to the end of the schedule.
pub fn run<M: Method>(name: &str, mut method: M, schedule: &Schedule) -> Result<Record, Stopped> {
    let mut progress = Progress::new(schedule.steps);
    let mut samples = vec![(0.0, method.sample())];
    let (mut done, mut iterations, mut costs) = (0, 0, Vec::new());
    for Stretch { end: stretch, stride } in schedule.stretches() {
        while done < stretch {
            let before = done;
            let end = stretch.min(done + BLOCK.next_multiple_of(stride));
            let mut timed = method.clone();
            let start = Instant::now();
            iterations += timed.advance(end - done)?;
            costs.push(start.elapsed().as_secs_f64() * 1e9 / float(end - done));
            while done < end {
                let steps = stride.min(end - done);
                method.advance(steps)?;
                done += steps;
                samples.push((schedule.time_after(done), method.sample()));
            }
            debug_assert!(same(&method.sample(), &timed.sample()), "the same steps ended in different states");
            progress.add(end - before, name);
        }
    }
    costs.sort_by(f64::total_cmp);
    let nanoseconds = costs[costs.len() / 2];
    Ok(Record { samples, iterations: float(iterations) / float(schedule.steps), nanoseconds })
}

/// Bit for bit, where it is finite: an explicit method may have blown up, and NaN isn't equal to itself.
fn same(a: &Sample, b: &Sample) -> bool {
    a == b || !(a.momentum + a.attitude.column(0)).iter().all(|x| x.is_finite())
}
