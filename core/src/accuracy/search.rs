//! The search for the cheapest method: all are ranked over a short part of the motion, and the first of them are run to
//! the horizon.

use alloc::vec::Vec;

use super::Accuracy;
use super::candidates::Candidate;
use super::error::{AccuracyError, TooMany, refusal};
use super::ladder::{Ladder, SMALLEST_ERROR};
use super::part::{FAR, Part};
use super::trials::{End, Start, Trial, Trials, Tried};
use crate::groups::{Advected, LieGroup};

// Roots and powers without a standard library.
#[cfg(not(feature = "std"))]
use nalgebra::ComplexField as _;

/// All trials together are to cost at most so many runs of the method chosen, to which the tests hold them.
pub(super) const MOST_RUNS: f64 = 30.0;
/// Of that, what all may have cost when the last other method has been run: the best is then run once more for
/// rounding's sake, by about as many iterations.
const MOST_RUNS_YET: f64 = MOST_RUNS - 2.0;
/// And when the last ranking ends: a third of all is left to runs of other methods.
const MOST_RUNS_RANKED: f64 = 20.0;
/// All trials together may make so many operations, some seconds of a processor.
pub(super) const MOST_OPERATIONS: f64 = 1e10;
/// Before two trials to the horizon agree they may make so many: what can't be had is refused in about a second.
pub(super) const MOST_IN_VAIN: f64 = 1e9;

/// Of the tolerance, the error that is aimed at; errors aren't quite powers of the step.
const AIM: f64 = 0.6;
/// What of the tolerance a run may differ from the reference by.
const ACCEPTED: f64 = 0.8;
/// What of the tolerance the reference may be wrong by, and what is aimed at.
const OF_THE_REFERENCE: f64 = 0.2;
const AIM_OF_THE_REFERENCE: f64 = 0.1;
/// Each trial of a method has at least and at most so many times the steps of the one before.
const LEAST_FACTOR: f64 = 1.5;
const MOST_FACTOR: f64 = 4.0;
/// Where errors fall by far less than the order says.
const FACTOR_IN_DOUBT: f64 = 2.0;
/// With so many times the steps the order that shows is of little importance;
const SURE_RATIO: f64 = 1.9;
/// with fewer an error may be so many times what was expected.
const EXPECTED: f64 = 3.0;
/// Errors so many times what the trials before have shown may be rounding's.
const UNEXPECTED: f64 = 10.0;
/// And so many times the steps.
const UNEXPECTED_STEPS: f64 = 2.0;
/// The first trials to the horizon are aimed at this error, if the tolerance isn't larger.
const COARSE: f64 = 1e-2;
/// Of the tolerance, an error so small that longer steps are tried.
const TOO_GOOD: f64 = 0.4;

/// Once a run is known, methods are told apart that seem to cost up to so many times the cheapest.
const NEAR: f64 = 1.3;
/// A method is run to the horizon if it seems to cost less than so many times the best.
const WORTH_TRYING: f64 = 1.15;
/// Runs of a method to the horizon, until its step is right.
const MOST_CORRECTIONS: u32 = 4;
/// Of the least difference of two runs, a tolerance that they show to be reached.
const ABOVE_THE_FLOOR: f64 = 8.0;
/// What of the tolerance rounding may grow to.
const OF_ROUNDING: f64 = 0.25;
/// So many methods are run to the horizon where rounding stops all.
const MOST_FLOORS: u32 = 3;

/// The method found, and how it compares.
pub(super) struct Found {
    /// Which of the candidates.
    pub(super) index: usize,
    pub(super) steps: f64,
    /// Against the reference.
    pub(super) error: f64,
    /// Operations.
    pub(super) cost: f64,
    pub(super) trials: Trials,
    /// What each candidate takes for the tolerance: steps and operations of a run, and whether these are bounds.
    pub(super) offers: Vec<(f64, f64, bool)>,
    /// What the method found takes for ten times the tolerance and for a tenth, in its own runs.
    pub(super) nearby: [f64; 2],
}

/// A run that is near enough.
#[derive(Clone, Copy)]
struct Run<G: LieGroup> {
    index: usize,
    steps: f64,
    error: f64,
    cost: f64,
    end: End<G>,
}

/// A question, and what has been tried to answer it.
struct Search<'a, G: LieGroup<Scalar = f64>, A> {
    candidates: &'a [Candidate<'a, G, A>],
    accuracy: Accuracy,
    start: &'a Start<G>,
    tried: Tried<'a, G, A>,
    refused: Refused,
}

