//! A short part of the motion, over which all methods are tried: it tells them apart for little.
//!
//! A few steps show what a method's error is made of, and errors of some steps grow along the motion by nearly the same
//! factor, whichever method has made them. So methods are ranked by the steps that they need over the part for an error
//! that one of them is known to have there when it has the error asked for at the horizon; before any is known to, for
//! one that grows in proportion to time.

use alloc::vec::Vec;

use super::Accuracy;
use super::candidates::Candidate;
use super::error::{AccuracyError, TooMany, refusal};
use super::ladder::{Estimate, LARGEST_ERROR, Ladder, SMALLEST_ERROR};
use super::search::{MOST_IN_VAIN, MOST_RUNS};
use super::trials::{End, Start, Trial, Tried};
use crate::groups::{Advected, LieGroup};

// Roots and powers without a standard library.
#[cfg(not(feature = "std"))]
use nalgebra::ComplexField as _;

/// The part is shortened by this factor until so many steps are enough for a motion.
const SHORTER: f64 = 8.0;
const MOST_STEPS: f64 = 8.0;
/// So many times at most.
const MOST_SHORTENINGS: u32 = 20;
/// The part is found by a method of this order, if there is one.
const HIGHEST_ORDER_OF_A_SCOUT: u32 = 6;
/// The part has about so many steps of the method by which it is found.
const OF_STEPS: f64 = 3.0;
/// Of the stages of that method, what none is thought to come below; so little that it isn't the one missed.
const OF_STAGES: f64 = 0.4;
/// Of an error, what a reference is allowed.
const OF_A_REFERENCE: f64 = 0.1;
/// Errors below this aren't measured over the part: rounding has a share of them.
const LEAST_LEVEL: f64 = 64.0 * f64::EPSILON;
/// A reference isn't looked for with so many times the steps of the first trial.
const MOST_REFERENCE_STEPS: f64 = 256.0;
/// The ranking ends where it would cost more than so many runs of the method that looks cheapest. There are up to three
/// rankings, which leave more than a third of [`MOST_RUNS`] to the runs to the horizon.
const OF_A_RANKING: f64 = 6.0;
/// Methods are told apart that seem to cost up to so many times the cheapest.
pub(super) const FAR: f64 = 2.0;
/// How often a longer part is in the horizon.
const LONGER: f64 = 5.0;
/// It is shorter where a run over it would take more operations, so that as many runs as a choice may take end in time.
const OF_A_LONGER_PART: f64 = MOST_IN_VAIN / MOST_RUNS;
/// Of the steps that the shorter part shows, the trials over the longer one begin with these fractions.
const ROUGHER: f64 = 4.0;
const MUCH_ROUGHER: f64 = 16.0;

/// The trials of all methods over a part of the motion.
pub(super) struct Part<'a, G: LieGroup<Scalar = f64>, A> {
    start: Start<G>,
    /// How often it is in the horizon.
    pub(super) times: f64,
    reference: Option<End<G>>,
    /// Its own error.
    left: f64,
    /// Stages over the part below which no method is thought to come.
    least_stages: f64,
    /// Of the methods that are looked at.
    ladders: Vec<Option<Ladder<'a, G, A>>>,
}

