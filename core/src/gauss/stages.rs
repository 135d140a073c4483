//! The stages of a step: fixed-point iteration in pairs that mirror each other.
//!
//! Numbers of one component at all stages lie side by side, so that the compiler puts stages into SIMD lanes.

use super::coefficients::Coefficients;
use super::lift::Lifted;
use crate::error::StepError;

/// A number for each component and each stage: for those of the first half of the step, then for their mirror images.
pub(super) type Numbers<const PAIRS: usize> = [[[f64; PAIRS]; 2]; 8];

/// The `L_j = h b_j f(Y_j)` of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stages<const PAIRS: usize>(Numbers<PAIRS>);

/// Changes as small as these, relative to the unknowns, may be rounding: the iteration has settled where they don't fall
/// any more.
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
        weighted_rates: impl Fn(&Numbers<PAIRS>) -> Numbers<PAIRS>,
    ) -> Result<u32, StepError> {
        let (mut before, mut last) = (0.0, false);
        for iteration in 1..=MOST_ITERATIONS {
            let mut places = [[[0.0; PAIRS]; 2]; 8];
            for component in 0..8 {
                let [first, second] = &self.0[component];
                let sum = plus(first, second);
                let middle = y[component] + (carry[component] + 0.5 * total(&sum));
                let even = applied(&coefficients.even, &minus(first, second)).map(|even| middle + even);
                let odd = applied(&coefficients.odd, &sum);
                places[component] = [plus(&even, &odd), minus(&even, &odd)];
            }
            let next = Self(weighted_rates(&places));
            if last {
                *self = next;
                return Ok(iteration);
            }
            let change = next.distance(self, y);
            *self = next;
            // What is kept is kept as well as the last change is small. Changes fall by nearly the same factor each time,
            // so that this one's factor tells whether the next change is rounding; that iteration is still made.
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

    /// The difference, that of the quaternion's stages relative to one and that of its momentum's to the momentum, both
    /// squared; NaN where anything is.
    #[inline(always)]
    fn distance(&self, other: &Self, y: &Lifted) -> f64 {
        let squared = |component: usize| {
            let ([first, second], [before_first, before_second]) = (&self.0[component], &other.0[component]);
            let (first, second) = (minus(first, before_first), minus(second, before_second));
            plus(&first.map(|x| x * x), &second.map(|x| x * x))
        };
        let block = |from: usize| total(&(from + 1..from + 4).fold(squared(from), |sum, k| plus(&sum, &squared(k))));
        let (quaternion, momentum) = (block(0), block(4));
        // A body at rest has no momentum before the step.
        let size: f64 = (4..8).map(|k| y[k] * y[k] + self.0[k][0][0] * self.0[k][0][0]).sum();
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