/// What was found of methods that don't come near enough.
#[derive(Default)]
struct Refused {
    /// Steps that the first would have made.
    many: Option<TooMany>,
    /// The least tolerance that rounding leaves.
    floor: Option<f64>,
    /// Whether that is what the motion makes of roundings, whatever the method.
    is_final: bool,
    failure: Option<AccuracyError>,
}

/// The cheapest candidate for an accuracy, by operations.
pub(super) fn search<'a, G: LieGroup<Scalar = f64>, A: Advected<G>>(
    candidates: &'a [Candidate<'a, G, A>],
    accuracy: Accuracy,
    mut tried: Tried<'a, G, A>,
) -> Result<Found, AccuracyError> {
    tried.begin_search();
    let short = {
        let mut part = Part::find(candidates, accuracy, &mut tried)?;
        part.rank(AIM * part.level(accuracy), (FAR, MOST_IN_VAIN), &mut tried);
        part
    };
    let longer = short.longer(candidates, accuracy, &mut tried).map(|mut part| {
        part.rank(AIM * part.level(accuracy), (FAR, MOST_IN_VAIN), &mut tried);
        part
    });
    let (short, mut part) = match longer {
        Some(longer) => (Some(short), longer),
        None => (None, short),
    };
    let mut level = AIM * part.level(accuracy);
    let mut search = Search { candidates, accuracy, start: tried.start, tried, refused: Refused::default() };
    let (best, reference) = match search.of_whole(&part) {
        Some(found) => found,
        None => search.first(&part, level)?,
    };
    if let Some(error) = part.error_at(best.index, best.steps).filter(|_| part.times > 1.0) {
        level = error * (AIM * accuracy.tolerance / best.error.max(SMALLEST_ERROR));
        part.rank(level, (NEAR, MOST_RUNS_RANKED * best.cost), &mut search.tried);
    }
    let best = search.improved(best, &reference, &part, level);
    let floor = search.rounding(&candidates[best.index], best.steps, &best.end);
    if floor > accuracy.tolerance {
        return Err(AccuracyError::Unreachable { tolerance: accuracy.tolerance, floor, trials: search.tried.total });
    }
    // Of what is too expensive to be looked at over a longer part, what the shorter one says.
    let of_short = short.as_ref().map(|short| {
        let level = short.error_at(best.index, best.steps);
        (short, level.unwrap_or_else(|| AIM * short.level(accuracy)))
    });
    let offer = |index: usize| {
        if index == best.index {
            return (best.steps, best.cost, false);
        }
        let (part, level) = if part.has(index) { (&part, level) } else { of_short.unwrap_or((&part, level)) };
        let estimate = part.estimate(index, level);
        ((estimate.steps * part.times).max(1.0), estimate.cost(part.times), estimate.is_bound)
    };
    let usual = part.cost(best.index, level);
    Ok(Found {
        index: best.index,
        steps: best.steps,
        error: best.error,
        cost: best.cost,
        trials: search.tried.total,
        offers: (0..candidates.len()).map(offer).collect(),
        nearby: [10.0, 0.1].map(|factor| part.cost(best.index, factor * level) / usual),
    })
}

impl<'a, G: LieGroup<Scalar = f64>, A: Advected<G>> Search<'a, G, A> {
    /// The cheapest run that is near enough, and its reference, where the part is the whole motion and its trials do.
    fn of_whole(&self, part: &Part<'a, G, A>) -> Option<(Run<G>, End<G>)> {
        let (start, tolerance) = (self.start, self.accuracy.tolerance);
        let (reference, left) = part.reference_of_whole().filter(|(_, left)| *left <= OF_THE_REFERENCE * tolerance)?;
        let run = |(index, trial): (usize, &Trial<G>)| {
            let end = trial.end?;
            // The reference's own is what it is left with.
            let error = start.difference(&end, &reference).max(left);
            Some(Run { index, steps: trial.steps, error, cost: trial.cost(), end })
        };
        let near = part.trials().filter_map(run).filter(|run| run.error <= ACCEPTED * tolerance);
        near.min_by(|a, b| a.cost.total_cmp(&b.cost)).map(|best| (best, reference))
    }

