//! Newton's iteration for `f(x) = y` with steps that are halved until the residual falls.

use crate::numbers::{Coordinates, Mask, Real, nowhere, real};
use nalgebra::SimdBool as _;

/// Limit of the iterations. No regular Lagrangian needs as many: Newton's iteration doubles the digits, and a halved
/// step gains none.
pub const MOST_ITERATIONS: u32 = 50;
/// Limit of the halvings of a step: `2⁻²⁰` of Newton's step is too short for the linear model to predict.
pub const MOST_HALVINGS: u32 = 20;
/// Rounding of the residual, in units of the scalar's epsilon and of the size of its terms.
pub const ROUNDINGS: f64 = 1e4;
/// Second criterion of convergence: the next step is below this many roundings of the solution. If the derivative is
/// large, the rounding of the solution leaves a residual above the first criterion.
pub const ROUNDINGS_OF_SOLUTION: f64 = 4.0;
/// Limit of the second criterion: the residual is at most this many times the first one. A derivative without a bound
/// makes steps short wherever the equation is violated.
pub const AT_MOST: f64 = 1e4;

/// The end of [`newton_halving`]; each of several lanes ends as it would alone.
pub(crate) struct NewtonEnd<T: Real, V> {
    pub(crate) solution: V,
    /// Whether the equation holds, to rounding.
    pub(crate) is_settled: Mask<T>,
    /// Whether the solution is on the same side of the derivative's singularities as zero. If two solutions have the
    /// same value, that one is wanted.
    pub(crate) is_regular: Mask<T>,
    pub(crate) iterations: u32,
    /// The residual of the equation, relative to its terms.
    pub(crate) residual: T,
}

/// Solves `f(x) = y` from an initial guess. The iteration ends if no step reduces the residual. `value_of` is `f`, and
/// `derivative_of` its derivative, which is symmetric.
pub(crate) fn newton_halving<T: Real, V: Coordinates<T>>(
    target: &V,
    mut solution: V,
    value_of: impl Fn(&V) -> V,
    derivative_of: impl Fn(&V) -> V::Square,
) -> NewtonEnd<T, V> {
    let defect_at = |solution: &V| *target - value_of(solution);
    let (zero, first) = (V::zero(), defect_at(&V::zero()));
    // Begins at zero if the guess has the larger residual, or is outside of the domain of `f`.
    let mut defect = defect_at(&solution);
    let starts = defect.dot(&defect).simd_le(first.dot(&first));
    solution = solution.select(starts, zero);
    defect = defect.select(starts, first);
    // The terms that cancel: the target, and its parts at zero and at the initial guess.
    let bias = *target - first;
    let terms = target.dot(target) + bias.dot(&bias) + (*target - defect).dot(&(*target - defect));
    let allowed = T::simd_default_epsilon() * real(ROUNDINGS);
    let bound = terms * allowed * allowed;
    let half = real::<T>(0.5);
    let mut iterations = 0;
    while iterations < MOST_ITERATIONS {
        let size = defect.dot(&defect);
        // Near rounding a step that doesn't help ends the iteration; farther away it is too long.
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
