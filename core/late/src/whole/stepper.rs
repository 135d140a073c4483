//! The stepper: one step with its numbers folded into constants.

use std::sync::Arc;

use liestep::__private::{largest_fraction, six_digits};
use liestep::motion::{Layout, Propagator, StepReport};
use liestep::{SetupError, StepError};
use liestep_derivation::Array;
use liestep_derivation::whole::Form;

use super::family::{NOTHING, Name, WholeFamily};
use super::solve::{Scratch, determinant};
use crate::code::Backend;

/// A determinant is safe above this part of that at rest; and the part of `1/ε` that a target may have of the Jacobian.
const SAFE: f64 = 1.0 / 16.0;
const RATIO: f64 = 1.0 / 4096.0;
/// The numbers of steps between two corrections of an attitude's rounding errors, for one body and for several, and the
/// tolerated distance from the group, in roundings, for one.
const STEPS_BETWEEN_CHECKS: [u64; 2] = [1024, 64];
const TOLERATED: f64 = 2048.0;

/// The stepper of a declaration on any group, whose states are numbers; it is a [`Propagator`].
///
/// # Examples
///
/// A free body on SL(3), the group of linear maps of volume one, of which the library has no type: its momentum in space is
/// conserved to rounding.
///
/// ```
/// use liestep::motion::Propagator as _;
/// use liestep_late::{Declaration, Interpreter, Whole, WholeFamily};
///
/// let text = "
///     #[lagrangian(
///         group(F = Own, generators = [
///             [[0, 1, 0], [0, 0, 0], [0, 0, 0]], [[0, 0, 1], [0, 0, 0], [0, 0, 0]],
///             [[0, 0, 0], [1, 0, 0], [0, 0, 0]], [[0, 0, 0], [0, 0, 1], [0, 0, 0]],
///             [[0, 0, 0], [0, 0, 0], [1, 0, 0]], [[0, 0, 0], [0, 0, 0], [0, 1, 0]],
///             [[1, 0, 0], [0, -1, 0], [0, 0, 0]], [[0, 0, 0], [0, 1, 0], [0, 0, -1]],
///         ]),
///         l_d = (((F - I) * J * (F - I).transpose()).trace() + ((inverse(F) - I) * J * (inverse(F) - I).transpose()).trace()) / (4 * h),
///     )]
///     struct Fluid { J: NonstandardInertia }";
/// # let _ = text;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Whole<B: Backend<f64>> {
    pub(super) family: Arc<WholeFamily<B>>,
    pub(super) h: f64,
    pub(super) numbers: Arc<[f64]>,
    pub(super) constants: Vec<f64>,
    /// Whether there is one factor, so that its determinant isn't relative to the diagonal.
    pub(super) is_one: bool,
    /// The determinant above which a solve needs no second Jacobian, if the inertia is constant.
    safe: f64,
    /// The trace of the Newton Jacobian at rest.
    pub(super) trace: f64,
    /// The square of a target far beyond those of steps that have a solution.
    largest: f64,
}

/// A state of another layout.
pub(super) const OF_THIS_LAYOUT: StepError = StepError::NonFinite { what: "state of this layout" };

