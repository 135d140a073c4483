//! The search for the cheapest method: all are compared over a short part of the motion, and those still near the
//! cheapest over parts eight times as long each.

use alloc::string::{String, ToString as _};
use alloc::vec::Vec;

use super::choice::{Choice, Offer};
use super::error::AccuracyError;
use super::ladder::{LARGEST_ERROR, Ladder, Reference, Run, UNKNOWN};
use super::methods::Candidate;
use super::question::{Accuracy, Start, Trials};
use crate::motion::{Cost, Integrator as _};

roots!();

/// The ratio of the lengths of two successive parts of the motion.
const SHORTER: f64 = 8.0;
/// Limit of the shortenings before the first part.
const MOST_SHORTENINGS: i32 = 20;
/// The share of the tolerance for the reference's own error; the rest is for the run.
const OF_THE_REFERENCE: f64 = 0.1;
const ACCEPTED: f64 = 1.0 - OF_THE_REFERENCE;
/// The error to aim at, relative to the tolerance.
const AIM: f64 = ACCEPTED - 0.5 * OF_THE_REFERENCE;
/// The ratio of the best run's cost to that of a method's first run, if no shorter part gives an estimate.
const FIRST: f64 = 16.0;
/// A run to the horizon is worth its trial if its expected cost is below this share of the best one's.
const WORTH: f64 = 0.98;
/// Limit of the cost of all trials together, in runs of the chosen method.
const MOST_RUNS: f64 = 55.0;
/// Uncertainty of a method's expected cost by its other runs, as a factor.
const UNSURE: f64 = 1.15;
/// Limit of the operations of trials before two runs agree, a second of a processor; afterwards ten times as many.
const MOST_OPERATIONS: f64 = 1e9;
/// The share of the tolerance to which rounding may grow.
const OF_ROUNDING: f64 = 0.25;

/// The cheapest accurate run so far.
#[derive(Clone)]
struct Best {
    index: usize,
    error: f64,
    run: Run,
}

/// Reasons against methods that don't reach the tolerance.
#[derive(Default)]
struct Refusals {
    /// Steps of the first method with too many, whether they are a lower bound, and its name.
    many: Option<(f64, bool, String)>,
    /// The least tolerance that rounding permits.
    floor: Option<f64>,
    /// Whether that floor is the motion's magnification of roundings, and so the same for every method.
    is_final: bool,
    failure: Option<AccuracyError>,
}

/// The methods over one part of the motion.
struct Survey<'a> {
    tolerance: f64,
    ladders: Vec<Ladder<'a>>,
    reference: Reference,
    best: Best,
}

/// A requested accuracy, and the results of the trials.
struct Search<'a> {
    methods: &'a [Candidate],
    costs: Vec<Cost>,
    accuracy: Accuracy,
    start: Start,
    trials: Trials,
    refused: Refusals,
}

/// The cheapest method for an accuracy, by operations.
pub(super) fn search(methods: &[Candidate], accuracy: Accuracy, start: &Start) -> Result<Choice, AccuracyError> {
    // A fault of the scene or of the start doesn't depend on the step.
    let cost = |method: &Candidate| -> Result<Cost, AccuracyError> {
        let stepper = (method.make)(accuracy.horizon / 1024.0).or_else(|_| (method.make)(accuracy.horizon))?;
        stepper.start(&start.attitude, &start.velocity)?;
        Ok(stepper.cost().unwrap_or(UNKNOWN))
    };
    let costs = methods.iter().map(cost).collect::<Result<_, _>>()?;
    let mut search = Search {
        methods,
        costs,
        accuracy,
        start: start.clone(),
        trials: Trials::default(),
        refused: Refusals::default(),
    };
    search.found().ok_or_else(|| search.refusal())
}

