//! Runs of one method with ever shorter steps, from which the number of steps for an error is estimated.

use alloc::rc::Rc;
use alloc::vec::Vec;

use super::error::AccuracyError;
use super::methods::Candidate;
use super::question::{EndNumbers, Start, Trials};
use crate::motion::{Cost, Integrator as _};

roots!();

/// Limit of errors that fall by a power of the step.
pub(super) const LARGEST_ERROR: f64 = 0.05;
/// Excess of the power of an error's fall over the order, at most. It occurs if the potential is small.
const BEYOND_THE_ORDER: f64 = 4.0;

/// The assumed cost of a method that doesn't state one.
pub(super) const UNKNOWN: Cost = Cost { step: 1e3, iteration: 0.0, fewest: 0, once: 0.0 };

/// A run to the horizon with `steps` steps.
#[derive(Clone, Debug)]
pub(super) struct Run {
    pub(super) steps: f64,
    /// Operations of a step.
    a_step: f64,
    /// Operations of the run.
    pub(super) cost: f64,
    /// The state at the end of the run, or none if the step is invalid, or one had no solution.
    pub(super) end: Option<Rc<EndNumbers>>,
}

/// The end of a fine run, and its estimated error.
pub(super) type Reference = (Rc<EndNumbers>, f64);

/// An error at the horizon.
#[derive(Clone, Copy, Debug)]
struct Point {
    steps: f64,
    a_step: f64,
    error: f64,
}

/// The runs of a method to one horizon.
pub(super) struct Ladder<'a> {
    pub(super) method: &'a Candidate,
    start: Start,
    cost: Cost,
    /// The runs, sorted by their numbers of steps.
    pub(super) runs: Vec<Run>,
    /// The error of the last run, if it failed.
    pub(super) failure: Option<AccuracyError>,
}

impl<'a> Ladder<'a> {
    pub(super) fn new(method: &'a Candidate, cost: Cost, start: Start) -> Self {
        Self { method, start, cost, runs: Vec::new(), failure: None }
    }

    /// Lower bound of the operations of a run with `steps` steps.
    pub(super) fn least(&self, steps: f64) -> f64 {
        self.cost.once + steps * self.cost.least()
    }

    pub(super) fn order(&self) -> f64 {
        f64::from(self.method.scheme.order())
    }

    pub(super) fn finest(&self) -> Option<&Run> {
        self.runs.last()
    }

    pub(super) fn has(&self, steps: f64) -> bool {
        self.runs.iter().any(|run| run.steps.to_bits() == steps.to_bits())
    }

    /// Whether any run has reached the horizon.
    pub(super) fn has_end(&self) -> bool {
        self.runs.iter().any(|run| run.end.is_some())
    }

    /// Makes and stores a run of `steps` steps from the start.
    pub(super) fn run(&mut self, steps: f64, trials: &mut Trials) -> Run {
        let (run, failure) = self.made(&self.start, steps, trials);
        self.runs.insert(self.runs.partition_point(|other| other.steps < steps), run.clone());
        self.failure = failure;
        run
    }

    /// Distance of a run's end from that of a run whose start differs by some roundings.
    pub(super) fn rounding(&self, run: &Run, trials: &mut Trials) -> f64 {
        let nearby = self.made(&self.start.nearby(), run.steps, trials).0;
        nearby.end.as_ref().zip(run.end.as_ref()).map_or(f64::INFINITY, |(nearby, end)| self.start.apart(nearby, end))
    }

    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a whole number, far below the largest
    fn made(&self, start: &Start, steps: f64, trials: &mut Trials) -> (Run, Option<AccuracyError>) {
        let run = || -> Result<_, AccuracyError> {
            let stepper = (self.method.make)(start.horizon / steps)?;
            let mut state = stepper.start(&start.attitude, &start.velocity)?;
            let iterations = stepper.attempt(&mut state, steps as u64).map_err(AccuracyError::Step)?;
            let cost = stepper.cost().unwrap_or(UNKNOWN).of_run(steps as u64, iterations);
            let end = EndNumbers { attitude: state.attitude().into(), velocity: stepper.velocity(&state) };
            let a_step = (cost - self.cost.once) / steps;
            Ok(Run { steps, a_step, cost, end: Some(end).filter(EndNumbers::is_finite).map(Rc::new) })
        };
        let failed =
            |failure| (Run { steps, a_step: self.cost.least(), cost: self.least(steps), end: None }, Some(failure));
        let (run, failure) = run().map_or_else(failed, |run| (run, None));
        trials.runs += 1;
        trials.most_steps = trials.most_steps.max(steps);
        trials.operations += run.cost;
        (run, failure)
    }

    /// The error of a run against a reference, or that of the reference if it is larger.
    pub(super) fn error(&self, run: &Run, (exact, left): &Reference) -> Option<f64> {
        run.end.as_ref().map(|end| self.start.apart(end, exact).max(*left).max(f64::EPSILON))
    }