impl<B: Backend<f64>> Whole<B> {
    /// The stepper of these numbers, those of all parameters in order, by the step `h`, s.
    ///
    /// # Errors
    ///
    /// The errors of [`Stepper::new`](liestep::Stepper::new), and [`SetupError::Length`] for another count of numbers.
    pub fn new(family: &Arc<WholeFamily<B>>, numbers: &[f64], h: f64) -> Result<Self, SetupError> {
        family.check(numbers)?;
        if !(h.is_finite() && (h == 0.0 || h.recip().is_finite())) {
            return Err(SetupError::InvalidStep { step: h });
        }
        let spatial = family.seen(numbers, &family.identity());
        if family.declaration.has_constant_inertia {
            family.check_inertia(&family.inertia(numbers, &spatial))?;
        }
        let folded = |h: f64| {
            let step = [h];
            family.outputs(Name::Constants, &[], [(Array::Step, &step[..]), (Array::Parameters, numbers), NOTHING])
        };
        let constants = folded(h);
        let are_finite = |constants: &[f64]| constants.iter().all(|number| number.is_finite());
        if h != 0.0 && !are_finite(&constants) && !are_finite(&folded(1.0)) {
            return Err(SetupError::NonFiniteConstant);
        }
        let rest = family.outputs(Name::Rest, &constants, [(Array::Advected, &spatial[..]), NOTHING]);
        let (trace, pairs) = rest.split_first().map_or((f64::NAN, &[][..]), |(trace, pairs)| (*trace, pairs));
        let is_one = family.factors.len() == 1;
        let at_rest = determinant(pairs, is_one);
        let in_steps = (0..family.sizes.n).fold(at_rest, |product, _| product / h);
        let is_in_range = if family.declaration.has_constant_inertia && is_one {
            in_steps.is_finite() && in_steps != 0.0
        } else {
            (trace / h).is_finite()
        };
        if h != 0.0 && !is_in_range {
            return Err(SetupError::InvalidStep { step: h });
        }
        let largest = trace / h * (2.0 * RATIO) / f64::EPSILON;
        let largest = if h == 0.0 { 0.0 } else { largest * largest };
        let family = Arc::clone(family);
        Ok(Self { family, h, numbers: numbers.into(), constants, is_one, safe: at_rest * SAFE, trace, largest })
    }

    /// The stepper of the same numbers by another step.
    pub(super) fn of_step(&self, h: f64) -> Result<Self, SetupError> {
        Self::new(&self.family, &self.numbers, h)
    }

    /// The family of steppers of the same declaration.
    #[must_use]
    pub const fn family(&self) -> &Arc<WholeFamily<B>> {
        &self.family
    }

    /// A state from an attitude and a body momentum, as by
    /// [`Stepper::start_with_momentum`](liestep::Stepper::start_with_momentum).
    ///
    /// # Errors
    ///
    /// As there, and [`SetupError::Length`].
    pub fn start_with_momentum(&self, attitude: &[f64], momentum: &[f64]) -> Result<Box<[f64]>, SetupError> {
        let (family, sizes) = (&self.family, &self.family.sizes);
        for (what, list, expected) in [("attitude", attitude, sizes.entries), ("momentum", momentum, sizes.n)] {
            if list.len() != expected {
                return Err(SetupError::Length { what, found: list.len(), expected });
            }
        }
        family.check_attitude(attitude)?;
        if !momentum.iter().all(|number| number.is_finite()) {
            return Err(SetupError::NonFinite { what: "momentum" });
        }
        let advected = family.seen(&self.numbers, attitude);
        if !family.declaration.has_constant_inertia {
            family.check_inertia(&family.inertia(&self.numbers, &advected))?;
        }
        if !family.declaration.is_quadratic && family.velocity(&self.numbers, momentum, &advected).is_none() {
            return Err(SetupError::NoVelocity);
        }
        let state = self.begun(attitude, momentum, &advected);
        if !advected.iter().all(|number| number.is_finite()) {
            return Err(SetupError::NonFinite { what: "view of what is advected" });
        }
        if !state[sizes.history()..].iter().all(|number| number.is_finite()) {
            return Err(SetupError::NonFinite { what: "velocity of the momentum" });
        }
        Ok(state)
    }

    /// The state whose memory begins here.
    pub(super) fn begun(&self, attitude: &[f64], momentum: &[f64], advected: &[f64]) -> Box<[f64]> {
        let sizes = &self.family.sizes;
        let mut state = vec![0.0; sizes.state()].into_boxed_slice();
        state[..sizes.entries].copy_from_slice(attitude);
        state[sizes.momentum()..sizes.advected()].copy_from_slice(momentum);
        state[sizes.advected()..sizes.history()].copy_from_slice(advected);
        self.remember(&mut state, momentum, advected);
        state
    }