impl<'a> Search<'a> {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a whole number
    fn found(&mut self) -> Option<Choice> {
        let (mut times, ladder) = self.shown()?;
        let mut survey = self.survey(times, Some(ladder), None)?;
        while times > 1.0 {
            let Best { index, ref run, .. } = survey.best;
            if times * run.cost > MOST_OPERATIONS {
                self.note_steps(index, times * run.steps, false);
                return None;
            }
            times /= SHORTER;
            self.start.see(&survey.reference.0);
            survey = self.survey(times, None, Some(&survey))?;
        }
        let Survey { ladders, reference, best: Best { index, error, run }, .. } = survey;
        let rounding = ladders[index].rounding(&run, &mut self.trials) / OF_ROUNDING;
        if rounding > self.accuracy.tolerance {
            self.refused.floor = Some(rounding);
            return None;
        }
        let aim = AIM * self.accuracy.tolerance;
        let cost = |index: usize, error: f64| {
            let (steps, a_step) = ladders[index].takes(&reference, error)?;
            Some((steps.max(1.0), ladders[index].least(0.0) + steps.max(1.0) * a_step))
        };
        let offer = |other: usize| {
            let ladder = &ladders[other];
            let (steps, cost, is_bound) = match cost(other, aim) {
                _ if other == index => (run.steps, run.cost, false),
                Some((steps, cost)) => (steps, cost, false),
                None => {
                    let steps = ladder.bound(aim).0.max(1.0);
                    (steps, ladder.least(steps).max(run.cost), true)
                }
            };
            let scheme = ladder.method.scheme;
            let step = self.accuracy.horizon / steps;
            Offer { scheme, order: scheme.order(), step, cost: cost / run.cost, is_bound }
        };
        // The exact motion takes one step for any tolerance.
        let is_exact = ladders[index].method.is_exact();
        let of = |error| cost(index, error).filter(|_| !is_exact).map_or(run.cost, |(_, cost)| cost);
        Some(Choice {
            accuracy: self.accuracy,
            steps: run.steps as u64,
            error,
            trials: self.trials.operations / run.cost,
            nearby: [10.0, 0.1].map(|factor| of(factor * error) / of(error)),
            offers: (0..ladders.len()).map(offer).collect(),
            chosen: index,
        })
    }

    /// The ratio of the horizon to the longest part that a few steps of the cheapest method resolve.
    fn shown(&mut self) -> Option<(f64, Ladder<'a>)> {
        let cheapest = (0..self.methods.len()).min_by(|&a, &b| {
            let place = |k: usize| (!self.methods[k].is_exact(), self.costs[k].least());
            place(a).0.cmp(&place(b).0).then(place(a).1.total_cmp(&place(b).1))
        })?;
        for shortenings in 0..MOST_SHORTENINGS {
            let times = SHORTER.powi(shortenings);
            let mut ladder = self.ladder(cheapest, times);
            let mut steps = 1.0;
            while steps <= SHORTER && !ladder.is_within(OF_THE_REFERENCE * self.tolerance(times)) {
                ladder.run(steps, &mut self.trials);
                steps *= 2.0;
            }
            if ladder.left(1.0).is_some() {
                return Some((times, ladder));
            }
            self.refused.failure = ladder.failure;
        }
        if self.refused.failure.is_none() {
            self.note_steps(cheapest, SHORTER.powi(MOST_SHORTENINGS), true);
        }
        None
    }

    /// The tolerance over a part, if errors grow in proportion to time, but at least some hundred roundings.
    fn tolerance(&self, times: f64) -> f64 {
        let Accuracy { tolerance, .. } = self.accuracy;
        if times <= 1.0 { tolerance } else { (tolerance / times).max(512.0 * f64::EPSILON) }
    }

