//! One step of one length: its increment from a state, by the usual solve or with care, and the rare work after it.

use liestep::__private::{MAX_ITERATIONS, STEPS_BETWEEN_CHECKS, STEPS_BETWEEN_SEVERAL, TOLERATED};
use liestep::StepError;
use liestep_derivation::Array;

use super::codes::{Codes, rare};
use super::constants::StepConstants;
use super::diagnosis::Step;
use super::iteration::{Iterates, Problem};
use super::limit::Limit;
use super::linear::are_finite;
use crate::code::{Backend, StepInputs};

/// A declaration's code with numbers for its parameters.
#[derive(Clone, Copy)]
pub(super) struct StepCodes<'a, B: Backend<f64>> {
    pub(super) codes: &'a Codes<B>,
    pub(super) numbers: &'a [f64],
    /// The distance of an attitude from its group beyond which it is restored, in units of rounding.
    pub(super) tolerated: f64,
}

/// An increment that was made.
#[derive(Clone, Copy)]
pub(super) struct Increment {
    pub(super) iterations: u32,
    /// Whether the increment is too far from the identity for an extrapolation.
    pub(super) is_far: bool,
}

/// The results of the program that ends a step.
struct End<'a> {
    /// The state without the number of steps.
    state: &'a [f64],
    /// The sum of momentum and advected parameters: finite if they are.
    sum: f64,
    near: &'a [f64],
}

impl End<'_> {
    /// Whether the increment is near the identity if it is taken so many times.
    fn is_near(&self, times: f64) -> bool {
        self.near.iter().all(|near| near * (times * times) < 1.0)
    }
}

/// The number of numbers that a step needs besides its state.
pub(super) fn room<B: Backend<f64>>(codes: &Codes<B>) -> usize {
    codes.code.target.outputs + Iterates::room(codes) + codes.code.finish.outputs
}

impl<'a, B: Backend<f64>> StepCodes<'a, B> {
    pub(super) fn of(codes: &'a Codes<B>, numbers: &'a [f64]) -> Self {
        Self { codes, numbers, tolerated: if codes.rotations > 1 { 0.0 } else { TOLERATED } }
    }