    /// Writes the memory of a new start.
    fn remember(&self, state: &mut [f64], momentum: &[f64], advected: &[f64]) {
        let sizes = &self.family.sizes;
        let velocity = self.family.velocity(&self.numbers, momentum, advected);
        let velocity = velocity.unwrap_or_else(|| self.family.near_rest(&self.numbers, momentum, advected));
        for (k, xi) in velocity.into_iter().enumerate() {
            let half = xi * (self.h * 0.5);
            state[sizes.history() + k] = half;
            state[sizes.history() + sizes.n + k] = 0.0;
            state[sizes.guess() + k] = half;
        }
    }

    /// The determinant above which a solve needs no second Jacobian.
    pub(super) fn safe_at(&self, advected: &[f64]) -> f64 {
        if !self.family.has(Name::Safe) {
            return self.safe;
        }
        let given = [(Array::Parameters, &self.numbers[..]), (Array::Advected, advected), NOTHING];
        determinant(&self.family.outputs(Name::Safe, &[], given), self.is_one) * SAFE
    }

    /// One step; the iterations.
    pub(super) fn advance(&self, state: &mut [f64], scratch: &mut Scratch) -> Result<u32, StepError> {
        let sizes = &self.family.sizes;
        if state.len() != sizes.state() {
            return Err(OF_THIS_LAYOUT);
        }
        if self.h == 0.0 {
            state[sizes.state() - 1] += 1.0;
            return Ok(0);
        }
        let (momentum, advected) =
            (&state[sizes.momentum()..sizes.advected()], &state[sizes.advected()..sizes.history()]);
        self.aim(momentum, advected, scratch);
        let guess = &state[sizes.guess()..sizes.guess() + sizes.n];
        scratch.half.copy_from_slice(guess);
        let found = self.iterate(advected, self.safe_at(advected), 20, scratch);
        let is_usual = found.is_settled && found.determinant > 0.0 && scratch.target[sizes.n] < self.largest;
        let mut iterations = found.iterations;
        let mut is_far = is_usual.then(|| self.finish(state, scratch)).flatten();
        if is_far.is_none() {
            let guess = guess.to_vec();
            iterations = self
                .solve_carefully(advected, &guess, scratch)
                .map_err(|error| self.explained(error, momentum, advected))?;
            is_far = self.finish(state, scratch);
        }
        let Some(is_far) = is_far else { return Err(StepError::NonFinite { what: "momentum after the step" }) };
        let (new, steps) = (sizes.state() - 1, state[sizes.state() - 1]);
        state[..new].copy_from_slice(&scratch.end[..new]);
        if is_far {
            state.copy_within(sizes.history()..sizes.history() + sizes.n, sizes.guess());
        }
        let is_several = self.rotations().count() > 1;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a count
        if (steps as u64).is_multiple_of(STEPS_BETWEEN_CHECKS[usize::from(is_several)]) {
            self.look(state, steps, if is_several { 0.0 } else { TOLERATED });
        }
        state[new] = steps + 1.0;
        Ok(iterations)
    }

    /// Writes the state after the step behind the iterate; whether the increment is far from the identity, or none where it is
    /// too far or a number isn't finite.
    fn finish(&self, state: &[f64], scratch: &mut Scratch) -> Option<bool> {
        let sizes = &self.family.sizes;
        let given = [
            (Array::Half, &scratch.half[..]),
            (Array::Target, &scratch.target[..sizes.n]),
            (Array::Advected, &state[sizes.advected()..sizes.history()]),
            (Array::Momentum, &state[sizes.momentum()..sizes.advected()]),
            (Array::Attitude, &state[..sizes.entries]),
            (Array::History, &state[sizes.history()..sizes.guess()]),
        ];
        self.family.run(Name::Finish, &self.constants, given, &mut scratch.end);
        let others = &scratch.end[sizes.state() - 1..];
        if !others[0].is_finite() {
            return None;
        }
        let is_far = others[1..].iter().any(|near| !(near * 9.0 < 1.0));
        let is_near = !is_far || others[1..].iter().all(|near| near * 4.0 < 1.0);
        is_near.then_some(is_far)
    }

    /// The factors that are restored: rotations of bodies, as in the library.
    fn rotations(&self) -> impl Iterator<Item = &liestep_derivation::whole::MatrixFactor> {
        self.family.factors.iter().filter(|factor| factor.form == Form::Rotation)
    }

