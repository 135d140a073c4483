//! The trial runs of one method, each with twice the steps of the one before, and what they say about its error.

use super::error::AccuracyError;
use super::{Accuracy, Candidate};
use crate::groups::{Advected, LieGroup};
use crate::numbers::{Coordinates as _, Entries};

/// Attitude and velocity.
#[derive(Clone, Copy, Debug)]
pub(super) struct End<G: LieGroup> {
    attitude: G,
    velocity: G::Vector,
}

/// Where all trials start, and how far they go.
pub(super) struct Start<G: LieGroup> {
    pub(super) attitude: G,
    pub(super) velocity: G::Vector,
    pub(super) horizon: f64,
}

/// How far apart two starts are that rounding doesn't tell apart in a run: about what the roundings of its first
/// hundred stages add up to.
const ROUNDINGS: f64 = 16.0 * f64::EPSILON;
/// Rounding may grow to this part of the tolerance.
const OF_ROUNDING: f64 = 0.25;

impl<G: LieGroup<Scalar = f64>> Start<G> {
    /// A start some roundings away, in all directions.
    fn nearby(&self) -> Self {
        let axes = (0..G::DIMENSION).map(G::Vector::axis);
        let aside = axes.fold(G::Vector::zero(), |sum, axis| sum * -0.8 + axis) * ROUNDINGS;
        let attitude = self.attitude.compose(&G::from_increment(&G::hat(&aside)));
        let velocity = self.velocity + aside * Accuracy::scale(size(&self.velocity), 0.0, self.horizon);
        Self { attitude, velocity, horizon: self.horizon }
    }
}

/// One run to the horizon.
#[derive(Clone, Copy)]
struct Trial<G: LieGroup> {
    steps: f64,
    /// Operations.
    cost: f64,
    /// None where there is no such step, or one had no solution.
    end: Option<End<G>>,
}

/// An error at the horizon, measured by a run with twice the steps.
#[derive(Clone, Copy, Debug)]
struct Point {
    steps: f64,
    cost: f64,
    error: f64,
}

/// Steps and operations that an error takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Estimate {
    pub(super) steps: f64,
    pub(super) cost: f64,
    /// Whether this is but a bound: the true numbers are larger.
    pub(super) is_bound: bool,
}

/// Errors that are larger fall by no law of powers.
pub(super) const LARGEST_ERROR: f64 = 0.05;
/// Errors may fall by so much more than the order promised, where a potential is small or a low order's share of the
/// error is; and by no more than differences of doubles show.
const BEYOND_THE_ORDER: f64 = 4.0;
const HIGHEST_ORDER: f64 = 12.0;
/// Below this a difference is zero.
const SMALLEST_ERROR: f64 = 1e-17;
/// Of the tolerance, the error that is aimed at; errors aren't quite powers of the step.
pub(super) const AIM: f64 = 0.5;

/// The trials of a method.
pub(super) struct Ladder<'a, G: LieGroup<Scalar = f64>, A: Advected<G>> {
    pub(super) candidate: &'a Candidate<G, A>,
    trials: Vec<Trial<G>>,
    /// How far each trial ended from the next.
    differences: Vec<Option<f64>>,
    pub(super) failure: Option<AccuracyError>,
    /// Operations of all its trials.
    pub(super) spent: f64,
}

impl<'a, G: LieGroup<Scalar = f64>, A: Advected<G>> Ladder<'a, G, A> {
    pub(super) fn new(candidate: &'a Candidate<G, A>) -> Self {
        Self { candidate, trials: Vec::new(), differences: Vec::new(), failure: None, spent: 0.0 }
    }

    /// The next trial has so many steps.
    pub(super) fn next_steps(&self) -> f64 {
        self.trials.last().map_or(1.0, |trial| 2.0 * trial.steps)
    }

    /// Makes the next trial.
    pub(super) fn extend(&mut self, start: &Start<G>) {
        let steps = self.next_steps();
        let trial = self.run(start, steps);
        if let Some(coarse) = self.trials.last() {
            self.differences.push(coarse.end.zip(trial.end).map(|(coarse, fine)| difference(&coarse, &fine, start)));
        }
        self.trials.push(trial);
    }

    /// The least tolerance that rounding leaves, by how far the finest trial ends from one that starts some roundings
    /// away.
    pub(super) fn least_tolerance(&mut self, start: &Start<G>) -> f64 {
        let Some(Trial { steps, end: Some(there), .. }) = self.trials.last().copied() else { return f64::INFINITY };
        let nearby = self.run(&start.nearby(), steps).end;
        nearby.map_or(f64::INFINITY, |nearby| difference(&nearby, &there, start) / OF_ROUNDING)
    }

    /// The error of a run with so many steps against the finest trial, and its cost.
    pub(super) fn verify(&mut self, start: &Start<G>, steps: f64) -> Option<(f64, f64)> {
        let exact = self.trials.last()?.end?;
        let trial = self.run(start, steps);
        Some((difference(&trial.end?, &exact, start), trial.cost))
    }

    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a whole number, far below the largest
    fn run(&mut self, start: &Start<G>, steps: f64) -> Trial<G> {
        let run = || -> Result<_, AccuracyError> {
            let stepper = (self.candidate.make)(start.horizon / steps)?;
            let mut state = stepper.start(start.attitude, start.velocity)?;
            let iterations = stepper.run_unexplained(&mut state, steps as u64).map_err(AccuracyError::Step)?;
            let cost = stepper.cost().of_run(steps as u64, iterations);
            Ok((cost, End { attitude: state.attitude(), velocity: stepper.velocity(&state) }))
        };
        let least = steps * self.candidate.least;
        let (cost, end) = match run() {
            Ok((cost, end)) => {
                // Shorter steps had a solution.
                self.failure = None;
                (cost, Some(end).filter(is_finite))
            }
            Err(error) => {
                self.failure = Some(error);
                (least, None)
            }
        };
        self.spent += cost;
        Trial { steps, cost, end }
    }

