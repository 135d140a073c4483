//! Error against time: a method run with shorter and shorter steps.

use std::time::{Duration, Instant};

use crate::methods::{Method, Prepared};
use crate::scenes::{Scene, error};

/// One run.
#[derive(Clone, Copy, Debug)]
pub struct Run {
    /// The step, s, or the tolerance of a method that chooses its own.
    pub parameter: f64,
    pub error: f64,
    /// Of the processor, s.
    pub cost: f64,
}

/// How much is measured.
#[derive(Clone, Copy)]
pub struct Effort {
    /// A method's costlier runs are left out, s.
    pub longest: f64,
    /// Each run is repeated for about so long; the shortest counts, which other programs disturb least.
    pub repeated: Duration,
    /// Each step is shorter than the one before by this factor.
    pub ratio: f64,
}

/// Errors at which a method is drawn at all.
const LARGEST_ERROR: f64 = 0.5;

/// Below this a double has nothing left.
const SMALLEST_ERROR: f64 = 1e-14;

/// All the runs of a method that say something, in the order of their steps.
pub fn ladder(method: &Method, scene: &Scene, t: f64, effort: Effort) -> Vec<Run> {
    let Some(exact) = scene.reference(t) else { return Vec::new() };
    let mut runs: Vec<Run> = Vec::new();
    let mut worse = 0;
    for parameter in method.parameters(t, effort.ratio) {
        // A step may be too long to be solvable; the next is shorter.
        let Some(run) = (method.prepare)(scene, t, parameter).and_then(|prepared| timed(&prepared, effort.repeated))
        else {
            continue;
        };
        let run = Run { parameter, error: error(&run.0, exact), cost: run.1 };
        // The round-off floor: errors don't fall any more.
        let best = runs.iter().map(|run| run.error).fold(f64::INFINITY, f64::min);
        worse = if run.error < best { 0 } else { worse + 1 };
        if run.error < LARGEST_ERROR {
            runs.push(run);
        }
        if run.cost > effort.longest || run.error < SMALLEST_ERROR || (run.error < 1e-10 && worse > 2) {
            break;
        }
    }
    runs
}

/// Where a run ends, and how long the fastest of its repetitions took, s.
pub fn timed(prepared: &Prepared, repeated: Duration) -> Option<(declarations::motions::End, f64)> {
    let started = Instant::now();
    let mut best = Duration::MAX;
    loop {
        let start = Instant::now();
        let end = prepared()?;
        best = best.min(start.elapsed());
        if started.elapsed() > repeated {
            return Some((end, best.as_secs_f64()));
        }
    }
}

/// The least time in which the runs reach an error, s: on straight lines between the runs, both axes logarithmic.
pub fn cost_of(runs: &[Run], wanted: f64) -> Option<f64> {
    let reached = runs.iter().filter(|run| run.error <= wanted).map(|run| run.cost);
    let between = runs.windows(2).filter_map(|pair| {
        let [coarse, fine] = [pair[0], pair[1]];
        let crosses = coarse.error > wanted && fine.error <= wanted;
        let part = (coarse.error / wanted).ln() / (coarse.error / fine.error).ln();
        crosses.then(|| coarse.cost * (fine.cost / coarse.cost).powf(part))
    });
    reached.chain(between).min_by(f64::total_cmp)
}
