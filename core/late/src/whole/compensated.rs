//! Compensated sums on any group: what rounding takes from attitude, momentum and advected parameters is added to their next
//! changes.

use std::sync::Arc;

use liestep::__private::TOLERATED;
use liestep::motion::{Cost, Layout, Propagator, StepReport};
use liestep::numbers::two_sum;
use liestep::with::Method;
use liestep::{SetupError, StepError};
use liestep_derivation::Array;
use liestep_derivation::whole::WholeStep;

use super::codes::rare;
use super::constants::StepConstants;
use super::step::StepCodes;
use super::stepper::{Whole, WholeError};
use crate::code::Backend;
use crate::declaration::{Declaration, Ready, ready_each};
use crate::error::LateError;

/// The code of the changes in a step.
#[derive(Debug)]
struct Changes<C>(Ready<C>);

/// A stepper with compensated sums. The rounding errors of a state's attitude, momentum and advected parameters stand in its
/// memory, behind that of [`Whole`].
#[derive(Debug)]
pub(super) struct CompensatedSums<B: Backend<f64>> {
    whole: Whole<B>,
    changes: Arc<Changes<B::Code>>,
    layout: Layout,
}

impl<B: Backend<f64>> CompensatedSums<B> {
    /// The stepper of a declaration by its step or a composition, as [`Whole::of`].
    pub(super) fn of(
        declaration: &'static Declaration,
        numbers: &[f64],
        h: f64,
        method: Method,
    ) -> Result<Self, WholeError> {
        if method.substeps > 1 {
            let cause = "has compensated sums on SO3 alone where steps are divided: take `compensated` or `substeps`";
            return Err(SetupError::Method { cause }.into());
        }
        let whole = Whole::of(declaration, numbers, h, Method { compensated: false, ..method })?;
        let changes = declaration.once(|| {
            let program = WholeStep::changes(declaration).map_err(LateError::Step)?;
            ready_each::<B>(&[&program])?.pop().map(Changes).ok_or(LateError::TooLarge)
        })?;
        let mut layout = whole.codes.layout.clone();
        layout.memory += changes.0.outputs;
        Ok(Self { whole, changes, layout })
    }

    /// The state of [`Whole`], and the rounding errors.
    fn parts(&self, state: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let place = self.whole.codes.sizes.state() - 1;
        let (inner, rest) = state.split_at(place);
        let (errors, steps) = rest.split_at(self.changes.0.outputs);
        ([inner, steps].concat(), errors.to_vec())
    }

    fn state(inner: &[f64], errors: &[f64]) -> Box<[f64]> {
        let (before, steps) = inner.split_at(inner.len() - 1);
        [before, errors, steps].concat().into()
    }

    fn without_errors(&self, inner: &[f64]) -> Box<[f64]> {
        Self::state(inner, &vec![0.0; self.changes.0.outputs])
    }

    /// The number that a function has of the state of [`Whole`]; NaN of a state of another length.
    fn number(&self, state: &[f64], of: impl FnOnce(&[f64]) -> f64) -> f64 {
        self.layout.checked(state).map_or(f64::NAN, |state| of(&self.parts(state).0))
    }

    /// Sums the changes of a stage and the rounding errors anew, in the state after it.
    fn sum(&self, constants: &StepConstants, before: &[f64], next: &mut [f64], errors: &mut [f64]) {
        let (codes, sizes) = (&*self.whole.codes, &self.whole.codes.sizes);
        let own = [
            (Array::Momentum, &before[sizes.momentum()..sizes.advected()]),
            (Array::Advected, &before[sizes.advected()..sizes.history()]),
        ];
        let target = rare::<B>(&codes.code.target, &constants.numbers, own);
        let given = [
            own[0],
            own[1],
            (Array::Attitude, &before[..sizes.entries]),
            (Array::Half, &next[sizes.history()..sizes.history() + sizes.n]),
            (Array::Target, &target[..sizes.n]),
            (Array::Factors, &errors[sizes.advected()..]),
        ];
        let mut changes = vec![0.0; self.changes.0.outputs];
        B::run(&self.changes.0.code, &constants.numbers, given, &mut changes);
        for (at, change) in changes.into_iter().enumerate() {
            (next[at], errors[at]) = two_sum(before[at], change + errors[at]);
        }
    }
}

impl<B: Backend<f64>> Propagator for CompensatedSums<B> {
    fn layout(&self) -> &Layout {
        &self.layout
    }

    fn start(&self, attitude: &[f64], velocity: &[f64]) -> Result<Box<[f64]>, SetupError> {
        Ok(self.without_errors(&self.whole.start(attitude, velocity)?))
    }

    fn step(&self, state: &mut [f64]) -> Result<StepReport, StepError> {
        let (mut inner, mut errors) = self.parts(self.layout.checked(state)?);
        let (whole, sizes) = (&self.whole, &self.whole.codes.sizes);
        // Rounding errors that are carried keep several attitudes near their groups, too.
        let numbered = StepCodes { tolerated: TOLERATED, ..whole.numbered() };
        let mut room = vec![0.0; whole.room()];
        let mut attitude = inner[..sizes.entries].to_vec();
        let mut make = |constants: &StepConstants, next: &mut [f64], room: &mut [f64]| {
            let before = next.to_vec();
            let made = numbered.increment(constants, next, room)?;
            self.sum(constants, &before, next, &mut errors);
            attitude.copy_from_slice(&next[..sizes.entries]);
            Ok(made)
        };
        let made = match whole.stages.single() {
            Some(constants) => make(constants, &mut inner, &mut room).map(|made| numbered.count(made, &mut inner)),
            None => whole.stages.each(numbered, &mut inner, &mut room, &mut |stage, next, room| {
                make(whole.stages.constants(stage), next, room)
            }),
        };
        let iterations = made.map_err(|error| whole.explained(&inner, error))?;
        // A restored attitude has no rounding error, and neither has what is seen from it.
        if attitude.iter().zip(&inner).any(|(summed, now)| summed.to_bits() != now.to_bits()) {
            errors[..sizes.entries].fill(0.0);
            errors[sizes.advected()..].fill(0.0);
        }
        state.copy_from_slice(&Self::state(&inner, &errors));
        Ok(StepReport::of(iterations))
    }

    fn part(&self, state: &[f64], fraction: f64) -> Result<Box<[f64]>, StepError> {
        let (inner, _) = self.parts(self.layout.checked(state)?);
        Ok(self.without_errors(&self.whole.part(&inner, fraction)?))
    }

    fn adopt(&self, state: &[f64]) -> Box<[f64]> {
        self.without_errors(&self.whole.adopt(state))
    }

    fn cost(&self) -> Option<Cost> {
        self.whole.cost()
    }

    fn step_size(&self) -> f64 {
        self.whole.step_size()
    }

    fn velocity(&self, state: &[f64], velocity: &mut [f64]) {
        let inner = self.layout.checked(state).map_or_else(|_| Vec::new(), |state| self.parts(state).0);
        self.whole.velocity(&inner, velocity);
    }

    fn energy(&self, state: &[f64]) -> f64 {
        self.number(state, |inner| self.whole.energy(inner))
    }

    fn spatial_momentum(&self, state: &[f64], momentum: &mut [f64]) {
        let inner = self.layout.checked(state).map_or_else(|_| Vec::new(), |state| self.parts(state).0);
        self.whole.spatial_momentum(&inner, momentum);
    }

    fn defect(&self, state: &[f64]) -> f64 {
        self.number(state, |inner| self.whole.defect(inner))
    }
}