    /// The errors of the trials but for the last, from where they are small enough to say something.
    fn points(&self) -> Vec<Point> {
        let mut points: Vec<Point> = Vec::new();
        for (&Trial { steps, cost, .. }, difference) in self.trials.iter().zip(&self.differences) {
            match difference {
                Some(error) if *error < LARGEST_ERROR => {
                    points.push(Point { steps, cost, error: error.max(SMALLEST_ERROR) });
                }
                _ => points.clear(),
            }
        }
        points
    }

    /// The order that the last trials show, and the one that was promised: which of them is lower, and which is higher.
    fn orders(&self, points: &[Point]) -> (f64, f64) {
        let promised = f64::from(self.candidate.order);
        let [.., before, last] = points else { return (promised, self.most()) };
        let shown = (before.error / last.error).log2();
        (shown.min(promised).max(1.0), shown.max(promised).min(self.most()))
    }

    /// The highest order that may show.
    fn most(&self) -> f64 {
        let promised = f64::from(self.candidate.order);
        (promised + BEYOND_THE_ORDER).min(HIGHEST_ORDER).max(promised)
    }

    /// What an error takes, rather too little than too much where trials haven't come so far.
    pub(super) fn estimate(&self, error: f64) -> Estimate {
        let points = self.points();
        let Some(last) = points.last() else {
            // At least the next trial; far more, if the last but one has had a larger error than any that says
            // something.
            let (next, falls) = (self.next_steps(), (LARGEST_ERROR / error).max(1.0).powf(self.most().recip()));
            let steps = if self.last_difference().is_some() { next.max(0.25 * next * falls) } else { next };
            return Estimate { steps, cost: steps * self.candidate.least, is_bound: true };
        };
        let at = |steps: f64, near: &Point| Estimate { steps, cost: near.cost / near.steps * steps, is_bound: false };
        let Some(place) = points.iter().position(|point| point.error <= error) else {
            let (_, order) = self.orders(&points);
            let steps = last.steps * (last.error / error).powf(order.recip());
            // Shorter steps take fewer iterations than the trial's, between those and the fewest.
            let a_step = (last.cost / last.steps * self.candidate.least).sqrt();
            return Estimate { steps, cost: steps * a_step, is_bound: false };
        };
        let fine = &points[place];
        let Some(coarse) = place.checked_sub(1).map(|before| &points[before]) else { return at(fine.steps, fine) };
        let part = (coarse.error / error).ln() / (coarse.error / fine.error).ln();
        at(coarse.steps * (fine.steps / coarse.steps).powf(part), fine)
    }

    /// Whether the finest trial is near enough to the motion to measure the errors of others by it.
    pub(super) fn is_reference(&self, tolerance: f64) -> bool {
        let points = self.points();
        let [.., last] = points.as_slice() else { return false };
        let (order, _) = self.orders(&points);
        points.len() >= 2 && last.error / (order.exp2() - 1.0) <= 0.25 * tolerance
    }

    /// The order that can be relied on.
    pub(super) fn order(&self) -> f64 {
        self.orders(&self.points()).0
    }

    /// How far the last two trials ended from each other.
    pub(super) fn last_difference(&self) -> Option<f64> {
        self.differences.last().copied().flatten()
    }

    /// The least difference of two trials, if it has stopped falling, with the cost of getting there.
    pub(super) fn floor(&self) -> Option<(f64, f64)> {
        let points = self.points();
        let [.., a, b, c] = points.as_slice() else { return None };
        let stagnates = |before: &Point, after: &Point| after.error > 0.5 * before.error;
        let least = points.iter().min_by(|p, q| p.error.total_cmp(&q.error))?;
        (stagnates(a, b) && stagnates(b, c)).then_some((least.error, least.cost))
    }
}

fn is_finite<G: LieGroup<Scalar = f64>>(end: &End<G>) -> bool {
    (size(&end.attitude.matrix()) + size(&end.velocity)).is_finite()
}

fn size<E: Entries<f64>>(entries: &E) -> f64 {
    let mut squares = 0.0;
    entries.each(&mut |entry| squares += entry * entry);
    squares.sqrt()
}

/// The error that [`Accuracy`] defines.
fn difference<G: LieGroup<Scalar = f64>>(end: &End<G>, exact: &End<G>, start: &Start<G>) -> f64 {
    let apart = |a: &G::Vector, b: &G::Vector| size(&a.zip(b, &mut |a, b| a - b));
    let attitudes = end.attitude.matrix().zip(&exact.attitude.matrix(), &mut |a, b| a - b);
    let scale = Accuracy::scale(size(&start.velocity), size(&exact.velocity), start.horizon);
    (size(&attitudes) / size(&exact.attitude.matrix())).hypot(apart(&end.velocity, &exact.velocity) / scale)
}
