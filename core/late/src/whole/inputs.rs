//! Steps with inputs: forces and other values of parameters, and the derivatives of a step by state and force.

use std::sync::Arc;

use liestep::__private::forced;
use liestep::motion::{Propagator, StepReport};
use liestep::{SetupError, StepError};

use super::limit::Limit;
use super::stepper::Whole;
use super::tangent::TangentCode;
use crate::code::Backend;

/// The derivatives of the state after a step, `(ζ⁺, δμ⁺) = A (ζ, δμ) + B δf`, by the state before it and by the force.
///
/// The coordinates on the group are those of `g exp ζ̂`, on SO(3) radians about the body's axes at either end of the step;
/// those of the momentum are its components in the body frame. For a group of `n` dimensions both matrices have `2n` rows,
/// and stand column by column.
#[derive(Clone, Debug, PartialEq)]
pub struct Transition {
    /// `A`: `n` columns along displacements, then `n` by the momentum.
    pub by_state: Vec<f64>,
    /// `B`: `n` columns by the force.
    pub by_force: Vec<f64>,
}

impl<B: Backend<f64>> Whole<B> {
    /// Makes one step with other numbers for the parameters, such as prescribed forces or moving values in space; between
    /// the steps the state has this stepper's own values again. On an error the state is unchanged.
    ///
    /// Numbers that are evaluated in the middle of each step leave the scheme of second order.
    ///
    /// # Errors
    ///
    /// The errors of [`step`](Propagator::step); [`StepError::NonFinite`] if the numbers can't be used.
    pub fn step_with(&self, state: &mut [f64], numbers: &[f64]) -> Result<StepReport, StepError> {
        let mut next = self.checked(state)?.to_vec();
        let driven =
            self.with(numbers, self.h).map_err(|_| StepError::NonFinite { what: "value given to the step" })?;
        driven.see(&mut next);
        let report = driven.step(&mut next)?;
        self.see(&mut next);
        state.copy_from_slice(&next);
        Ok(report)
    }

    /// Takes other numbers for the parameters, and another step `h`, s; constants of a step that depend on nothing that changes
    /// aren't folded anew. States have values in space as they were: [`adopt`](Propagator::adopt) them where one is another.
    ///
    /// # Errors
    ///
    /// The errors of [`with`](Self::with), after which the stepper is as it was.
    pub fn take(&mut self, numbers: &[f64], h: f64) -> Result<(), SetupError> {
        SetupError::check_length("parameters", numbers.len(), self.numbers.len())?;
        let is_known = |(at, folds): (usize, &bool)| !folds || self.numbers[at].to_bits() == numbers[at].to_bits();
        if self.h.to_bits() != h.to_bits() || !self.codes.folds.iter().enumerate().all(is_known) {
            *self = self.with(numbers, h)?;
            return Ok(());
        }
        self.declaration().check(numbers)?;
        match Arc::get_mut(&mut self.numbers) {
            Some(own) => own.copy_from_slice(numbers),
            None => self.numbers = numbers.into(),
        }
        Ok(())
    }

    /// The body velocity of a state with other [numbers](Self::numbers) for the parameters; NaN where there is none.
    #[must_use]
    pub fn velocity_with(&self, state: &[f64], numbers: &[f64]) -> Vec<f64> {
        let found = self.limited(state, numbers).map(|(limit, momentum)| limit.velocity(momentum));
        found.unwrap_or_else(|| vec![f64::NAN; self.codes.sizes.n])
    }

    /// The energy of a state with other [numbers](Self::numbers) for the parameters, in the declaration's unit; NaN where there
    /// is none.
    #[must_use]
    pub fn energy_with(&self, state: &[f64], numbers: &[f64]) -> f64 {
        let energy = |(limit, momentum): (Limit<'_, B>, &[f64])| limit.energy(&limit.velocity(momentum));
        self.limited(state, numbers).map_or(f64::NAN, energy)
    }

    /// The continuous limit and the momentum at a state; none for slices of other lengths.
    fn limited<'s>(&'s self, state: &'s [f64], numbers: &'s [f64]) -> Option<(Limit<'s, B>, &'s [f64])> {
        let (sizes, codes) = (&self.codes.sizes, &*self.codes);
        let state = self.checked(state).ok().filter(|_| numbers.len() == self.numbers.len())?;
        let limit = Limit { codes, numbers, advected: &state[sizes.advected()..sizes.history()] };
        Some((limit, &state[sizes.momentum()..sizes.advected()]))
    }

    /// Makes one step with a constant force, as [`step_forced`](Propagator::step_forced), and returns the derivatives of the state
    /// after it by the state before it and by the force, as [`Transition`]. On an error the state is unchanged. The
    /// first call for a declaration writes the code of its tangent map.
    ///
    /// # Errors
    ///
    /// The errors of [`step_forced`](Propagator::step_forced), without remedies by substeps; [`StepError::NonFinite`] if a
    /// derivative overflows, or has too long a code.
    pub fn transition(&self, state: &mut [f64], force: &[f64]) -> Result<Transition, StepError> {
        let unknown = |_| StepError::NonFinite { what: "derivative" };
        let (n, tangent) = (self.codes.sizes.n, TangentCode::<B>::of(self.declaration()).map_err(unknown)?);
        let by_state = forced(self.layout(), state, (force, self.h), |next| {
            self.in_room(|room| self.stages.transition(self.numbered(), &tangent, next, room))
        })?;
        // `B = h/2 (A_μ + (0, I))`
        let half = self.h * 0.5;
        let impulse = |at: usize| f64::from(u8::from(at % (2 * n) == n + at / (2 * n)));
        let by_momentum = by_state.iter().skip(2 * n * n).enumerate();
        let by_force = by_momentum.map(|(at, entry)| (entry + impulse(at)) * half).collect();
        Ok(Transition { by_state, by_force })
    }
}
