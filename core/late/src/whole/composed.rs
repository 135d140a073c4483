//! Stages of a step: one of its own length, or those of a symmetric composition.

use liestep::methods::CompositionScheme;
use liestep::{SetupError, StepError};

use super::codes::Codes;
use super::constants::StepConstants;
use super::step::{Increment, StepCodes};
use crate::code::Backend;

/// A stage, and the linear extrapolation of its coordinates and of the previous stage's to the next stage's guess.
#[derive(Clone, Copy, Debug)]
struct Stage {
    /// The index of the stage's constants.
    constants: usize,
    /// The length as a fraction of the step.
    gamma: f64,
    /// The factor of this stage's coordinates in a guess without the previous stage.
    scale: f64,
    /// The factors of this stage's and of the previous one's in the extrapolation.
    factors: [f64; 2],
}

/// The constants of a step, and its stages: none for a single step.
#[derive(Clone, Debug)]
pub(super) struct Stages {
    /// Distinct constants; those of the first stage come first.
    constants: Vec<StepConstants>,
    list: Vec<Stage>,
}

/// Larger extrapolation ratios would amplify the error of the guess.
const FARTHEST_EXTRAPOLATION: f64 = 3.0;

impl Stages {
    /// The constants of a step `h`, by a composition if there is one.
    pub(super) fn of<B: Backend<f64>>(
        codes: &Codes<B>,
        numbers: &[f64],
        h: f64,
        scheme: Option<CompositionScheme>,
    ) -> Result<Self, SetupError> {
        let Some(scheme) = scheme else {
            return Ok(Self { constants: vec![StepConstants::of(codes, numbers, h)?], list: Vec::new() });
        };
        if !codes.declaration.is_self_adjoint {
            return Err(SetupError::NotSelfAdjoint);
        }
        let gammas: Vec<f64> = scheme.stages().collect();
        let (mut distinct, mut places): (Vec<f64>, Vec<usize>) = (Vec::new(), Vec::new());
        for gamma in &gammas {
            let place = distinct.iter().position(|other| other.to_bits() == gamma.to_bits());
            places.push(place.unwrap_or(distinct.len()));
            if place.is_none() {
                distinct.push(*gamma);
            }
        }
        let constants = distinct.iter().map(|gamma| StepConstants::of(codes, numbers, h * gamma));
        let around = |stage: usize| gammas[stage % gammas.len()];
        let stage = |at: usize| Stage::between(places[at], around(at + gammas.len() - 1), around(at), around(at + 1));
        Ok(Self { constants: constants.collect::<Result<_, _>>()?, list: (0..gammas.len()).map(stage).collect() })
    }

    /// The constants of the first stage.
    pub(super) fn first(&self) -> &StepConstants {
        &self.constants[0]
    }

    /// The constants of a composition's stage.
    pub(super) fn constants(&self, stage: usize) -> &StepConstants {
        &self.constants[self.list[stage].constants]
    }

    /// The number of stages.
    pub(super) fn count(&self) -> usize {
        self.list.len().max(1)
    }

    /// The number of numbers that a step needs besides its state.
    pub(super) fn room<B: Backend<f64>>(&self, codes: &Codes<B>) -> usize {
        let of_stages = if self.list.is_empty() { 0 } else { codes.sizes.state() + codes.sizes.n };
        of_stages + super::step::room(codes)
    }

    /// The constants of a single step; none of a composition.
    pub(super) fn single(&self) -> Option<&StepConstants> {
        self.list.is_empty().then(|| self.first())
    }

    /// A single step that a back end makes in one piece; returns its iterations.
    #[inline]
    pub(super) fn step_in_one_piece<B: Backend<f64>>(
        &self,
        numbered: StepCodes<'_, B>,
        state: &mut [f64],
    ) -> Option<u32> {
        numbered.step_in_one_piece(self.single()?, state)
    }

    /// One step; returns the sum of the iterations. After an error the state is as it was.
    #[inline]
    pub(super) fn step<B: Backend<f64>>(
        &self,
        numbered: StepCodes<'_, B>,
        state: &mut [f64],
        room: &mut [f64],
    ) -> Result<u32, StepError> {
        self.watched(numbered, state, room, &mut |_, _| ())
    }