    /// The continuous limit at these advected parameters.
    pub(super) fn limit(&self, advected: &'a [f64]) -> Limit<'a, B> {
        Limit { codes: self.codes, numbers: self.numbers, advected }
    }

    /// One step with the memory of a single step.
    #[inline]
    pub(super) fn step(self, constants: &StepConstants, state: &mut [f64], room: &mut [f64]) -> Result<u32, StepError> {
        let made = match self.directly(constants, state, room) {
            Some(made) => made,
            None => self.carefully(constants, state)?,
        };
        Ok(self.count(made, state))
    }

    /// The step by the usual solve, where a back end makes that in one piece.
    #[inline]
    pub(super) fn step_in_one_piece(self, constants: &StepConstants, state: &mut [f64]) -> Option<u32> {
        self.in_one_piece(constants, state).map(|made| self.count(made, state))
    }

    /// Counts a step whose increment was made; returns its iterations.
    #[inline]
    pub(super) fn count(self, Increment { iterations, is_far }: Increment, state: &mut [f64]) -> u32 {
        let (sizes, last) = (&self.codes.sizes, state.len() - 1);
        if is_far {
            state.copy_within(sizes.history()..sizes.history() + sizes.n, sizes.guess());
        }
        if self.is_due(state[last]) {
            self.look(state);
        }
        state[last] += 1.0;
        iterations
    }

    /// Advances attitude, momentum and advected parameters from the guess in the state, and extrapolates a parabola to the
    /// next guess. The steps aren't counted. After an error the state is as it was.
    #[inline]
    pub(super) fn increment(
        self,
        constants: &StepConstants,
        state: &mut [f64],
        room: &mut [f64],
    ) -> Result<Increment, StepError> {
        match self.in_one_piece(constants, state).or_else(|| self.directly(constants, state, room)) {
            Some(made) => Ok(made),
            None => self.carefully(constants, state),
        }
    }

    /// The increment by the usual solve, where a back end makes it in one piece.
    #[inline]
    fn in_one_piece(self, constants: &StepConstants, state: &mut [f64]) -> Option<Increment> {
        let bounds = [constants.safe, constants.largest_target];
        let inputs = StepInputs { constants: &constants.numbers, parameters: self.numbers, bounds };
        let made = B::step(&self.codes.usual(), inputs, state);
        let iterations = u32::try_from(made / 2).ok().filter(|&iterations| iterations > 0)?;
        Some(Increment { iterations, is_far: made % 2 == 1 })
    }

    /// The increment by the usual solve; `None` if anything about it is doubtful.
    #[inline]
    fn directly(self, constants: &StepConstants, state: &mut [f64], room: &mut [f64]) -> Option<Increment> {
        let (codes, sizes) = (self.codes, &self.codes.sizes);
        let (target, room) = room.split_at_mut(sizes.n + 1);
        let (iterates, end) = room.split_at_mut(Iterates::room(codes));
        let (momentum, advected) =
            (&state[sizes.momentum()..sizes.advected()], &state[sizes.advected()..sizes.history()]);
        let given = [(Array::Momentum, momentum), (Array::Advected, advected)];
        B::run(&codes.code.target.code, &constants.numbers, given, target);
        let (target, square) = target.split_at(sizes.n);
        let safe = constants.safe_at(codes, self.numbers, advected, iterates);
        let (numbers, h) = (self.numbers, constants.h);
        let problem = Problem { codes, numbers, h, constants: &constants.numbers, target, advected, safe };
        let mut iterates = Iterates::at(&state[sizes.guess()..sizes.guess() + sizes.n], codes, iterates);
        let iterations = iterates.iterate(&problem, MAX_ITERATIONS)?;
        if !(iterates.det > 0.0 && square[0] < constants.largest_target) {
            return None;
        }
        let end = self.end(constants, state, (iterates.half, target), end);
        // The bound with a margin is tested first: most solutions satisfy it.
        let is_far = !end.is_near(3.0);
        // A sum that isn't finite may have overflowed.
        if !end.sum.is_finite() || is_far && !end.is_near(2.0) {
            return None;
        }
        let before = state.len() - 1;
        state[..before].copy_from_slice(end.state);
        Some(Increment { iterations, is_far })
    }

    /// The state after the increment of a solution.
    #[inline]
    fn end<'b>(
        self,
        constants: &StepConstants,
        state: &[f64],
        (half, target): (&[f64], &[f64]),
        room: &'b mut [f64],
    ) -> End<'b> {
        let (program, sizes) = (&self.codes.code.finish, &self.codes.sizes);
        let end = &mut room[..program.outputs];
        let given = [
            (Array::Half, half),
            (Array::Target, target),
            (Array::Advected, &state[sizes.advected()..sizes.history()]),
            (Array::Momentum, &state[sizes.momentum()..sizes.advected()]),
            (Array::Attitude, &state[..sizes.entries]),
            (Array::History, &state[sizes.history()..sizes.guess()]),
        ];
        B::run(&program.code, &constants.numbers, given, end);
        let (state, others) = end.split_at(sizes.state() - 1);
        End { state, sum: others[0], near: &others[1..] }
    }

    /// The increment by the solve with care, or its error.
    #[cold]
    #[inline(never)]
    fn carefully(self, constants: &StepConstants, state: &mut [f64]) -> Result<Increment, StepError> {
        let (codes, sizes) = (self.codes, &self.codes.sizes);
        if constants.h == 0.0 {
            stand_still(&mut state[sizes.history()..], sizes.n);
            return Ok(Increment { iterations: 0, is_far: false });
        }
        let (momentum, advected) =
            (&state[sizes.momentum()..sizes.advected()], &state[sizes.advected()..sizes.history()]);
        let safe = constants.safe_at(codes, self.numbers, advected, &mut vec![0.0; 2 * sizes.dets]);
        let step = Step { codes, numbers: self.numbers, constants, momentum, advected };
        let (half, iterations) = step.solve_carefully(&state[sizes.guess()..sizes.guess() + sizes.n], safe)?;
        let given = [(Array::Momentum, momentum), (Array::Advected, advected)];
        let target = rare::<B>(&codes.code.target, &constants.numbers, given);
        let mut room = vec![0.0; codes.code.finish.outputs];
        let end = self.end(constants, state, (&half, &target[..sizes.n]), &mut room);
        if !are_finite(&end.state[sizes.momentum()..sizes.history()]) {
            return Err(StepError::NonFinite { what: "momentum after the step" });
        }
        let before = state.len() - 1;
        state[..before].copy_from_slice(end.state);
        Ok(Increment { iterations, is_far: !end.is_near(3.0) })
    }

    /// Whether a correction of rounding errors is due after so many steps.
    #[inline]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a count
    pub(super) fn is_due(self, steps: f64) -> bool {
        let between = if self.codes.rotations > 1 { STEPS_BETWEEN_SEVERAL } else { STEPS_BETWEEN_CHECKS };
        const { assert!(STEPS_BETWEEN_CHECKS.is_power_of_two() && STEPS_BETWEEN_SEVERAL.is_power_of_two()) };
        (steps as u64) & (u64::from(between) - 1) == 0
    }

    /// The rare work after the first step of a single step, and after a fixed number of further ones.
    #[cold]
    #[inline(never)]
    pub(super) fn look(self, state: &mut [f64]) {
        let sizes = &self.codes.sizes;
        if state[state.len() - 1] == 0.0 {
            // The increment before the first was an estimate.
            state.copy_within(sizes.history()..sizes.history() + sizes.n, sizes.guess());
            state[sizes.history() + sizes.n..sizes.guess()].fill(0.0);
        }
        self.restore(state);
    }

    /// Takes attitudes that rounding has moved away back to their groups, and advected parameters with them.
    #[cold]
    pub(super) fn restore(self, state: &mut [f64]) {
        let (codes, sizes) = (self.codes, &self.codes.sizes);
        let program = &codes.code.restored;
        if program.outputs == 0 {
            return;
        }
        let (attitude, others) = state.split_at_mut(sizes.entries);
        let mut found = vec![0.0; program.outputs];
        B::run(&program.code, &[], [(Array::Attitude, &*attitude)], &mut found);
        let beyond = f64::EPSILON * self.tolerated;
        let (mut rest, mut any) = (&found[..], false);
        for factor in codes.factors.iter().filter(|factor| factor.is_restored()) {
            let size = factor.size() * factor.size();
            let (own, behind) = rest.split_at(1 + size);
            if own[0] > beyond {
                attitude[factor.entry..factor.entry + size].copy_from_slice(&own[1..]);
                any = true;
            }
            rest = behind;
        }
        if any {
            others[sizes.n..sizes.n + sizes.carried].copy_from_slice(&codes.seen(self.numbers, attitude));
        }
    }
}

/// The memory after a step that stands still.
fn stand_still(memory: &mut [f64], n: usize) {
    for k in 0..n {
        let difference = 0.0 - memory[k];
        memory[2 * n + k] = difference + (difference - memory[n + k]);
        memory[n + k] = difference;
        memory[k] = 0.0;
    }
}
