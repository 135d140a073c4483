//! The trials of one method with ever shorter steps, and what they say of the steps that an error takes.

use alloc::vec::Vec;

use super::candidates::Candidate;
use super::error::AccuracyError;
use super::trials::{End, Start, Trial, Tried};
use crate::groups::{Advected, LieGroup};

// Roots and powers without a standard library.
#[cfg(not(feature = "std"))]
use nalgebra::ComplexField as _;

/// Errors that are larger fall by no law of powers.
pub(super) const LARGEST_ERROR: f64 = 0.05;
/// Errors may fall by so much more than the order promised, where a potential is small or a low order's share of the
/// error is; and by no more than differences of doubles show.
const BEYOND_THE_ORDER: f64 = 4.0;
const HIGHEST_ORDER: f64 = 12.0;
/// Differences as small are rounding's.
pub(super) const SMALLEST_ERROR: f64 = f64::EPSILON;
/// Errors that stagnate fall with less than this power of the step.
const STAGNANT: f64 = 0.5;

/// An error at the horizon.
#[derive(Clone, Copy, Debug)]
struct Point {
    steps: f64,
    error: f64,
}

/// Steps that an error takes, and the operations of one of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Estimate {
    pub(super) steps: f64,
    pub(super) a_step: f64,
    pub(super) once: f64,
    /// Whether this is but a bound: the true numbers are larger.
    pub(super) is_bound: bool,
    /// Whether a trial has come as far, or nearly.
    pub(super) is_near: bool,
    /// Whether all trials have been nearer, so that much longer steps may do.
    pub(super) is_short: bool,
}

/// Of an error, one that is so much smaller that nothing is known of the steps that would do.
const MUCH_NEARER: f64 = 0.1;

impl Estimate {
    /// Of a method that isn't looked at.
    pub(super) const NEVER: Self = Self {
        steps: f64::INFINITY,
        a_step: f64::INFINITY,
        once: 0.0,
        is_bound: true,
        is_near: false,
        is_short: false,
    };

    /// Operations of a run over so many times the horizon.
    pub(super) fn cost(&self, times: f64) -> f64 {
        self.once + (self.steps * times).max(1.0) * self.a_step
    }
}

/// The trials of a method to one horizon.
pub(super) struct Ladder<'a, G: LieGroup<Scalar = f64>, A> {
    pub(super) candidate: &'a Candidate<'a, G, A>,
    /// With ever more steps.
    trials: Vec<Trial<G>>,
    /// Steps of the first.
    first: f64,
    /// Why the last trial failed.
    pub(super) failure: Option<AccuracyError>,
}

impl<'a, G: LieGroup<Scalar = f64>, A: Advected<G>> Ladder<'a, G, A> {
    pub(super) fn new(candidate: &'a Candidate<'a, G, A>) -> Self {
        Self::from(candidate, 1.0)
    }

    /// That begins with so many steps.
    pub(super) fn from(candidate: &'a Candidate<'a, G, A>, first: f64) -> Self {
        Self { candidate, trials: Vec::new(), first, failure: None }
    }

    /// All, the roughest first.
    pub(super) fn trials(&self) -> &[Trial<G>] {
        &self.trials
    }

    /// The trial with the most steps.
    pub(super) fn finest(&self) -> Option<&Trial<G>> {
        self.trials.last()
    }

    /// A trial with more steps than the last.
    pub(super) fn extend(&mut self, horizon: f64, steps: f64, tried: &mut Tried<'a, G, A>) {
        let (trial, failure) = tried.run(self.candidate, horizon, steps);
        self.trials.push(trial);
        self.failure = failure;
    }

    /// Twice the steps of the last trial.
    pub(super) fn twice_the_steps(&self) -> f64 {
        self.finest().map_or(self.first, |finest| 2.0 * finest.steps)
    }

    /// What the next trial is thought to cost.
    pub(super) fn cost_of(&self, steps: f64) -> f64 {
        let least = self.candidate.a_step();
        let solved = self.finest().filter(|finest| finest.end.is_some());
        let a_step = solved.map_or(self.candidate.a_long_step(), |finest| 0.5 * (finest.a_step + least));
        self.candidate.once() + steps * a_step
    }

    /// The errors against a reference, from where they are small enough to say something; without one against the
    /// finest of its own.
    fn points(&self, start: &Start<G>, reference: Option<&End<G>>) -> Vec<Point> {
        let own = self.finest().and_then(|finest| finest.end);
        let (Some(exact), measured) = (match reference {
            Some(_) => (reference.copied(), &self.trials[..]),
            None => (own, &self.trials[..self.trials.len().saturating_sub(1)]),
        }) else {
            return Vec::new();
        };
        let mut points: Vec<Point> = Vec::new();
        for Trial { steps, end, .. } in measured {
            match end.map(|end| start.difference(&end, &exact)) {
                Some(error) if error < LARGEST_ERROR => {
                    points.push(Point { steps: *steps, error: error.max(SMALLEST_ERROR) });
                }
                _ => points.clear(),
            }
        }
        points
    }

    fn promised(&self) -> f64 {
        f64::from(self.candidate.order)
    }

    /// The order that the last points show, if there are two.
    fn shown(&self, points: &[Point]) -> Option<f64> {
        let [.., before, last] = points else { return None };
        Some(shown(before, last).clamp(1.0, self.most()))
    }