    /// The rare work after the first step, and after a fixed number of further ones: attitudes that roundings have taken
    /// farther from the group than `beyond` are restored.
    #[cold]
    fn look(&self, state: &mut [f64], steps: f64, beyond: f64) {
        let (family, sizes) = (&self.family, &self.family.sizes);
        if steps == 0.0 {
            state.copy_within(sizes.history()..sizes.history() + sizes.n, sizes.guess());
            state[sizes.history() + sizes.n..sizes.guess()].fill(0.0);
        }
        let nearer = family.outputs(Name::Restored, &[], [(Array::Attitude, &state[..sizes.entries])]);
        let (mut rest, mut is_changed) = (&nearer[..], false);
        for factor in family.factors.iter().filter(|factor| factor.is_restored()) {
            let (own, behind) = rest.split_at(1 + factor.size() * factor.size());
            rest = behind;
            if factor.form == Form::Rotation && own[0] > f64::EPSILON * beyond {
                state[factor.entry..factor.entry + own.len() - 1].copy_from_slice(&own[1..]);
                is_changed = true;
            }
        }
        if is_changed {
            let advected = family.seen(&self.numbers, &state[..sizes.entries]);
            state[sizes.advected()..sizes.history()].copy_from_slice(&advected);
        }
    }

    /// The error of a failed solve, which names the largest solvable step if there is one.
    #[cold]
    fn explained(&self, error: StepError, momentum: &[f64], advected: &[f64]) -> StepError {
        let is_finite = |list: &[f64]| list.iter().all(|number| number.is_finite());
        if !is_finite(momentum) {
            return StepError::NonFinite { what: "momentum" };
        }
        if !is_finite(advected) {
            return StepError::NonFinite { what: "advected parameter" };
        }
        let solvable =
            |fraction: f64| self.of_step(self.h * fraction).is_ok_and(|part| part.is_solvable(momentum, advected));
        let Some(fraction) = largest_fraction(solvable) else { return error };
        let mut scratch = self.scratch();
        self.aim(momentum, advected, &mut scratch);
        let kicked = &scratch.target[..self.family.sizes.n];
        let velocity = self.family.velocity(&self.numbers, kicked, advected);
        let velocity = velocity.unwrap_or_else(|| self.family.near_rest(&self.numbers, kicked, advected));
        let turning = velocity.iter().enumerate().filter(|(component, _)| self.family.turns(*component));
        let turn = turning.map(|(_, xi)| (xi * self.h) * (xi * self.h)).sum::<f64>().sqrt();
        StepError::BeyondSolvable { step: self.h, largest: six_digits(self.h * fraction), turn, body: None }
    }
}

impl<B: Backend<f64>> Propagator for Whole<B> {
    fn layout(&self) -> &Layout {
        &self.family.layout
    }

    fn start(&self, attitude: &[f64], velocity: &[f64]) -> Result<Box<[f64]>, SetupError> {
        let (family, sizes) = (&self.family, &self.family.sizes);
        for (what, list, expected) in [("attitude", attitude, sizes.entries), ("velocity", velocity, sizes.n)] {
            if list.len() != expected {
                return Err(SetupError::Length { what, found: list.len(), expected });
            }
        }
        if !velocity.iter().all(|number| number.is_finite()) {
            return Err(SetupError::NonFinite { what: "velocity" });
        }
        family.check_attitude(attitude)?;
        let advected = family.seen(&self.numbers, attitude);
        let momentum = family.momentum(&self.numbers, velocity, &advected);
        if !family.declaration.is_quadratic {
            family.check_velocity(velocity, &momentum, (&self.numbers, &advected))?;
        }
        self.start_with_momentum(attitude, &momentum)
    }

    fn step(&self, state: &mut [f64]) -> Result<StepReport, StepError> {
        self.advance(state, &mut self.scratch()).map(StepReport::of)
    }