    /// One step, whose stages are watched: `watch` gets the constants of each and the state before it, and then after it.
    pub(super) fn watched<B: Backend<f64>>(
        &self,
        numbered: StepCodes<'_, B>,
        state: &mut [f64],
        room: &mut [f64],
        watch: &mut impl FnMut(&StepConstants, &[f64]),
    ) -> Result<u32, StepError> {
        if self.list.is_empty() {
            watch(self.first(), state);
            let iterations = numbered.step(self.first(), state, room)?;
            watch(self.first(), state);
            return Ok(iterations);
        }
        self.each(numbered, state, room, &mut |stage, next, room| {
            let constants = self.constants(stage);
            watch(constants, next);
            let made = numbered.increment(constants, next, room)?;
            watch(constants, next);
            Ok(made)
        })
    }

    /// One step of a composition, whose increments a function makes from the number of a stage, a state and room.
    pub(super) fn each<B: Backend<f64>>(
        &self,
        numbered: StepCodes<'_, B>,
        state: &mut [f64],
        room: &mut [f64],
        make: &mut impl FnMut(usize, &mut [f64], &mut [f64]) -> Result<Increment, StepError>,
    ) -> Result<u32, StepError> {
        let sizes = &numbered.codes.sizes;
        let (next, room) = room.split_at_mut(state.len());
        let (earlier, room) = room.split_at_mut(sizes.n);
        next.copy_from_slice(state);
        let mut iterations = 0;
        for (number, stage) in self.list.iter().enumerate() {
            earlier.copy_from_slice(&next[sizes.history()..sizes.history() + sizes.n]);
            let made = make(number, next, room)?;
            stage.guess(made, earlier, &mut next[sizes.history()..]);
            iterations += made.iterations;
        }
        let last = next.len() - 1;
        next[last] += 1.0;
        if numbered.is_due(next[last]) {
            numbered.restore(next);
        }
        state.copy_from_slice(next);
        Ok(iterations)
    }

    /// The lengths of the stages as fractions of the step.
    pub(super) fn shares(&self) -> impl Iterator<Item = f64> {
        self.is_single().then_some(1.0).into_iter().chain(self.list.iter().map(|stage| stage.gamma))
    }

    /// The constants of each stage, with its length as a fraction of the step.
    pub(super) fn numbers(&self) -> impl Iterator<Item = (f64, &StepConstants)> {
        let single = self.is_single().then(|| (1.0, self.first()));
        single.into_iter().chain(self.list.iter().map(|stage| (stage.gamma, &self.constants[stage.constants])))
    }

    /// Whether it is a single step.
    pub(super) const fn is_single(&self) -> bool {
        self.list.is_empty()
    }
}

impl Stage {
    /// The stage with coefficient `γ = this` between stages with `before` and `next`.
    ///
    /// The coordinates of a stage over its `γ` are its mean velocity, which to second order is the velocity at the middle of
    /// the stage. A straight line through two of these gives the next stage's. The next middle lies `(this + next)/2` ahead
    /// of this stage's middle, the previous one `(before + this)/2` behind it.
    fn between(constants: usize, before: f64, this: f64, next: f64) -> Self {
        let ratio = (this + next) / (before + this);
        let ratio = if ratio.abs() <= FARTHEST_EXTRAPOLATION { ratio } else { 0.0 };
        let scale = next / this;
        Self { constants, gamma: this, scale, factors: [scale * (1.0 + ratio), -ratio * next / before] }
    }

    /// Writes the guess of the next stage behind the coordinates of this one in a memory. Near the fold coordinates change
    /// too fast for the extrapolation.
    fn guess(&self, made: Increment, earlier: &[f64], memory: &mut [f64]) {
        let (n, [last, before]) = (earlier.len(), self.factors);
        for (k, earlier) in earlier.iter().enumerate() {
            let half = memory[k];
            memory[2 * n + k] = if made.is_far { half * self.scale } else { half * last + earlier * before };
            memory[n + k] = 0.0;
        }
    }
}
