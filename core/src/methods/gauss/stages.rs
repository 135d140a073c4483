//! The stages of a step, by fixed-point iteration.
//!
//! A component's values at all stages are contiguous, so that the compiler vectorises over stages.

use super::coefficients::{Coefficients, Columns, OfStages};
use super::lift::{Lift, PhasePoint};
use super::settling::{Changes, MOST_ITERATIONS, Next};
use crate::error::StepError;
use crate::mechanics::RigidScene;
roots!();

/// One number per component and stage.
pub(super) type Numbers<const PAIRS: usize> = [OfStages<PAIRS>; 8];

/// One value per component, without a loop: the compiler would vectorise that loop instead of the one over stages.
#[inline(always)]
fn each<T>(value: impl Fn(usize) -> T) -> [T; 8] {
    [value(0), value(1), value(2), value(3), value(4), value(5), value(6), value(7)]
}

/// The increments `L_j = h b_j f(Y_j)` of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stages<const PAIRS: usize>(pub(super) Numbers<PAIRS>);

/// The equations of motion, and the weights `h b_j` of the stages.
pub(super) type Equations<'a, L, const PAIRS: usize> = (&'a Lift<L>, &'a OfStages<PAIRS>);

impl<const PAIRS: usize> Stages<PAIRS> {
    /// Increments with all stages at one point.
    pub(super) fn constant<L: RigidScene<Scalar = f64>>(
        place: &PhasePoint,
        (lift, weights): Equations<'_, L, PAIRS>,
    ) -> Self {
        let mut stages = [[[0.0; PAIRS]; 2]; 8];
        for stage in 0..2 * PAIRS {
            put(&mut stages, stage, &lift.weighted_rate(place, weights.as_flattened()[stage]));
        }
        Self(stages)
    }

    /// The interpolating polynomial of these stages, extrapolated to the stages of the next step.
    #[inline(always)]
    pub(super) fn continued(&self, coefficients: &Coefficients<PAIRS>) -> Self {
        let mut next = [[[0.0; PAIRS]; 2]; 8];
        for stage in 0..2 * PAIRS {
            put(&mut next, stage, &each(|component| entry(&coefficients.continuation, stage, &self.0[component])));
        }
        Self(next)
    }

    /// The increment `Σ L` of the step.
    #[inline(always)]
    pub(super) fn change(&self) -> PhasePoint {
        each(|component| total(&self.0[component]))
    }

    /// Iterates from these stages to those of a step from `y + carry`; returns the number of iterations.
    ///
    /// # Errors
    ///
    /// [`StepError::NotConverged`].
    #[inline(always)]
    pub(super) fn solve<L: RigidScene<Scalar = f64>>(
        &mut self,
        coefficients: &Coefficients<PAIRS>,
        (y, carry): (&PhasePoint, &PhasePoint),
        equations: Equations<'_, L, PAIRS>,
    ) -> Result<u32, StepError> {
        // A body at rest has no momentum before the step. A size too small to invert is ignored.
        let size: f64 = (4..8).map(|k| y[k] * y[k] + self.0[k][0][0] * self.0[k][0][0]).sum();
        let over_size = if (1.0 / size).is_finite() { 1.0 / size } else { 0.0 };
        let (mut changes, mut last, mut residual) = (Changes::none(), false, f64::INFINITY);
        for iteration in 1..=MOST_ITERATIONS {
            let (next, [of_attitude, change]) = self.iterated(coefficients, (y, carry), over_size, equations);
            let judged = changes.judge(change, of_attitude);
            *self = next;
            if last || judged == Next::Nothing {
                return Ok(iteration);
            }
            last = judged == Next::Once;
            residual = change.sqrt();
            if !change.is_finite() {
                return Err(StepError::NotConverged { iterations: iteration, residual });
            }
        }
        Err(StepError::NotConverged { iterations: MOST_ITERATIONS, residual })
    }

    /// The next iterate, and two squared changes: that of the quaternion's stages, relative to one, and the sum of this
    /// and that of the momentum's stages, relative to the momentum. They are NaN if any number is. They are computed
    /// here, because a function that takes a reference to the iterate would force it to memory, and each iteration
    /// would wait for it.
    #[inline(always)]
    fn iterated<L: RigidScene<Scalar = f64>>(
        &self,
        coefficients: &Coefficients<PAIRS>,
        (y, carry): (&PhasePoint, &PhasePoint),
        over_size: f64,
        (lift, weights): Equations<'_, L, PAIRS>,
    ) -> (Self, [f64; 2]) {
        let mut next = [[[0.0; PAIRS]; 2]; 8];
        let mut changes = [[[0.0; PAIRS]; 2]; 2];
        // The only loop over stages, which the compiler vectorises.
        for stage in 0..2 * PAIRS {
            let places = each(|component| {
                y[component] + (carry[component] + entry(&coefficients.places, stage, &self.0[component]))
            });
            let rate = lift.weighted_rate(&places, weights.as_flattened()[stage]);
            let squared = each(|component| {
                let difference = rate[component] - self.0[component].as_flattened()[stage];
                difference * difference
            });
            put(&mut next, stage, &rate);
            let quaternion = (squared[0] + squared[1]) + (squared[2] + squared[3]);
            let momentum = (squared[4] + squared[5]) + (squared[6] + squared[7]);
            changes[0].as_flattened_mut()[stage] = quaternion;
            changes[1].as_flattened_mut()[stage] = quaternion + momentum * over_size;
        }
        (Self(next), changes.map(|change| total(&change)))
    }
}

/// Stores all components of a stage.
#[inline(always)]
fn put<const PAIRS: usize>(numbers: &mut Numbers<PAIRS>, stage: usize, values: &PhasePoint) {
    numbers[0].as_flattened_mut()[stage] = values[0];
    numbers[1].as_flattened_mut()[stage] = values[1];
    numbers[2].as_flattened_mut()[stage] = values[2];
    numbers[3].as_flattened_mut()[stage] = values[3];
    numbers[4].as_flattened_mut()[stage] = values[4];
    numbers[5].as_flattened_mut()[stage] = values[5];
    numbers[6].as_flattened_mut()[stage] = values[6];
    numbers[7].as_flattened_mut()[stage] = values[7];
}

/// An entry of the product of a matrix and the vector `x`.
#[inline(always)]
fn entry<const PAIRS: usize>(columns: &Columns<PAIRS>, row: usize, x: &OfStages<PAIRS>) -> f64 {
    let half = |side: usize| {
        let (columns, x) = (&columns[side], &x[side]);
        let mut sum = columns[0].as_flattened()[row] * x[0];
        for k in 1..PAIRS {
            sum += columns[k].as_flattened()[row] * x[k];
        }
        sum
    };
    half(0) + half(1)
}

/// The sum over all stages.
#[inline(always)]
fn total<const PAIRS: usize>([first, second]: &OfStages<PAIRS>) -> f64 {
    first.iter().zip(second).map(|(first, second)| first + second).sum()
}
