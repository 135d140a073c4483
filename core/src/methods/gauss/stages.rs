//! The stages of a step: fixed-point iteration in pairs that mirror each other.
//!
//! Numbers of one component at all stages lie side by side, so that the compiler puts stages into SIMD lanes.

use super::coefficients::Coefficients;
use super::lift::{Lifted, each};
use crate::error::StepError;
#[cfg(not(feature = "std"))]
use nalgebra::ComplexField as _; // roots and powers

/// A number for each component and each stage: for those of the first half of the step, then for their mirror images.
pub(super) type Numbers<const PAIRS: usize> = [[[f64; PAIRS]; 2]; 8];

/// The `L_j = h b_j f(Y_j)` of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stages<const PAIRS: usize>(pub(super) Numbers<PAIRS>);

/// The equations of motion, as the iteration needs them.
///
/// A trait and not a closure, which wouldn't always be inlined, and then has no lanes.
pub(super) trait WeightedRates {
    /// `h b_j f(Y_j)` of the stage `j` at the place `Y_j`; marked `#[inline(always)]`.
    fn weighted_rate(&self, stage: usize, place: &Lifted) -> Lifted;
}

/// Changes as small as these, relative to the unknowns, may be rounding: the iteration has settled where they don't
/// fall any more.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Where each iteration takes at least a factor of two, which is at the edge of convergence, they are enough.
const MOST_ITERATIONS: u32 = 60;

impl<const PAIRS: usize> Stages<PAIRS> {
    /// Stages at which all rates are the same.
    pub(super) fn constant(change: &Lifted, weights: &[f64; PAIRS]) -> Self {
        Self(change.map(|change| [weights.map(|weight| weight * change); 2]))
    }

    /// The polynomial through these, continued to the stages of the next step.
    #[inline(always)]
    pub(super) fn continued(&self, coefficients: &Coefficients<PAIRS>) -> Self {
        let [from_first, from_second] = &coefficients.continuation;
        let mut next = [[[0.0; PAIRS]; 2]; 8];
        for (next, [first, second]) in next.iter_mut().zip(&self.0) {
            for half in 0..2 {
                next[half] = plus(&applied(&from_first[half], first), &applied(&from_second[half], second));
            }
        }
        Self(next)
    }

    /// `Σ L`, component by component.
    #[inline(always)]
    pub(super) fn change(&self) -> Lifted {
        self.0.map(|[first, second]| total(&plus(&first, &second)))
    }

    /// Iterates from these until they are the stages from `y + carry`; returns how often.
    ///
    /// # Errors
    ///
    /// [`StepError::NotConverged`].
    #[inline(always)]
    pub(super) fn solve(
        &mut self,
        coefficients: &Coefficients<PAIRS>,
        (y, carry): (&Lifted, &Lifted),
        equations: &impl WeightedRates,
    ) -> Result<u32, StepError> {
        let (mut before, mut last) = (0.0, false);
        for iteration in 1..=MOST_ITERATIONS {
            let (next, change) = self.iterated(coefficients, (y, carry), equations);
            *self = next;
            if last {
                return Ok(iteration);
            }
            // What is kept is kept as well as the last change is small. Changes fall by nearly the same factor each
            // time, so that this one's factor tells whether the next change is rounding; that iteration is still made.
            last = change * change <= f64::EPSILON * f64::EPSILON * before;
            if change <= ROUNDING * ROUNDING && change >= before {
                return Ok(iteration);
            }
            before = change;
            if !change.is_finite() {
                return Err(StepError::NotConverged { iterations: iteration, residual: change });
            }
        }
        Err(StepError::NotConverged { iterations: MOST_ITERATIONS, residual: f64::sqrt(before) })
    }

