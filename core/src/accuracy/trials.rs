//! A trial: one run of one method to a horizon, and what all of them cost together.

use alloc::vec::Vec;

use super::Accuracy;
use super::candidates::{Candidate, Method};
use super::error::AccuracyError;
use crate::groups::{Advected, LieGroup};
use crate::motion::Integrator as _;
use crate::numbers::{Coordinates as _, Entries};

// Roots and powers without a standard library.
#[cfg(not(feature = "std"))]
use nalgebra::ComplexField as _;

/// Where a run ends.
#[derive(Clone, Copy, Debug)]
pub struct End<G: LieGroup> {
    /// The attitude, body to space.
    pub attitude: G,
    /// The body velocity, on SO(3) in rad/s.
    pub velocity: G::Vector,
}

/// Where trials start, and how far they go.
#[derive(Clone, Copy, Debug)]
pub(super) struct Start<G: LieGroup> {
    pub(super) attitude: G,
    pub(super) velocity: G::Vector,
    pub(super) horizon: f64,
}

/// How far apart two starts are that rounding doesn't tell apart in a run: about what the roundings of its first
/// hundred stages add up to.
const ROUNDINGS: f64 = 16.0 * f64::EPSILON;

impl<G: LieGroup<Scalar = f64>> Start<G> {
    /// The same motion, for a part of the time.
    pub(super) fn until(&self, horizon: f64) -> Self {
        Self { horizon, ..*self }
    }

    /// A start some roundings away, in all directions.
    pub(super) fn nearby(&self) -> Self {
        let axes = (0..G::DIMENSION).map(G::Vector::axis);
        let aside = axes.fold(G::Vector::zero(), |sum, axis| sum * -0.8 + axis) * ROUNDINGS;
        let attitude = self.attitude.compose(&G::from_increment(&G::hat(&aside)));
        let velocity = self.velocity + aside * Accuracy::scale(size(&self.velocity), 0.0, self.horizon);
        Self { attitude, velocity, horizon: self.horizon }
    }

    /// The error that [`Accuracy`] defines.
    pub(super) fn difference(&self, end: &End<G>, exact: &End<G>) -> f64 {
        let apart = |a: &G::Vector, b: &G::Vector| size(&a.zip(b, &mut |a, b| a - b));
        let attitudes = end.attitude.matrix().zip(&exact.attitude.matrix(), &mut |a, b| a - b);
        let scale = Accuracy::scale(size(&self.velocity), size(&exact.velocity), self.horizon);
        (size(&attitudes) / size(&exact.attitude.matrix())).hypot(apart(&end.velocity, &exact.velocity) / scale)
    }
}

/// One run to the horizon.
#[derive(Clone, Copy, Debug)]
pub(super) struct Trial<G: LieGroup> {
    pub(super) steps: f64,
    /// Operations of a step.
    pub(super) a_step: f64,
    /// Operations besides the steps.
    pub(super) once: f64,
    /// None where there is no such step, or one had no solution.
    pub(super) end: Option<End<G>>,
}

impl<G: LieGroup> Trial<G> {
    /// Operations.
    pub(super) fn cost(&self) -> f64 {
        self.once + self.steps * self.a_step
    }
}

/// The trials of a question. From its start none is made twice; those from a start nearby are apart, and not kept.
pub(super) struct Tried<'a, G: LieGroup, A> {
    pub(super) start: &'a Start<G>,
    pub(super) total: Trials,
    /// Operations before the search.
    before: f64,
    made: Vec<Made<'a, G, A>>,
}

/// A trial from the start.
struct Made<'a, G: LieGroup, A> {
    method: &'a Method<G, A>,
    horizon: f64,
    trial: Trial<G>,
    failure: Option<AccuracyError>,
}

impl<'a, G: LieGroup<Scalar = f64>, A: Advected<G>> Tried<'a, G, A> {
    pub(super) fn new(start: &'a Start<G>) -> Self {
        Self { start, total: Trials::default(), before: 0.0, made: Vec::new() }
    }

    /// From here on trials are of the search.
    pub(super) fn begin_search(&mut self) {
        self.before = self.total.operations;
    }

    /// Operations of the search.
    pub(super) fn spent(&self) -> f64 {
        self.total.operations - self.before
    }

    #[allow(clippy::float_cmp)] // the same numbers, not computed anew
    fn made(&self, candidate: &Candidate<'a, G, A>, horizon: f64, steps: f64) -> Option<&Made<'a, G, A>> {
        self.made.iter().find(|made| {
            core::ptr::eq(made.method, candidate.method) && made.horizon == horizon && made.trial.steps == steps
        })
    }

    /// What a run to the horizon of the question is thought to add: nothing, if it has been made.
    pub(super) fn price(&self, candidate: &Candidate<'a, G, A>, steps: f64) -> f64 {
        self.made(candidate, self.start.horizon, steps).map_or_else(|| candidate.untried(steps), |_| 0.0)
    }

    /// A method with so many steps to a horizon, and why that failed.
    pub(super) fn run(
        &mut self,
        candidate: &Candidate<'a, G, A>,
        horizon: f64,
        steps: f64,
    ) -> (Trial<G>, Option<AccuracyError>) {
        if let Some(Made { trial, failure, .. }) = self.made(candidate, horizon, steps) {
            return (*trial, failure.clone());
        }
        let (trial, failure) = self.total.run(candidate, &self.start.until(horizon), steps);
        self.made.push(Made { method: candidate.method, horizon, trial, failure: failure.clone() });
        (trial, failure)
    }

    /// The same to the horizon of the question, from a start some roundings away.
    pub(super) fn run_nearby(&mut self, candidate: &Candidate<'a, G, A>, steps: f64) -> Trial<G> {
        self.total.run(candidate, &self.start.nearby(), steps).0
    }
}

/// The trial runs that a choice has taken.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Trials {
    /// How many.
    pub runs: u64,
    /// Steps of the longest.
    pub most_steps: f64,
    /// The arithmetic of all, in operations on doubles.
    pub operations: f64,
}

impl Trials {
    /// Runs a method with so many steps.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a whole number, far below the largest
    fn run<G: LieGroup<Scalar = f64>, A: Advected<G>>(
        &mut self,
        candidate: &Candidate<'_, G, A>,
        start: &Start<G>,
        steps: f64,
    ) -> (Trial<G>, Option<AccuracyError>) {
        let run = || -> Result<_, AccuracyError> {
            let stepper = (candidate.make)(start.horizon / steps)?;
            let mut state = stepper.start(start.attitude, start.velocity)?;
            let iterations = stepper.attempt(&mut state, steps as u64).map_err(AccuracyError::Step)?;
            let once = stepper.cost().once;
            let a_step = (stepper.cost().of_run(steps as u64, iterations) - once) / steps;
            let end = End { attitude: state.attitude(), velocity: stepper.velocity(&state) };
            Ok(Trial { steps, a_step, once, end: Some(end).filter(is_finite) })
        };
        let (trial, failure) = match run() {
            Ok(trial) => (trial, None),
            Err(failure) => {
                (Trial { steps, a_step: candidate.a_step(), once: candidate.once(), end: None }, Some(failure))
            }
        };
        self.runs += 1;
        self.most_steps = self.most_steps.max(steps);
        self.operations += trial.cost();
        (trial, failure)
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
