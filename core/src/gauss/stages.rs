//! The stages of a step: fixed-point iteration in pairs that mirror each other.
//!
//! Numbers of one component at all stages lie side by side, so that the compiler puts stages into SIMD lanes.

use super::coefficients::Coefficients;
use super::lift::Lifted;
use crate::error::StepError;

/// A number for each component and each pair of stages.
type Half<const PAIRS: usize> = [[f64; PAIRS]; 8];

/// The `L_j = h b_j f(Y_j)` of a step: those of the first half of the stages, and those of their mirror images.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stages<const PAIRS: usize> {
    first: Half<PAIRS>,
    second: Half<PAIRS>,
}

/// Relative to the unknowns: a quarter of a unit in the last place.
const SETTLED: f64 = 0.25 * f64::EPSILON;

/// Changes as small as these may be rounding: the iteration has settled where they don't fall any more.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Where each iteration takes at least a factor of two, which is at the edge of convergence, they are enough.
const MOST_ITERATIONS: u32 = 60;

impl<const PAIRS: usize> Stages<PAIRS> {
    /// Stages at which all rates are the same.
    pub(super) fn constant(change: &Lifted, weights: &[f64; PAIRS]) -> Self {
        let half = change.map(|change| weights.map(|weight| weight * change));
        Self { first: half, second: half }
    }

    /// The polynomial through these, continued to the stages of the next step.
    #[inline(always)]
    pub(super) fn continued(&self, coefficients: &Coefficients<PAIRS>) -> Self {
        let [[first_first, first_second], [second_first, second_second]] = &coefficients.continuation;
        let mut next = Self { first: [[0.0; PAIRS]; 8], second: [[0.0; PAIRS]; 8] };
        for component in 0..8 {
            let (first, second) = (&self.first[component], &self.second[component]);
            next.first[component] = plus(&applied(first_first, first), &applied(second_first, second));
            next.second[component] = plus(&applied(first_second, first), &applied(second_second, second));
        }
        next
    }

    /// `Σ L`, component by component.
    #[inline(always)]
    pub(super) fn change(&self) -> Lifted {
        core::array::from_fn(|component| total(&plus(&self.first[component], &self.second[component])))
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
        weighted_rate: impl Fn(&Half<PAIRS>) -> Half<PAIRS>,
    ) -> Result<u32, StepError> {
        let mut before = f64::INFINITY;
        for iteration in 1..=MOST_ITERATIONS {
            let (mut first, mut second) = ([[0.0; PAIRS]; 8], [[0.0; PAIRS]; 8]);
            for component in 0..8 {
                let (one, other) = (&self.first[component], &self.second[component]);
                let sum = plus(one, other);
                let middle = y[component] + (carry[component] + 0.5 * total(&sum));
                let even = applied(&coefficients.even, &minus(one, other)).map(|even| middle + even);
                let odd = applied(&coefficients.odd, &sum);
                first[component] = plus(&even, &odd);
                second[component] = minus(&even, &odd);
            }
            let next = Self { first: weighted_rate(&first), second: weighted_rate(&second) };
            let change = next.distance(self, y);
            *self = next;
            if change <= SETTLED * SETTLED || (change <= ROUNDING * ROUNDING && change >= before) {
                return Ok(iteration);
            }
            before = change;
            if !change.is_finite() {
                return Err(StepError::NotConverged { iterations: iteration, residual: change });
            }
        }
        Err(StepError::NotConverged { iterations: MOST_ITERATIONS, residual: before.sqrt() })
    }

    /// The difference, that of the quaternion's stages relative to one and that of its momentum's to the momentum, both
    /// squared; NaN where anything is.
    #[inline(always)]
    fn distance(&self, other: &Self, y: &Lifted) -> f64 {
        let squared = |component: usize| {
            let first = minus(&self.first[component], &other.first[component]);
            let second = minus(&self.second[component], &other.second[component]);
            plus(&first.map(|x| x * x), &second.map(|x| x * x))
        };
        let block = |from: usize| total(&(from + 1..from + 4).fold(squared(from), |sum, k| plus(&sum, &squared(k))));
        let (quaternion, momentum) = (block(0), block(4));
        // A body at rest has no momentum before the step.
        let size: f64 = (4..8).map(|k| y[k] * y[k] + self.first[k][0] * self.first[k][0]).sum();
        if momentum == 0.0 { quaternion } else { quaternion + momentum / size }
    }
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