    fn run(&self, state: &mut [f64], steps: u64) -> Result<u64, StepError> {
        let (mut next, mut scratch, mut iterations) = (state.to_vec(), self.scratch(), 0);
        for _ in 0..steps {
            iterations += u64::from(self.advance(&mut next, &mut scratch)?);
        }
        state.copy_from_slice(&next);
        Ok(iterations)
    }

    fn run_stretches(
        &self,
        state: &mut [f64],
        mut steps: u64,
        next: &mut dyn FnMut(&[f64], f64) -> u64,
    ) -> Result<u64, StepError> {
        let (mut scratch, mut iterations) = (self.scratch(), 0);
        while steps > 0 {
            for _ in 0..steps {
                iterations += u64::from(self.advance(state, &mut scratch)?);
            }
            steps = next(state, self.time(state));
        }
        Ok(iterations)
    }

    fn part(&self, state: &[f64], fraction: f64) -> Result<Box<[f64]>, StepError> {
        let sizes = &self.family.sizes;
        if state.len() != sizes.state() {
            return Err(OF_THIS_LAYOUT);
        }
        let steps = state[sizes.state() - 1];
        let mut next: Box<[f64]> = state.into();
        if fraction.abs() >= f64::EPSILON * f64::EPSILON || fraction.is_nan() {
            let part = self.of_step(self.h * fraction);
            let part = part.map_err(|_| StepError::NonFinite { what: "part of the step" })?;
            let (momentum, advected) =
                (&state[sizes.momentum()..sizes.advected()], &state[sizes.advected()..sizes.history()]);
            part.remember(&mut next, momentum, advected);
            part.advance(&mut next, &mut part.scratch())?;
        }
        let (momentum, advected) =
            (next[sizes.momentum()..sizes.advected()].to_vec(), next[sizes.advected()..sizes.history()].to_vec());
        self.remember(&mut next, &momentum, &advected);
        next[sizes.state() - 1] = steps;
        Ok(next)
    }

    fn adopt(&self, state: &[f64]) -> Box<[f64]> {
        let sizes = &self.family.sizes;
        let (Some(attitude), Some(momentum)) =
            (state.get(..sizes.entries), state.get(sizes.momentum()..sizes.advected()))
        else {
            return vec![f64::NAN; sizes.state()].into();
        };
        self.begun(attitude, momentum, &self.family.seen(&self.numbers, attitude))
    }

    fn step_size(&self) -> f64 {
        self.h
    }

    fn velocity(&self, state: &[f64], velocity: &mut [f64]) {
        let sizes = &self.family.sizes;
        let found = (state.len() >= sizes.history()).then(|| {
            let (momentum, advected) =
                (&state[sizes.momentum()..sizes.advected()], &state[sizes.advected()..sizes.history()]);
            self.family.velocity(&self.numbers, momentum, advected)
        });
        let mut found = found.flatten().into_iter().flatten();
        velocity.fill_with(|| found.next().unwrap_or(f64::NAN));
    }

    fn energy(&self, state: &[f64]) -> f64 {
        let sizes = &self.family.sizes;
        let mut velocity = vec![0.0; sizes.n];
        self.velocity(state, &mut velocity);
        let Some(advected) = state.get(sizes.advected()..sizes.history()) else { return f64::NAN };
        let given =
            [(Array::Velocity, &velocity[..]), (Array::Parameters, &self.numbers[..]), (Array::Advected, advected)];
        self.family.outputs(Name::Energy, &[], given).first().copied().unwrap_or(f64::NAN)
    }

    fn spatial_momentum(&self, state: &[f64], momentum: &mut [f64]) {
        let sizes = &self.family.sizes;
        let found = (state.len() >= sizes.advected()).then(|| {
            let given = [
                (Array::Attitude, &state[..sizes.entries]),
                (Array::Momentum, &state[sizes.momentum()..sizes.advected()]),
            ];
            self.family.outputs(Name::Spatial, &[], given)
        });
        let mut found = found.into_iter().flatten();
        momentum.fill_with(|| found.next().unwrap_or(f64::NAN));
    }

    fn defect(&self, state: &[f64]) -> f64 {
        state.get(..self.family.sizes.entries).map_or(f64::NAN, |attitude| self.family.defect(attitude))
    }
}
