//! Newton's iteration for `f(x) = y` with steps that are halved until they help.

use crate::numbers::{Coordinates, Mask, Real, nowhere, real};
use nalgebra::SimdBool as _;

/// More than any regular Lagrangian needs: Newton's iteration doubles the digits, and a halved step is a lost one.
const MOST_ITERATIONS: u32 = 50;
/// A step of `2⁻²⁰` of Newton's is no longer one that the linear model speaks of.
const MOST_HALVINGS: u32 = 20;
/// What rounding leaves of the equation, in units of the scalar's epsilon and of the size of its terms.
const ROUNDINGS: f64 = 1e4;
/// Where the derivative is large, the rounding of the solution itself leaves more of the equation than that. It is solved
/// then, too, if the next step is below this many roundings of the solution.
const ROUNDINGS_OF_SOLUTION: f64 = 4.0;
/// As far as that is believed: this many times what rounding leaves elsewhere. A derivative that has no bound makes steps
/// short wherever the equation is missed.
const AT_MOST: f64 = 1e4;

/// Where [`newton_halving`] ends; of several lanes each goes as it would alone.
pub(crate) struct NewtonEnd<T: Real, V> {
    pub(crate) solution: V,
    /// Whether the equation holds, to rounding.
    pub(crate) is_settled: Mask<T>,
    /// Whether the solution is on the side of the derivative's singularities that zero is on: of two with one value that
    /// one is meant.
    pub(crate) is_regular: Mask<T>,
    pub(crate) iterations: u32,
    /// By how much the equation is missed, relative to its terms.
    pub(crate) residual: T,
}

/// Solves `f(x) = y` from a first solution. The iteration ends where no step helps. `value_of` is `f`, and `derivative_of`
/// its derivative, which is symmetric.
pub(crate) fn newton_halving<T: Real, V: Coordinates<T>>(
    target: &V,
    mut solution: V,
    value_of: impl Fn(&V) -> V,
    derivative_of: impl Fn(&V) -> V::Square,
) -> NewtonEnd<T, V> {
    let defect_at = |solution: &V| *target - value_of(solution);
    let (zero, first) = (V::zero(), defect_at(&V::zero()));
    // Where the first step leaves the domain of `f`, the iteration begins at zero.
    let mut defect = defect_at(&solution);
    let starts = defect.dot(&defect).simd_le(first.dot(&first));
    solution = solution.select(starts, zero);
    defect = defect.select(starts, first);
    // The terms that cancel: the target, and what there is of it at zero and at the first solution.
    let bias = *target - first;
    let terms = target.dot(target) + bias.dot(&bias) + (*target - defect).dot(&(*target - defect));
    let allowed = T::simd_default_epsilon() * real(ROUNDINGS);
    let bound = terms * allowed * allowed;
    let half = real::<T>(0.5);
    let mut iterations = 0;
    while iterations < MOST_ITERATIONS {
        let size = defect.dot(&defect);
        // Near rounding a step that doesn't help ends it; farther away it is too long.
        let is_near = size.simd_le(bound);
        let step = V::solve(&derivative_of(&solution), &defect).0;
        let (mut fraction, mut next, mut next_defect) = (real::<T>(1.0), solution, defect);
        let mut helped = nowhere::<T>();
        let mut tried = helped;
        for _ in 0..MOST_HALVINGS {
            let candidate = solution + step * fraction;
            let candidate_defect = defect_at(&candidate);
            let helps = candidate_defect.dot(&candidate_defect).simd_lt(size) & !tried;
            next = candidate.select(helps, next);
            next_defect = candidate_defect.select(helps, next_defect);
            helped = helped | helps;
            tried = helped | is_near;
            if tried.all() {
                break;
            }
            fraction *= half;
        }
        (solution, defect) = (next, next_defect);
        iterations += 1;
        if helped.none() {
            break;
        }
    }
    let residual = defect.dot(&defect);
    let step = V::solve(&derivative_of(&solution), &defect).0;
    let rounding = T::simd_default_epsilon() * real(ROUNDINGS_OF_SOLUTION);
    let is_rounded = step.dot(&step).simd_le(solution.dot(&solution) * rounding * rounding);
    let is_settled = residual.simd_le(bound) | (is_rounded & residual.simd_le(bound * real(AT_MOST * AT_MOST)));
    let sign = |solution: &V| V::least_pivot(&derivative_of(solution)).0;
    let is_lost = sign(&zero).simd_gt(real(0.0)) & sign(&solution).simd_le(real(0.0));
    NewtonEnd { solution, is_settled, is_regular: !is_lost, iterations, residual: (residual / terms).simd_sqrt() }
}