    /// A method near enough, the one that looks cheapest if that gets there, and a run by which others are measured.
    fn first(&mut self, part: &Part<'a, G, A>, level: f64) -> Result<(Run<G>, End<G>), AccuracyError> {
        let mut floors = 0;
        for index in part.ranking(level) {
            let estimate = part.estimate(index, level);
            if estimate.steps.is_infinite() {
                self.note_steps(index, part.least_steps(index), true);
                break;
            }
            if let Some(found) = self.approach(index, estimate.steps * part.times) {
                return Ok(found);
            }
            floors += u32::from(self.refused.floor.is_some());
            if self.refused.is_final || floors >= MOST_FLOORS || self.tried.spent() > MOST_IN_VAIN {
                break;
            }
        }
        Err(self.refusal())
    }

    /// Runs a method to the horizon with ever shorter steps, until they show the error of those before.
    fn approach(&mut self, index: usize, likely: f64) -> Option<(Run<G>, End<G>)> {
        let (candidate, start, tolerance) = (&self.candidates[index], self.start, self.accuracy.tolerance);
        let mut ladder = Ladder::new(candidate);
        let coarser = (AIM * tolerance / COARSE).min(1.0).powf(f64::from(candidate.order).recip());
        let mut steps = (likely * coarser).ceil().max(1.0);
        let mut expected = f64::INFINITY;
        let left = loop {
            let agree = ladder.last_error(start).is_some();
            let most = if agree { MOST_OPERATIONS } else { MOST_IN_VAIN };
            if self.tried.spent() + ladder.cost_of(steps) > most {
                let needed = if agree { ladder.estimate(start, None, AIM * tolerance).steps } else { likely };
                self.note_steps(index, needed.max(steps), !agree && steps >= likely);
                if !agree {
                    self.note_floor(&ladder, 0.0);
                }
                break None;
            }
            ladder.extend(start.horizon, steps, &mut self.tried);
            let Some(error) = ladder.error_of_finest(start) else {
                steps = ladder.twice_the_steps();
                continue;
            };
            // Steps much shorter than those before tell an error by themselves; others where it is the one expected.
            let last = ladder.last_error(start).unwrap_or(f64::INFINITY);
            let is_sure = ladder.last_ratio() >= SURE_RATIO || last <= EXPECTED * expected;
            if error <= OF_THE_REFERENCE * tolerance && is_sure {
                break Some(error);
            }
            if let Some(least) = ladder.floor(start) {
                self.note_floor(&ladder, ABOVE_THE_FLOOR * least);
                break None;
            }
            // Far more than the trials before have shown, and far more steps than they have: that may be rounding.
            let is_unexpected = last > UNEXPECTED * expected || steps > UNEXPECTED_STEPS * likely;
            if is_unexpected && self.note_floor(&ladder, 0.0) {
                break None;
            }
            expected = error;
            let aim = ladder.estimate(start, None, AIM * tolerance).steps.ceil();
            let finer = ladder.factor(start, error / (AIM_OF_THE_REFERENCE * tolerance)).max(LEAST_FACTOR);
            let next = if aim > 1.1 * steps { aim } else { (steps * finer).ceil() };
            let most = if ladder.falls(start) { MOST_FACTOR } else { FACTOR_IN_DOUBT };
            steps = next.min(most * steps);
        };
        let Some(left) = left else {
            if let (None, Some(finest)) = (&ladder.failure, ladder.finest()) {
                self.note_steps(index, finest.steps, true);
            }
            self.refused.failure = self.refused.failure.take().or(ladder.failure);
            return None;
        };
        let finest = *ladder.finest()?;
        let reference = finest.end?;
        let run = |trial: &Trial<G>, error| {
            Some(Run { index, steps: trial.steps, error, cost: trial.cost(), end: trial.end? })
        };
        let measured = ladder.trials().iter().filter_map(|trial| {
            let error = start.difference(&trial.end?, &reference);
            run(trial, error).filter(|_| trial.steps < finest.steps && error <= ACCEPTED * tolerance)
        });
        let best = measured.min_by(|a, b| a.cost.total_cmp(&b.cost));
        let is_settled = best.is_some_and(|best| best.error > TOO_GOOD * tolerance);
        let aim = ladder.estimate(start, None, AIM * tolerance).steps.ceil().max(1.0);
        let order = ladder.order(start);
        let best = if is_settled { best } else { self.settled(index, aim, order, &reference, best) };
        // Where all others are too rough, the finest is near enough by what the others show of it.
        let best = best.filter(|best| best.cost < finest.cost()).or_else(|| run(&finest, left));
        best.map(|best| (best, reference))
    }

