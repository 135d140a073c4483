//! Derivatives of a step by the state before it, column by column.

use std::sync::Arc;

use liestep::StepError;
use liestep_derivation::Array;
use liestep_derivation::whole::{Sizes, WholeStep};

use super::composed::Stages;
use super::constants::StepConstants;
use super::linear::are_finite;
use super::step::StepCodes;
use crate::code::Backend;
use crate::declaration::{Declaration, Ready, ready_each};
use crate::error::LateError;

/// The code of the tangent map along one direction.
#[derive(Debug)]
pub(super) struct TangentCode<B: Backend<f64>>(Ready<B::Code>);

impl<B: Backend<f64>> TangentCode<B> {
    /// The code of a declaration's tangent map, written and prepared once.
    pub(super) fn of(declaration: &'static Declaration) -> Result<Arc<Self>, LateError> {
        declaration.once(|| {
            let program = WholeStep::tangent(declaration).map_err(LateError::Step)?;
            let code = ready_each::<B>(&[&program])?.pop();
            code.map(Self).ok_or(LateError::TooLarge)
        })
    }

    /// Applies the tangent map of a stage to columns of `(ζ, δμ)`; the states are those before and after it.
    pub(super) fn apply(
        &self,
        sizes: &Sizes,
        constants: &StepConstants,
        (before, after): (&[f64], &[f64]),
        columns: &mut [f64],
    ) {
        let n = sizes.n;
        let mut made = vec![0.0; 2 * n];
        for column in columns.chunks_exact_mut(2 * n) {
            let given = [
                (Array::Half, &after[sizes.history()..sizes.history() + n]),
                (Array::Momentum, &before[sizes.momentum()..sizes.advected()]),
                (Array::Advected, &before[sizes.advected()..sizes.history()]),
                (Array::Velocity, &column[..n]),
                (Array::History, &column[n..]),
            ];
            B::run(&self.0.code, &constants.numbers, given, &mut made);
            column.copy_from_slice(&made);
        }
    }
}

impl Stages {
    /// Makes a step, and returns the derivatives of the state after it, `(ζ⁺, δμ⁺)`, by `(ζ, δμ)`: column by column, each of
    /// `2n` numbers. After an error the state is as it was.
    pub(super) fn transition<B: Backend<f64>>(
        &self,
        numbered: StepCodes<'_, B>,
        tangent: &TangentCode<B>,
        state: &mut [f64],
        room: &mut [f64],
    ) -> Result<Vec<f64>, StepError> {
        let (sizes, mut next) = (&numbered.codes.sizes, state.to_vec());
        let count = 2 * sizes.n;
        let mut columns: Vec<f64> = (0..count * count).map(|at| f64::from(u8::from(at % (count + 1) == 0))).collect();
        let mut before = Vec::new();
        let mut watch = |constants: &StepConstants, after: &[f64]| {
            if before.is_empty() {
                before.extend_from_slice(after);
                return;
            }
            tangent.apply(sizes, constants, (&before, after), &mut columns);
            before.clear();
        };
        self.watched(numbered, &mut next, room, &mut watch)?;
        if !are_finite(&columns) {
            return Err(StepError::NonFinite { what: "derivative" });
        }
        state.copy_from_slice(&next);
        Ok(columns)
    }
}