    /// The errors against a reference, from the first that is small enough for a power law on; without a reference, the
    /// differences to the finest run.
    fn points(&self, reference: Option<&Reference>) -> Vec<Point> {
        let own = self.finest().and_then(|finest| Some((finest.end.clone()?, 0.0)));
        let (Some(exact), measured) = (match reference {
            Some(_) => (reference, &self.runs[..]),
            None => (own.as_ref(), &self.runs[..self.runs.len().saturating_sub(1)]),
        }) else {
            return Vec::new();
        };
        let mut points = Vec::new();
        for run in measured {
            match self.error(run, exact) {
                Some(error) if error < LARGEST_ERROR => {
                    points.push(Point { steps: run.steps, a_step: run.a_step, error });
                }
                _ => points.clear(),
            }
        }
        points
    }

    /// The order estimated from the last two errors, if there are two.
    fn shown(points: &[Point], most: f64) -> Option<f64> {
        let [.., before, last] = points else { return None };
        Some(power(before, last).clamp(1.0, most))
    }

    /// Number of steps for an error, and the operations of one, if any run has a small enough error.
    pub(super) fn takes(&self, reference: &Reference, error: f64) -> Option<(f64, f64)> {
        let (points, most) = (self.points(Some(reference)), self.order() + BEYOND_THE_ORDER);
        let last = points.last()?;
        let by_power = |point: &Point, order: f64| point.steps * (point.error / error).powf(order.recip());
        Some(match points.iter().position(|point| point.error <= error) {
            None => (by_power(last, Self::shown(&points, most).unwrap_or(most)), last.a_step),
            Some(0) => {
                let (first, too_long) = (&points[0], self.runs.partition_point(|run| run.steps < points[0].steps));
                // An error no larger than the reference's may be far smaller in truth, and follow no power.
                let steps = by_power(first, if first.error > reference.1 { self.order() } else { 1.0 });
                let between = too_long.checked_sub(1).map_or(0.0, |run| (self.runs[run].steps * first.steps).sqrt());
                (steps.max(between), first.a_step)
            }
            Some(place) => (by_power(&points[place - 1], power(&points[place - 1], &points[place])), last.a_step),
        })
    }

    /// A whole number of steps, each with so many operations, and the cost of the run.
    pub(super) fn of_run(&self, (steps, a_step): (f64, f64)) -> (f64, f64) {
        let steps = steps.ceil().max(1.0);
        (steps, self.cost.once + steps * a_step)
    }

    /// The error of a run with `steps` steps, extrapolated from the nearest run.
    pub(super) fn error_at(&self, reference: &Reference, steps: f64) -> Option<f64> {
        let points = self.points(Some(reference));
        let away = |point: &Point| (point.steps / steps).ln().abs();
        let near = points.iter().min_by(|a, b| away(a).total_cmp(&away(b)))?;
        let order = Self::shown(&points, self.order() + BEYOND_THE_ORDER).unwrap_or(self.order());
        Some(near.error * (near.steps / steps).powf(order))
    }

    /// Lower bound of the steps for an error, if no run has a small enough error yet, and the steps of the next trial.
    pub(super) fn bound(&self, error: f64) -> (f64, f64) {
        let finest = self.finest().map_or(0.0, |finest| finest.steps);
        let falls = (LARGEST_ERROR / error).max(1.0).powf((self.order() + BEYOND_THE_ORDER).recip());
        (finest * falls.max(1.2), (finest * falls.clamp(1.2, 2.0)).ceil())
    }

    /// The error of the finest run by Richardson's extrapolation, and the order of its fall: the estimated one, limited
    /// by the method's order, or `unseen` without an estimate.
    pub(super) fn left(&self, unseen: f64) -> Option<(f64, f64)> {
        let (points, finest) = (self.points(None), self.finest()?);
        let last = points.last()?;
        let order = Self::shown(&points, self.order()).unwrap_or(unseen);
        let ratio = (last.steps / finest.steps).powf(order);
        // The measured difference is that of the errors of two runs.
        Some((last.error * ratio / (1.0 - ratio), order))
    }

    /// Whether the runs agree within this error, whatever the order of their errors.
    pub(super) fn is_within(&self, error: f64) -> bool {
        self.left(1.0).is_some_and(|(left, _)| left <= error)
    }

    /// The least difference to the finest run, if differences have stopped falling.
    pub(super) fn floor(&self) -> Option<f64> {
        let points = self.points(None);
        let [.., a, b, c] = points.as_slice() else { return None };
        let least = points.iter().map(|point| point.error).fold(f64::INFINITY, f64::min);
        (power(a, b) < 0.5 && power(b, c) < 0.5).then_some(least)
    }
}

/// The power of the step by which an error has fallen.
fn power(coarse: &Point, fine: &Point) -> f64 {
    (coarse.error / fine.error).ln() / (fine.steps / coarse.steps).ln()
}
