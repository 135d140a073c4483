//! A trial: one run of one method to a horizon, and what all of them cost together.

use super::Accuracy;
use super::candidates::Candidate;
use super::error::AccuracyError;
use crate::groups::{Advected, LieGroup};
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
    pub(super) fn run<G: LieGroup<Scalar = f64>, A: Advected<G>>(
        &mut self,
        candidate: &Candidate<G, A>,
        start: &Start<G>,
        steps: f64,
    ) -> (Trial<G>, Option<AccuracyError>) {
        let run = || -> Result<_, AccuracyError> {
            let stepper = (candidate.make)(start.horizon / steps)?;
            let mut state = stepper.start(start.attitude, start.velocity)?;
            let iterations = stepper.run_unexplained(&mut state, steps as u64).map_err(AccuracyError::Step)?;
            let once = stepper.cost().once;
            let a_step = (stepper.cost().of_run(steps as u64, iterations) - once) / steps;
            let end = End { attitude: state.attitude(), velocity: stepper.velocity(&state) };
            Ok(Trial { steps, a_step, once, end: Some(end).filter(is_finite) })
        };
        let (trial, failure) = match run() {
            Ok(trial) => (trial, None),
            Err(failure) => (Trial { steps, a_step: candidate.least, once: 0.0, end: None }, Some(failure)),
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