    /// The highest order that may show.
    fn most(&self) -> f64 {
        let promised = self.promised();
        (promised + BEYOND_THE_ORDER).min(HIGHEST_ORDER).max(promised)
    }

    /// What an error takes, by errors against a reference or against the finest trial.
    pub(super) fn estimate(&self, start: &Start<G>, reference: Option<&End<G>>, error: f64) -> Estimate {
        let points = self.points(start, reference);
        let (once, least) = (self.candidate.once(), self.candidate.a_step());
        let a_step = self.finest().map_or(least, |trial| trial.a_step);
        let Some(last) = points.last() else {
            // At least the next trial; far more, if the last has had a larger error than any that says something.
            // Before the first nothing is known.
            let (next, falls) = (self.twice_the_steps(), (LARGEST_ERROR / error).max(1.0).powf(self.most().recip()));
            let steps = if self.trials.is_empty() { 0.0 } else { next.max(0.5 * next * falls) };
            return Estimate { steps, a_step: least, once, is_bound: true, is_near: false, is_short: false };
        };
        let at = |steps: f64, is_near| Estimate { steps, a_step, once, is_bound: false, is_near, is_short: false };
        let Some(place) = points.iter().position(|point| point.error <= error) else {
            let order = self.shown(&points).unwrap_or(self.promised());
            let steps = last.steps * (last.error / error).powf(order.recip());
            // Shorter steps take fewer iterations than the trial's, between those and the fewest.
            let a_step = if steps > 2.0 * last.steps { (a_step * least).sqrt() } else { a_step };
            let is_near = points.len() >= 2 && steps <= 2.0 * last.steps;
            return Estimate { a_step, ..at(steps, is_near) };
        };
        let fine = &points[place];
        let Some(coarse) = place.checked_sub(1).map(|before| &points[before]) else {
            // Longer steps than were tried: by the order that lengthens them least.
            let is_short = fine.error < MUCH_NEARER * error;
            return Estimate { is_short, ..at(fine.steps * (fine.error / error).powf(self.most().recip()), true) };
        };
        let part = (coarse.error / error).ln() / (coarse.error / fine.error).ln();
        at(coarse.steps * (fine.steps / coarse.steps).powf(part), true)
    }

    /// The error of a run with so many steps, by those that were made.
    pub(super) fn error_at(&self, start: &Start<G>, reference: &End<G>, steps: f64) -> Option<f64> {
        let points = self.points(start, Some(reference));
        let near = points.iter().min_by(|a, b| {
            let [a, b] = [a, b].map(|point| (point.steps / steps).ln().abs());
            a.total_cmp(&b)
        })?;
        let order = self.shown(&points).unwrap_or(self.promised());
        Some(near.error * (near.steps / steps).powf(order))
    }

    /// The error that the finest trial is left with, by those before it; by the order promised where these show none.
    pub(super) fn error_of_finest(&self, start: &Start<G>) -> Option<f64> {
        self.error_left(start, self.promised())
    }

    /// The same, by order 1 where none is shown: long steps may not have the one promised.
    pub(super) fn error_shown_of_finest(&self, start: &Start<G>) -> Option<f64> {
        self.error_left(start, 1.0)
    }

    fn error_left(&self, start: &Start<G>, order_unseen: f64) -> Option<f64> {
        let (points, finest) = (self.points(start, None), self.finest()?);
        let last = points.last()?;
        let order = self.shown(&points).map_or(order_unseen, |shown| shown.min(self.promised()));
        let ratio = (last.steps / finest.steps).powf(order);
        // What is measured is the difference of two errors.
        Some(last.error * ratio / (1.0 - ratio))
    }

    /// The steps of the finest trial as a multiple of those of the one before.
    pub(super) fn last_ratio(&self) -> f64 {
        match self.trials.as_slice() {
            [.., before, finest] => finest.steps / before.steps,
            _ => 1.0,
        }
    }

    /// The last error that was measured against the finest trial.
    pub(super) fn last_error(&self, start: &Start<G>) -> Option<f64> {
        self.points(start, None).last().map(|last| last.error)
    }

    /// How many more steps, by a factor, lessen the error by this one.
    pub(super) fn factor(&self, start: &Start<G>, less: f64) -> f64 {
        less.powf(self.order(start).recip())
    }

    /// The order that can be relied on.
    pub(super) fn order(&self, start: &Start<G>) -> f64 {
        let shown = self.shown(&self.points(start, None));
        shown.map_or(self.promised(), |shown| shown.min(self.promised()))
    }

    /// Whether errors fall about as the order says.
    pub(super) fn falls(&self, start: &Start<G>) -> bool {
        self.order(start) > 0.5 * self.promised()
    }

    /// The least error, if errors have stopped falling.
    pub(super) fn floor(&self, start: &Start<G>) -> Option<f64> {
        let points = self.points(start, None);
        let [.., a, b, c] = points.as_slice() else { return None };
        let least = points.iter().map(|point| point.error).fold(f64::INFINITY, f64::min);
        (shown(a, b) < STAGNANT && shown(b, c) < STAGNANT).then_some(least)
    }
}

/// The power of the step by which an error has fallen.
fn shown(coarse: &Point, fine: &Point) -> f64 {
    (coarse.error / fine.error).ln() / (fine.steps / coarse.steps).ln()
}