    /// A run of this method with a step that is just short enough, if one is cheaper than the best so far.
    fn settled(
        &mut self,
        index: usize,
        mut steps: f64,
        order: f64,
        reference: &End<G>,
        mut best: Option<Run<G>>,
    ) -> Option<Run<G>> {
        let (candidate, start, tolerance) = (&self.candidates[index], self.start, self.accuracy.tolerance);
        for _ in 0..MOST_CORRECTIONS {
            // The run may become the best, and cost less than is thought.
            let (spent, least) = (self.tried.spent() + self.tried.price(candidate, steps), candidate.least(steps));
            if best.is_some_and(|best| spent > MOST_RUNS_YET * best.cost.min(least)) {
                break;
            }
            let (trial, _) = self.tried.run(candidate, start.horizon, steps);
            // A step that has no solution is too long.
            let error = trial.end.map_or(f64::INFINITY, |end| start.difference(&end, reference));
            let is_near = error <= ACCEPTED * tolerance;
            if is_near && best.is_none_or(|best| trial.cost() < best.cost) {
                best = trial.end.map(|end| Run { index, steps, error, cost: trial.cost(), end });
            }
            let ratio = (error / (AIM * tolerance)).powf(order.recip());
            let next = (steps * ratio.clamp(0.1, 2.0)).ceil();
            // One that is near enough is only made longer, one that isn't shorter.
            let is_right = if is_near { error > TOO_GOOD * tolerance || next >= steps } else { next <= steps };
            let likely = trial.once + next * trial.a_step;
            if is_right || best.is_some_and(|best| likely > best.cost) {
                break;
            }
            steps = next;
        }
        best
    }

    /// Runs other methods that may be cheaper, as far as trials may go.
    fn improved(&mut self, first: Run<G>, reference: &End<G>, part: &Part<'a, G, A>, level: f64) -> Run<G> {
        let mut best = first;
        for index in part.ranking(level) {
            let estimate = part.estimate(index, level);
            let likely = estimate.cost(part.times);
            if index == first.index && (part.times > 1.0 || best.error > TOO_GOOD * self.accuracy.tolerance) {
                continue;
            }
            if likely > WORTH_TRYING * best.cost {
                break;
            }
            let steps = (estimate.steps * part.times).ceil().max(1.0);
            let order = f64::from(self.candidates[index].order);
            best = self.settled(index, steps, order, reference, Some(best)).unwrap_or(best);
        }
        best
    }

    /// By how far a run ends from one that starts some roundings away: the least tolerance that this leaves.
    fn rounding(&mut self, candidate: &Candidate<'a, G, A>, steps: f64, end: &End<G>) -> f64 {
        let trial = self.tried.run_nearby(candidate, steps);
        trial.end.map_or(f64::INFINITY, |nearby| self.start.difference(&nearby, end) / OF_ROUNDING)
    }

    /// Whether rounding leaves more than the tolerance.
    fn note_floor(&mut self, ladder: &Ladder<'a, G, A>, least: f64) -> bool {
        let Some((steps, Some(end))) = ladder.finest().map(|finest| (finest.steps, finest.end)) else { return false };
        let rounding = self.rounding(ladder.candidate, steps, &end);
        self.refused.is_final |= rounding > self.accuracy.tolerance;
        let floor = rounding.max(least);
        if floor > self.accuracy.tolerance {
            self.refused.floor = Some(self.refused.floor.map_or(floor, |before| before.min(floor)));
        }
        floor > self.accuracy.tolerance
    }

    /// Remembers the first method that needs too many steps.
    fn note_steps(&mut self, index: usize, steps: f64, is_bound: bool) {
        let method = || self.candidates[index].name.clone();
        self.refused.many.get_or_insert_with(|| TooMany { steps, is_bound, method: method() });
    }

    fn refusal(&mut self) -> AccuracyError {
        let Refused { many, floor, failure, .. } = core::mem::take(&mut self.refused);
        let (trials, tolerance) = (self.tried.total, self.accuracy.tolerance);
        match floor {
            Some(floor) => AccuracyError::Unreachable { tolerance, floor, trials },
            None => refusal(failure, many, trials),
        }
    }
}
