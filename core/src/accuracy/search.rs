//! The search for the cheapest method: the one that looks cheapest is tried a step finer, until it is near enough.

use super::error::AccuracyError;
use super::ladder::{AIM, Estimate, Ladder, Start};
use super::{Accuracy, Candidate};
use crate::groups::{Advected, LieGroup};

/// A run with more stages isn't tried.
const MOST_STAGES: f64 = 2e8;
/// Nor is one where no two trials agree so long.
const MOST_STAGES_IN_VAIN: f64 = 4e6;
/// A method that comes to its floor is followed by others only so much more expensive.
const BEYOND_THE_FLOOR: f64 = 4.0;
/// What of the tolerance a run may differ from the reference by, whose own error is a quarter at most.
const ACCEPTED: f64 = 0.75;
/// Of the least difference of two runs, a tolerance that they show to be reached.
const ABOVE_THE_FLOOR: f64 = 8.0;

/// A method is looked at further, once one is found, if it may be cheaper than that by this factor.
const WORTH_LOOKING: f64 = 0.8;
/// Of the tolerance, an error so small that longer steps are tried.
const TOO_GOOD: f64 = 0.4;

/// The method found, and how it compares.
pub(super) struct Found {
    /// Which of the candidates, by how many steps.
    pub(super) run: Run,
    /// Operations of all trials.
    pub(super) spent: f64,
    /// What each candidate takes for the tolerance.
    pub(super) estimates: Vec<Estimate>,
    /// What the method found takes for ten times the tolerance and for a tenth.
    pub(super) nearby: [Estimate; 2],
}

/// A run that is near enough.
#[derive(Clone, Copy)]
pub(super) struct Run {
    /// Which of the candidates.
    pub(super) index: usize,
    pub(super) steps: f64,
    /// Against the finest trial.
    pub(super) error: f64,
    /// Operations.
    pub(super) cost: f64,
}

/// The cheapest candidate for an accuracy, by operations.
pub(super) fn search<G: LieGroup<Scalar = f64>, A: Advected<G>>(
    candidates: &[Candidate<G, A>],
    accuracy: Accuracy,
    start: &Start<G>,
) -> Result<Found, AccuracyError> {
    let tolerance = accuracy.tolerance;
    let aim = AIM * tolerance;
    let mut ladders: Vec<_> = candidates.iter().map(Ladder::new).collect();
    let mut open: Vec<usize> = (0..ladders.len()).collect();
    let mut best: Option<Run> = None;
    let mut refused = Refused { steps: 0.0, in_vain: None, floor: f64::INFINITY };
    // The most expensive run worth trying.
    let mut limit = f64::INFINITY;
    loop {
        let costs = open.iter().map(|&index| (index, ladders[index].estimate(aim)));
        let cheapest = costs.min_by(|a, b| a.1.cost.total_cmp(&b.1.cost));
        let Some((index, estimate)) = cheapest.filter(|(_, estimate)| estimate.cost <= limit) else { break };
        let ladder = &mut ladders[index];
        let run = if ladder.is_reference(tolerance) { settle(ladder, index, start, tolerance) } else { None };
        let most = if estimate.is_bound { MOST_STAGES_IN_VAIN } else { MOST_STAGES };
        if let Some(run) = run {
            best = best.filter(|best| best.cost <= run.cost).or(Some(run));
            limit = limit.min(WORTH_LOOKING * run.cost);
        } else if let Some((least, cost)) = ladder.floor() {
            let of_rounding = ladder.least_tolerance(start);
            refused.floor = refused.floor.min(of_rounding.max(ABOVE_THE_FLOOR * least));
            limit = limit.min(BEYOND_THE_FLOOR * cost);
        } else if ladder.next_steps() * f64::from(ladder.candidate.stages) > most {
            refused.steps = refused.steps.max(estimate.steps);
            // Trials that don't agree may have steps too long all the same; it is rounding if that alone parts them.
            let in_vain = ladder.last_difference().filter(|_| estimate.is_bound && refused.in_vain.is_none());
            refused.in_vain = refused.in_vain.or(in_vain.filter(|_| ladder.least_tolerance(start) > tolerance));
        } else {
            ladder.extend(start);
            continue;
        }
        open.retain(|other| *other != index);
    }
    let Some(run) = best else { return Err(refused.error(ladders, accuracy.tolerance)) };
    let floor = ladders[run.index].least_tolerance(start);
    if floor > tolerance {
        return Err(AccuracyError::Unreachable { tolerance: accuracy.tolerance, floor });
    }
    let estimates = ladders.iter().map(|ladder| ladder.estimate(aim)).collect();
    let nearby = [10.0, 0.1].map(|factor| ladders[run.index].estimate(factor * aim));
    let spent = ladders.iter().map(|ladder| ladder.spent).sum();
    Ok(Found { run, spent, estimates, nearby })
}

/// The number of steps that is just enough; nothing where a finer reference is needed.
fn settle<G: LieGroup<Scalar = f64>, A: Advected<G>>(
    ladder: &mut Ladder<'_, G, A>,
    index: usize,
    start: &Start<G>,
    tolerance: f64,
) -> Option<Run> {
    let (order, finest) = (ladder.order(), 0.5 * ladder.next_steps());
    let ratio = |error: f64| (error / (AIM * tolerance)).powf(order.recip());
    let mut steps = ladder.estimate(AIM * tolerance).steps.ceil();
    let mut best: Option<Run> = None;
    while steps < finest {
        // A step that has no solution is too long.
        let (error, cost) = ladder.verify(start, steps).unwrap_or((f64::INFINITY, f64::INFINITY));
        if error > ACCEPTED * tolerance {
            if best.is_some() {
                break;
            }
            steps = (steps * ratio(error).clamp(1.05, 2.0)).ceil();
            continue;
        }
        best = Some(Run { index, steps, error, cost });
        let fewer = (steps * ratio(error).max(0.5)).ceil();
        if error > TOO_GOOD * tolerance || fewer >= steps {
            break;
        }
        steps = fewer;
    }
    best
}

/// What was found of methods that would need too many steps.
struct Refused {
    steps: f64,
    /// How far the runs of one ended from each other, however short the steps, where that is what rounding leaves.
    in_vain: Option<f64>,
    /// The least tolerance that differences which have stopped falling show to be reached.
    floor: f64,
}

impl Refused {
    fn error<G, A>(&self, ladders: Vec<Ladder<'_, G, A>>, tolerance: f64) -> AccuracyError
    where
        G: LieGroup<Scalar = f64>,
        A: Advected<G>,
    {
        if self.floor.is_finite() {
            return AccuracyError::Unreachable { tolerance, floor: self.floor };
        }
        if let Some(floor) = self.in_vain {
            return AccuracyError::Unreachable { tolerance, floor };
        }
        match ladders.into_iter().find_map(|ladder| ladder.failure) {
            Some(cause) => cause,
            None => AccuracyError::TooManySteps { steps: self.steps },
        }
    }
}
