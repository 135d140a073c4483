//! The search for the cheapest method: the one that looks cheapest is tried a step finer, until it is near enough.

use super::Accuracy;
use super::Candidate;
use super::error::AccuracyError;
use super::ladder::{AIM, Estimate, LARGEST_ERROR, Ladder, Start};
use crate::advected::Advected;
use crate::groups::LieGroup;

/// A run with more stages isn't tried.
const MOST_STAGES: f64 = 2e8;
/// Nor is one where no two trials agree so long.
const MOST_STAGES_IN_VAIN: f64 = 4e6;
/// A method that comes to its floor is followed by others only so much dearer.
const BEYOND_THE_FLOOR: f64 = 4.0;
/// What of the tolerance a run may differ from the reference by, whose own error is a quarter at most.
const ACCEPTED: f64 = 0.75;
/// Of the least difference of two runs, a tolerance that they show to be reached.
const ABOVE_THE_FLOOR: f64 = 8.0;

/// The method found, and how it compares.
pub(super) struct Found {
    /// Which of the candidates.
    pub(super) index: usize,
    pub(super) steps: f64,
    /// Against the finest trial.
    pub(super) error: f64,
    /// Operations of the run.
    pub(super) cost: f64,
    /// Operations of all trials.
    pub(super) spent: f64,
    /// What each candidate takes for the tolerance.
    pub(super) estimates: Vec<Estimate>,
    /// What the method found takes for ten times the tolerance and for a tenth.
    pub(super) nearby: [Estimate; 2],
}

/// The cheapest candidate for an accuracy, by operations.
pub(super) fn search<G: LieGroup<Scalar = f64>, A: Advected<G>>(
    candidates: &[Candidate<G, A>],
    accuracy: Accuracy,
    start: &Start<G>,
) -> Result<Found, AccuracyError> {
    // What is larger isn't an error but another motion.
    let tolerance = accuracy.tolerance.min(LARGEST_ERROR);
    let aim = AIM * tolerance;
    let mut ladders: Vec<_> = candidates.iter().map(Ladder::new).collect();
    let mut open: Vec<usize> = (0..ladders.len()).collect();
    // The least difference of two runs, and the dearest run worth trying.
    let (mut floor, mut limit) = (f64::INFINITY, f64::INFINITY);
    let mut refused = Refused::default();
    loop {
        let cost = |index: &usize| ladders[*index].estimate(aim).cost;
        let cheapest = open.iter().copied().min_by(|a, b| cost(a).total_cmp(&cost(b)));
        let Some(index) = cheapest else {
            return Err(failure(ladders, accuracy.tolerance, floor, &refused));
        };
        let ladder = &mut ladders[index];
        if ladder.is_reference(tolerance)
            && let Some((steps, error, cost)) = settle(ladder, start, tolerance)
        {
            let estimates = ladders.iter().map(|ladder| ladder.estimate(aim)).collect();
            let nearby = [10.0, 0.1].map(|factor| ladders[index].estimate(factor * aim));
            let spent = ladders.iter().map(|ladder| ladder.spent).sum();
            return Ok(Found { index, steps, error, cost, spent, estimates, nearby });
        }
        let ladder = &ladders[index];
        let estimate = ladder.estimate(aim);
        let most = if estimate.is_bound { MOST_STAGES_IN_VAIN } else { MOST_STAGES };
        if let Some((least, cost)) = ladder.floor() {
            floor = floor.min(least);
            limit = limit.min(BEYOND_THE_FLOOR * cost);
        } else if ladder.next_steps() * f64::from(ladder.candidate.stages) > most {
            refused.steps = refused.steps.max(estimate.steps);
            refused.in_vain = refused.in_vain.or(ladder.last_difference().filter(|_| estimate.is_bound));
        } else if estimate.cost <= limit {
            ladders[index].extend(start);
            continue;
        }
        open.retain(|other| *other != index);
    }
}

/// The number of steps that is just enough, with the error measured and the cost; nothing where a finer reference is
/// needed.
fn settle<G: LieGroup<Scalar = f64>, A: Advected<G>>(
    ladder: &mut Ladder<'_, G, A>,
    start: &Start<G>,
    tolerance: f64,
) -> Option<(f64, f64, f64)> {
    let (order, finest) = (ladder.order(), 0.5 * ladder.next_steps());
    let mut steps = ladder.estimate(AIM * tolerance).steps.ceil();
    while steps < finest {
        let (error, cost) = ladder.verify(start, steps)?;
        if error <= ACCEPTED * tolerance {
            return Some((steps, error, cost));
        }
        let more = (error / (AIM * tolerance)).powf(order.recip()).clamp(1.05, 2.0);
        steps = (steps * more).ceil();
    }
    None
}

/// What was found of methods that would need too many steps.
#[derive(Default)]
struct Refused {
    steps: f64,
    /// How far the runs of one ended from each other, however short the steps.
    in_vain: Option<f64>,
}

fn failure<G: LieGroup<Scalar = f64>, A: Advected<G>>(
    ladders: Vec<Ladder<'_, G, A>>,
    tolerance: f64,
    floor: f64,
    refused: &Refused,
) -> AccuracyError {
    if floor.is_finite() {
        return AccuracyError::Unreachable { tolerance, floor: ABOVE_THE_FLOOR * floor };
    }
    if let Some(floor) = refused.in_vain {
        return AccuracyError::Unreachable { tolerance, floor };
    }
    match ladders.into_iter().find_map(|ladder| ladder.failure) {
        Some(cause) => AccuracyError::Step(cause),
        None => AccuracyError::TooManySteps { steps: refused.steps },
    }
}