impl<'a, G: LieGroup<Scalar = f64>, A: Advected<G>> Part<'a, G, A> {
    /// The part over which some method's steps are few.
    ///
    /// # Errors
    ///
    /// That of a method, where none makes steps however short.
    pub(super) fn find(
        candidates: &'a [Candidate<'a, G, A>],
        accuracy: Accuracy,
        tried: &mut Tried<'a, G, A>,
    ) -> Result<Self, AccuracyError> {
        let start = tried.start;
        // Sorts by what a reference would cost, if the errors of all methods fell by the same law. Methods without an
        // error come first, and last those of high orders, whose steps may be much longer than others'.
        let error = error_of_one_step(candidates, tried).unwrap_or(1.0);
        let less = (error / (OF_A_REFERENCE * accuracy.tolerance)).max(1.0);
        let likely = |index: usize| {
            let candidate: &Candidate<'_, G, A> = &candidates[index];
            let steps = if candidate.is_exact { 1.0 } else { less.powf(f64::from(candidate.order).recip()) };
            (!candidate.is_exact, candidate.order > HIGHEST_ORDER_OF_A_SCOUT, candidate.untried(steps))
        };
        let mut scouts: Vec<usize> = (0..candidates.len()).collect();
        scouts.sort_by(|&a, &b| {
            let ((errs_a, high_a, of_a), (errs_b, high_b, of_b)) = (likely(a), likely(b));
            (errs_a, high_a).cmp(&(errs_b, high_b)).then(of_a.total_cmp(&of_b))
        });
        let (mut failure, mut many) = (None, None);
        for scout in scouts {
            let (mut scouted, mut horizon, mut last_failure) = (None, start.horizon, None);
            let too_many = |steps, is_bound| TooMany { steps, is_bound, method: candidates[scout].name.clone() };
            for _ in 0..MOST_SHORTENINGS {
                let (start, mut ladder) = (start.until(horizon), Ladder::new(&candidates[scout]));
                let level = level(accuracy, horizon);
                while ladder.twice_the_steps() <= MOST_STEPS {
                    ladder.extend(horizon, ladder.twice_the_steps(), tried);
                    if ladder.error_of_finest(&start).is_some_and(|error| error <= OF_A_REFERENCE * level) {
                        break;
                    }
                }
                if ladder.last_error(&start).is_some() {
                    scouted = Some((start, ladder, level));
                    break;
                }
                last_failure = ladder.failure;
                horizon /= SHORTER;
            }
            let Some((found, ladder, level)) = scouted else {
                // The shortest part had too few, if it had any.
                match last_failure {
                    Some(last) => failure = failure.or(Some(last)),
                    None => {
                        many.get_or_insert_with(|| too_many(MOST_STEPS * start.horizon / (SHORTER * horizon), true));
                    }
                }
                continue;
            };
            let step = found.horizon / ladder.estimate(&found, None, level).steps;
            let wanted = (OF_STEPS * step).min(start.horizon);
            let mut ladders: Vec<_> = candidates.iter().map(Ladder::new).map(Some).collect();
            let horizon = if wanted <= found.horizon && wanted > 0.25 * found.horizon {
                ladders[scout] = Some(ladder);
                found.horizon
            } else {
                wanted
            };
            let least_stages = OF_STAGES * horizon / step * f64::from(candidates[scout].stages);
            let (start, times) = (start.until(horizon), start.horizon / horizon);
            let mut part = Self { start, times, reference: None, left: 0.0, least_stages, ladders };
            if part.refer(scout, accuracy, tried).is_some() {
                return Ok(part);
            }
            many.get_or_insert_with(|| too_many(times * horizon / step, false));
        }
        Err(refusal(failure, many, tried.total))
    }

    /// A longer part, for the methods that may be cheapest; none where this one is as long.
    pub(super) fn longer(
        &self,
        candidates: &'a [Candidate<'a, G, A>],
        accuracy: Accuracy,
        tried: &mut Tried<'a, G, A>,
    ) -> Option<Self> {
        let level = self.level(accuracy);
        let scout = *self.ranking(level).first()?;
        let likely = self.cost(scout, level);
        let times = LONGER.max(likely / OF_A_LONGER_PART);
        if 2.0 * times > self.times {
            return None;
        }
        let most = FAR * likely;
        let ladder = |(index, candidate): (usize, &'a Candidate<'a, G, A>)| {
            let estimate = self.estimate(index, level);
            let may_be_cheaper = estimate.is_short || estimate.cost(self.times) <= most;
            let rougher = if estimate.is_short { MUCH_ROUGHER } else { ROUGHER };
            let first = (estimate.steps * self.times / times / rougher).ceil().max(1.0);
            may_be_cheaper.then(|| Ladder::from(candidate, first))
        };
        let ladders = candidates.iter().enumerate().map(ladder).collect();
        let start = self.start.until(accuracy.horizon / times);
        let mut part = Self { start, times, reference: None, left: 0.0, least_stages: 0.0, ladders };
        part.refer(scout, accuracy, tried)?;
        Some(part)
    }

    /// Makes the reference.
    fn refer(&mut self, scout: usize, accuracy: Accuracy, tried: &mut Tried<'a, G, A>) -> Option<()> {
        let (ladder, start) = (self.ladders[scout].as_mut()?, &self.start);
        let enough = OF_A_REFERENCE * level(accuracy, start.horizon);
        let most = MOST_REFERENCE_STEPS * ladder.twice_the_steps();
        // Over the whole motion it isn't only compared with: the choice may rest on it.
        let is_whole = self.times <= 1.0;
        let left = |ladder: &Ladder<'a, G, A>| {
            if is_whole { ladder.error_shown_of_finest(start) } else { ladder.error_of_finest(start) }
        };
        loop {
            let is_enough = left(ladder).is_some_and(|error| error <= enough);
            let steps = ladder.twice_the_steps();
            let is_too_much = steps > most || tried.spent() + ladder.cost_of(steps) > MOST_IN_VAIN;
            if is_enough || ladder.floor(start).is_some() || is_too_much {
                break;
            }
            ladder.extend(start.horizon, steps, tried);
        }
        let agrees = ladder.last_error(start).is_some_and(|error| error < LARGEST_ERROR);
        self.reference = ladder.finest().and_then(|finest| finest.end).filter(|_| agrees);
        self.left = left(ladder).unwrap_or(f64::INFINITY);
        self.reference.map(|_| ())
    }

    /// What the reference is, with its own error, if the part is the whole motion.
    pub(super) fn reference_of_whole(&self) -> Option<(End<G>, f64)> {
        self.reference.filter(|_| self.times <= 1.0).map(|reference| (reference, self.left))
    }

    /// The trials of all methods, with the places of these.
    pub(super) fn trials<'s>(&'s self) -> impl Iterator<Item = (usize, &'s Trial<G>)> {
        let of = |(index, ladder): (usize, &'s Option<Ladder<'a, G, A>>)| {
            ladder.iter().flat_map(Ladder::trials).map(move |trial| (index, trial))
        };
        self.ladders.iter().enumerate().flat_map(of)
    }

    /// The error over the part that is about the tolerance at the horizon, if errors grow in proportion to time.
    pub(super) fn level(&self, accuracy: Accuracy) -> f64 {
        level(accuracy, self.start.horizon)
    }

    /// Whether a method is looked at.
    pub(super) fn has(&self, index: usize) -> bool {
        self.ladders[index].is_some()
    }

    /// What a method takes for an error over the part.
    pub(super) fn estimate(&self, index: usize, error: f64) -> Estimate {
        let Some(ladder) = &self.ladders[index] else { return Estimate::NEVER };
        let estimate = ladder.estimate(&self.start, self.reference.as_ref(), error);
        let least = if estimate.is_bound { self.least_stages / f64::from(ladder.candidate.stages) } else { 0.0 };
        Estimate { steps: estimate.steps.max(least), ..estimate }
    }

    /// Operations of a run to the horizon with the steps that an error over the part takes.
    pub(super) fn cost(&self, index: usize, error: f64) -> f64 {
        self.estimate(index, error).cost(self.times)
    }

    /// Of a method of which no estimate is known, the steps that a run to the horizon has at least.
    pub(super) fn least_steps(&self, index: usize) -> f64 {
        self.ladders[index].as_ref().and_then(Ladder::finest).map_or(1.0, |finest| finest.steps * self.times)
    }

    /// The error over the part of steps of which a run to the horizon has so many.
    pub(super) fn error_at(&self, index: usize, steps: f64) -> Option<f64> {
        let error =
            self.ladders[index].as_ref()?.error_at(&self.start, self.reference.as_ref()?, steps / self.times)?;
        Some(error).filter(|error| *error > 0.1 * SMALLEST_ERROR && *error < LARGEST_ERROR)
    }

    /// All methods, the cheapest first, and last those of which but a bound is known.
    pub(super) fn ranking(&self, error: f64) -> Vec<usize> {
        let mut indices: Vec<usize> = (0..self.ladders.len()).collect();
        let place = |index| (self.estimate(index, error).is_bound, self.cost(index, error));
        indices.sort_by(|&a, &b| {
            let ((a, of_a), (b, of_b)) = (place(a), place(b));
            a.cmp(&b).then(of_a.total_cmp(&of_b))
        });
        indices
    }

    /// Tries methods over the part until all that may take less than so many times what the cheapest takes have come
    /// near the error, or all trials have made so many operations.
    pub(super) fn rank(&mut self, error: f64, (within, most): (f64, f64), tried: &mut Tried<'a, G, A>) {
        let before = tried.spent();
        loop {
            let estimates: Vec<_> = (0..self.ladders.len()).map(|index| self.estimate(index, error)).collect();
            let cost = |index: usize| estimates[index].cost(self.times);
            let (known, open): (Vec<usize>, Vec<usize>) =
                (0..self.ladders.len()).partition(|&index| estimates[index].is_near);
            let best = known.into_iter().map(cost).fold(f64::INFINITY, f64::min);
            let Some(index) = open.into_iter().min_by(|&a, &b| cost(a).total_cmp(&cost(b))) else { break };
            let spent = tried.spent() - before;
            let next = self.ladders[index].as_ref().map_or(0.0, |ladder| ladder.cost_of(ladder.twice_the_steps()));
            let is_expensive = cost(index) > within * best || spent + next > OF_A_RANKING * best;
            if is_expensive || cost(index).is_infinite() || tried.spent() + next > most {
                break;
            }
            let Some(ladder) = &mut self.ladders[index] else { break };
            ladder.extend(self.start.horizon, ladder.twice_the_steps(), tried);
        }
    }
}

/// How large the error is of one step to the horizon, by the method that makes it for the least.
fn error_of_one_step<'a, G: LieGroup<Scalar = f64>, A: Advected<G>>(
    candidates: &'a [Candidate<'a, G, A>],
    tried: &mut Tried<'a, G, A>,
) -> Option<f64> {
    let start = tried.start;
    let cost = |candidate: &&Candidate<'_, G, A>| candidate.untried(1.0);
    let mut ladder = Ladder::new(candidates.iter().min_by(|a, b| cost(a).total_cmp(&cost(b)))?);
    for steps in [1.0, 2.0] {
        ladder.extend(start.horizon, steps, tried);
    }
    ladder.last_error(start)
}

fn level(accuracy: Accuracy, horizon: f64) -> f64 {
    (accuracy.tolerance * (horizon / accuracy.horizon)).max(LEAST_LEVEL)
}