    /// The next iterate, and by how much it differs: the quaternion's stages relative to one and the momentum's to the
    /// momentum, both squared; NaN where anything is.
    #[inline(always)]
    fn iterated(
        &self,
        coefficients: &Coefficients<PAIRS>,
        (y, carry): (&Lifted, &Lifted),
        equations: &impl WeightedRates,
    ) -> (Self, f64) {
        let places = self.places(coefficients, (y, carry));
        let mut next = [[[0.0; PAIRS]; 2]; 8];
        let (mut quaternion, mut momentum) = ([[0.0; PAIRS]; 2], [[0.0; PAIRS]; 2]);
        // One loop over all stages, of which the compiler makes lanes.
        for stage in 0..2 * PAIRS {
            let rate = equations.weighted_rate(stage, &each(|component| places[component].as_flattened()[stage]));
            let squared = each(|component| {
                let difference = rate[component] - self.0[component].as_flattened()[stage];
                difference * difference
            });
            put(&mut next, stage, &rate);
            quaternion.as_flattened_mut()[stage] = (squared[0] + squared[1]) + (squared[2] + squared[3]);
            momentum.as_flattened_mut()[stage] = (squared[4] + squared[5]) + (squared[6] + squared[7]);
        }
        let quaternion = total(&plus(&quaternion[0], &quaternion[1]));
        let momentum = total(&plus(&momentum[0], &momentum[1]));
        // A body at rest has no momentum before the step.
        let size: f64 = (4..8).map(|k| y[k] * y[k] + next[k][0][0] * next[k][0][0]).sum();
        let change = if momentum == 0.0 { quaternion } else { quaternion + momentum / size };
        (Self(next), change)
    }

    /// The places `Y_j` of the stages.
    #[inline(always)]
    fn places(&self, coefficients: &Coefficients<PAIRS>, (y, carry): (&Lifted, &Lifted)) -> Numbers<PAIRS> {
        let (mut sums, mut differences, mut middles) = ([[0.0; PAIRS]; 8], [[0.0; PAIRS]; 8], [0.0; 8]);
        for component in 0..8 {
            let [first, second] = &self.0[component];
            sums[component] = plus(first, second);
            differences[component] = minus(first, second);
            middles[component] = y[component] + (carry[component] + 0.5 * total(&sums[component]));
        }
        let mut places = [[[0.0; PAIRS]; 2]; 8];
        for i in 0..PAIRS {
            let even = each(|component| middles[component] + row(&coefficients.even, i, &differences[component]));
            let odd = each(|component| row(&coefficients.odd, i, &sums[component]));
            put(&mut places, i, &each(|component| even[component] + odd[component]));
            put(&mut places, PAIRS + i, &each(|component| even[component] - odd[component]));
        }
        places
    }
}

/// Puts all components of a stage into their places.
#[inline(always)]
fn put<const PAIRS: usize>(numbers: &mut Numbers<PAIRS>, stage: usize, values: &Lifted) {
    numbers[0].as_flattened_mut()[stage] = values[0];
    numbers[1].as_flattened_mut()[stage] = values[1];
    numbers[2].as_flattened_mut()[stage] = values[2];
    numbers[3].as_flattened_mut()[stage] = values[3];
    numbers[4].as_flattened_mut()[stage] = values[4];
    numbers[5].as_flattened_mut()[stage] = values[5];
    numbers[6].as_flattened_mut()[stage] = values[6];
    numbers[7].as_flattened_mut()[stage] = values[7];
}

/// An entry of the product of a matrix, given by its columns, and `x`.
#[inline(always)]
fn row<const PAIRS: usize>(columns: &[[f64; PAIRS]; PAIRS], i: usize, x: &[f64; PAIRS]) -> f64 {
    let mut sum = columns[0][i] * x[0];
    for k in 1..PAIRS {
        sum += columns[k][i] * x[k];
    }
    sum
}

#[inline(always)]
fn applied<const PAIRS: usize>(columns: &[[f64; PAIRS]; PAIRS], x: &[f64; PAIRS]) -> [f64; PAIRS] {
    let mut product = [0.0; PAIRS];
    for k in 0..PAIRS {
        for i in 0..PAIRS {
            product[i] += columns[k][i] * x[k];
        }
    }
    product
}

#[inline(always)]
fn plus<const PAIRS: usize>(a: &[f64; PAIRS], b: &[f64; PAIRS]) -> [f64; PAIRS] {
    core::array::from_fn(|i| a[i] + b[i])
}

#[inline(always)]
fn minus<const PAIRS: usize>(a: &[f64; PAIRS], b: &[f64; PAIRS]) -> [f64; PAIRS] {
    core::array::from_fn(|i| a[i] - b[i])
}

#[inline(always)]
fn total<const PAIRS: usize>(x: &[f64; PAIRS]) -> f64 {
    x.iter().sum()
}
