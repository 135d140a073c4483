//! A run of a method: its samples, and the cost of a step.
//!
//! Recording would disturb the timing. So each block of steps is run twice from the same state: first without output,
//! for the time, then with samples. A method is a pure function of its state, so both end in the same state; a debug
//! build checks this.

use std::fmt;
use std::time::Instant;

use liestep::StepError;
use nalgebra::{Matrix3, Vector3};

use crate::args::Failure;
use crate::progress::Progress;
use crate::table::short;
use crate::tenths::float;

/// A finite number of equal steps.
#[derive(Clone, Copy, Debug)]
pub struct Schedule {
    /// The step, s.
    pub step: f64,
    /// The number of steps.
    pub steps: u64,
}

/// A part of a run with equidistant samples.
#[derive(Clone, Copy, Debug)]
pub struct Stretch {
    /// The end, in steps from the start.
    pub end: u64,
    /// The number of steps between two samples.
    pub stride: u64,
}

/// The limit on steps: about an hour of computation.
const MOST_STEPS: f64 = 1e10;

/// The limit on samples of a part: more than a figure can resolve, few enough for any memory.
const MOST_SAMPLES: u64 = 20_000;

/// The duration of the first part, which is recorded in detail, s.
const BEGINNING: f64 = 20.0;

/// The duration of the last part, which is recorded in detail, s: from 100 s to 200 s in the thesis.
pub const ENDING: f64 = 100.0;

impl Schedule {
    /// The whole number of steps nearest to a time, both in s.
    pub fn new(step: f64, time: f64) -> Result<Self, Failure> {
        let steps = (time / step).round();
        if steps < 1.0 {
            let (time, step) = (short(time), short(step));
            return Err(format!("--time {time} is shorter than one --step {step}; nothing would happen").into());
        }
        if steps > MOST_STEPS {
            let most = format!("more than {MOST_STEPS:.0e}; take a larger step");
            return Err(format!("--time over --step makes {steps:.1e} steps, {most}").into());
        }
        Ok(Self { step, steps: whole(steps) })
    }

    /// The time after this number of steps, s.
    pub fn time_after(&self, steps: u64) -> f64 {
        self.step * float(steps)
    }

    /// The time at the end, s.
    pub fn end(&self) -> f64 {
        self.time_after(self.steps)
    }

    /// The beginning, the middle and the end, each with as many samples as a figure can resolve.
    pub fn stretches(&self) -> [Stretch; 3] {
        let beginning = whole(BEGINNING / self.step).min(self.steps);
        let ending = self.steps.saturating_sub(whole(ENDING / self.step)).max(beginning);
        let mut start = 0;
        [beginning, ending, self.steps].map(|end| {
            let stride = (end - start).div_ceil(MOST_SAMPLES).max(1);
            start = end;
            Stretch { end, stride }
        })
    }
}

/// The nearest whole number of steps, clamped to the limit.
fn whole(steps: f64) -> u64 {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // clamped
    let whole = steps.round().clamp(0.0, MOST_STEPS) as u64;
    whole
}

/// Attitude (body to space) and angular momentum (body frame, kg m²/s).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    pub attitude: Matrix3<f64>,
    pub momentum: Vector3<f64>,
}

/// A method of integration.
pub trait Method: Clone {
    /// Makes this number of steps, and returns the number of Newton iterations; zero for an explicit method.
    fn advance(&mut self, steps: u64) -> Result<u64, EarlyEnd>;

    /// The state as a sample, the same for all methods.
    fn sample(&self) -> Sample;
}

/// A run that ended early.
#[derive(Debug)]
pub struct EarlyEnd {
    /// The last time that was reached, s.
    pub time: f64,
    /// The error of the next step.
    pub cause: StepError,
}

impl fmt::Display for EarlyEnd {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the variational step failed at t = {} s: {}", short(self.time), self.cause)
    }
}

impl std::error::Error for EarlyEnd {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        Some(&self.cause)
    }
}

/// The result of a run.
pub struct Record {
    /// Times in s, and the state at each.
    pub samples: Vec<(f64, Sample)>,
    /// Newton iterations a step.
    pub iterations: f64,
    /// The time of a step, ns: the median over the blocks, which other programs on the machine disturb least.
    pub nanoseconds: f64,
}

/// The number of steps in a block: reading the clock is then negligible.
const BLOCK: u64 = 1000;

/// Runs a method to the end of the schedule.
pub fn run<M: Method>(name: &str, mut method: M, schedule: &Schedule) -> Result<Record, EarlyEnd> {
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

/// Equality bit for bit if finite: an explicit method may have diverged, and NaN isn't equal to itself.
fn same(a: &Sample, b: &Sample) -> bool {
    a == b || !(a.momentum + a.attitude.column(0)).iter().all(|x| x.is_finite())
}