    fn ladder(&self, index: usize, times: f64) -> Ladder<'a> {
        Ladder::new(&self.methods[index], self.costs[index], self.start.until(self.accuracy.horizon / times))
    }

    /// Compares the methods over a part, with estimates from a shorter one.
    fn survey(&mut self, times: f64, known: Option<Ladder<'a>>, shorter: Option<&Survey<'a>>) -> Option<Survey<'a>> {
        let (tolerance, is_whole) = (self.tolerance(times), times <= 1.0);
        let mut ladders: Vec<_> = (0..self.methods.len()).map(|index| self.ladder(index, times)).collect();
        if let Some(known) = known {
            let same = |ladder: &&mut Ladder<'a>| core::ptr::eq(ladder.method, known.method);
            if let Some(place) = ladders.iter_mut().find(same) {
                *place = known;
            }
        }
        let promised = |index: usize| shorter.and_then(|shorter| shorter.promised(index, AIM * shorter.tolerance));
        let mut scouts: Vec<usize> = (0..ladders.len()).collect();
        let place = |index: usize| {
            let ladder: &Ladder<'_> = &ladders[index];
            // Expected cost if the errors of all methods fell from the largest with one step.
            let alike = || ladder.least((LARGEST_ERROR / (OF_THE_REFERENCE * tolerance)).powf(ladder.order().recip()));
            let cost = promised(index).map(|(_, cost)| cost);
            (!ladder.is_within(OF_THE_REFERENCE * tolerance), cost.is_none(), cost.unwrap_or_else(alike))
        };
        scouts.sort_by(|&a, &b| {
            let (a, b) = (place(a), place(b));
            (a.0, a.1).cmp(&(b.0, b.1)).then(a.2.total_cmp(&b.2))
        });
        let scout = |&index: &usize| {
            let (ladder, first) = (&mut ladders[index], promised(index).map(|(steps, _)| steps));
            let stop = self.refused.is_final || self.trials.operations > MOST_OPERATIONS;
            if stop { None } else { self.approach(index, ladder, first, (tolerance, is_whole)) }
        };
        let found = scouts.iter().find_map(scout)?;
        Some(self.compared(ladders, found, (tolerance, is_whole), shorter))
    }

    /// Runs a method with ever shorter steps until its runs agree: the finest is the reference.
    fn approach(
        &mut self,
        index: usize,
        ladder: &mut Ladder<'a>,
        first: Option<f64>,
        (tolerance, is_whole): (f64, bool),
    ) -> Option<(Reference, Best)> {
        let next = |ladder: &Ladder<'a>| ladder.finest().map_or(1.0, |run| 2.0 * run.steps);
        let (mut steps, mut is_looked_at) = (first.unwrap_or_else(|| next(ladder)), false);
        // A few long steps may not have the method's order yet, so it is assumed only after it has been observed.
        let unseen = first.map_or(1.0, |_| ladder.order());
        if let (Some((left, _)), Some(run)) = (ladder.left(1.0), ladder.finest().cloned())
            && left <= OF_THE_REFERENCE * tolerance
        {
            return Some(((run.end.clone()?, left), Best { index, error: left, run }));
        }
        loop {
            let left = ladder.left(unseen);
            let most = if left.is_some() { 10.0 * MOST_OPERATIONS } else { MOST_OPERATIONS };
            if self.trials.operations + ladder.least(steps) > most {
                self.note_steps(index, steps, left.is_none());
                self.refused.failure = self.refused.failure.take().or(ladder.failure.take());
                return None;
            }
            let run = ladder.run(steps, &mut self.trials);
            // A longer step was valid, so all shorter ones are invalid, too.
            if let (Some(AccuracyError::Setup(_)), true) = (&ladder.failure, ladder.has_end()) {
                self.refused.failure = self.refused.failure.take().or(ladder.failure.take());
                return None;
            }
            let Some((left, order)) = ladder.left(unseen) else {
                steps *= 2.0;
                continue;
            };
            if left <= OF_THE_REFERENCE * tolerance {
                return Some(((run.end.clone()?, left), Best { index, error: left, run }));
            }
            let floor = ladder.floor();
            if floor.is_some() && !is_whole {
                return Some(((run.end.clone()?, left), Best { index, error: left, run }));
            }
            // Far more steps than a shorter part predicts may be a sign of rounding.
            if floor.is_some() || (first.is_some_and(|first| steps > 4.0 * first) && !is_looked_at) {
                is_looked_at = true;
                let rounding = ladder.rounding(&run, &mut self.trials) / OF_ROUNDING;
                self.refused.is_final |= rounding > tolerance;
                let least = rounding.max(floor.map_or(0.0, |floor| SHORTER * floor));
                if least > tolerance {
                    self.refused.floor = Some(self.refused.floor.map_or(least, |before| before.min(least)));
                    return None;
                }
                if floor.is_some() {
                    return None;
                }
            }
            let finer = (left / (0.5 * OF_THE_REFERENCE * tolerance)).powf(order.recip());
            steps = (steps * finer.clamp(1.5, 4.0)).ceil();
        }
    }

    /// Runs the method with the lowest expected cost, again and again, until none can be cheaper than the best.
    fn compared(
        &mut self,
        mut ladders: Vec<Ladder<'a>>,
        (reference, mut best): (Reference, Best),
        (tolerance, is_whole): (f64, bool),
        shorter: Option<&Survey<'a>>,
    ) -> Survey<'a> {
        let aim = AIM * tolerance;
        let improve = |best: &mut Best, index: usize, error: Option<f64>, run: &Run| match error {
            Some(error) if error <= ACCEPTED * tolerance && run.cost < best.run.cost => {
                *best = Best { index, error, run: run.clone() };
            }
            _ => {}
        };
        for (index, ladder) in ladders.iter().enumerate() {
            ladder.runs.iter().for_each(|run| improve(&mut best, index, ladder.error(run, &reference), run));
        }
        loop {
            let level = shorter.map_or(aim, |shorter| shorter.level(&best, aim));
            let next = |(index, ladder): (usize, &Ladder<'a>)| {
                let is_tried = !ladder.runs.is_empty();
                let (steps, cost) = match (ladder.takes(&reference, aim), shorter) {
                    (Some(taken), _) => ladder.of_run(taken),
                    (None, _) if is_tried => (ladder.bound(aim).1, ladder.least(ladder.bound(aim).0)),
                    (None, Some(shorter)) => {
                        shorter.promised(index, level).unwrap_or_else(|| shorter.bound(index, level))
                    }
                    (None, None) => ladder.of_run((best.run.cost / (FIRST * ladder.least(1.0)), ladder.least(1.0))),
                };
                let within = if is_whole && is_tried { WORTH } else { UNSURE };
                (!ladder.has(steps) && cost < within * best.run.cost).then_some((index, steps, cost))
            };
            let next = ladders.iter().enumerate().filter_map(next).min_by(|a, b| a.2.total_cmp(&b.2));
            match next {
                Some((index, steps, cost)) if self.trials.operations + cost < MOST_RUNS * best.run.cost => {
                    let run = ladders[index].run(steps, &mut self.trials);
                    improve(&mut best, index, ladders[index].error(&run, &reference), &run);
                }
                _ => return Survey { tolerance, ladders, reference, best },
            }
        }
    }

    /// Records the first method that needs too many steps.
    fn note_steps(&mut self, index: usize, steps: f64, is_bound: bool) {
        let name = || self.methods[index].scheme.to_string();
        self.refused.many.get_or_insert_with(|| (steps, is_bound, name()));
    }

    /// The error of a failed search. Long steps may fail in any way, so that their failure comes last.
    fn refusal(&mut self) -> AccuracyError {
        let Refusals { many, floor, failure, .. } = core::mem::take(&mut self.refused);
        let (trials, tolerance) = (self.trials, self.accuracy.tolerance);
        match (floor, failure, many) {
            (Some(floor), ..) => AccuracyError::Unreachable { tolerance, floor, trials },
            (_, Some(failure @ AccuracyError::Setup(_)), _) | (_, Some(failure), None) => failure,
            (.., Some((steps, is_bound, method))) => AccuracyError::TooManySteps { steps, is_bound, method, trials },
            // No method was tried.
            (..) => AccuracyError::TooManySteps { steps: 0.0, is_bound: true, method: String::new(), trials },
        }
    }
}

impl Survey<'_> {
    /// Expected steps and operations over the next part, from the steps for an error over this one.
    fn promised(&self, index: usize, error: f64) -> Option<(f64, f64)> {
        let (steps, a_step) = self.ladders[index].takes(&self.reference, error)?;
        Some(self.ladders[index].of_run((SHORTER * steps, a_step)))
    }

    /// Lower bounds of the steps and operations expected of a method without a small enough error here; with one step,
    /// if that is too long for this part.
    fn bound(&self, index: usize, error: f64) -> (f64, f64) {
        let ladder = &self.ladders[index];
        ladder.of_run((SHORTER * ladder.bound(error).0, ladder.least(1.0) - ladder.least(0.0)))
    }

    /// The error over this part that corresponds to `aim` over the next, by the growth of the best run's error.
    fn level(&self, best: &Best, aim: f64) -> f64 {
        let here = self.ladders[best.index].error_at(&self.reference, best.run.steps / SHORTER);
        here.map_or(AIM * self.tolerance, |here| here * (aim / best.error)).max(f64::EPSILON)
    }
}
