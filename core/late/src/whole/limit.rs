//! The continuous limit of a declaration at an attitude: momenta and their velocities, the inertia, the energy.

use liestep::__private::NonholonomicCheck;
use liestep::__private::velocity::{AT_MOST, MOST_HALVINGS, MOST_ITERATIONS, ROUNDINGS, ROUNDINGS_OF_SOLUTION};
use liestep::SetupError;
use liestep_derivation::Array;

use super::codes::{Codes, rare};
use super::linear::{Pivots, are_finite, dot, solution};
use crate::code::Backend;
use crate::declaration::Ready;

/// The continuous limit `l(ξ, w)`.
pub(super) struct Limit<'a, B: Backend<f64>> {
    pub(super) codes: &'a Codes<B>,
    pub(super) numbers: &'a [f64],
    pub(super) advected: &'a [f64],
}

impl<B: Backend<f64>> Limit<'_, B> {
    pub(super) fn of(&self, program: &Ready<B::Code>, array: Array, value: &[f64]) -> Vec<f64> {
        let mut outputs = vec![0.0; program.outputs];
        let given = [(array, value), (Array::Parameters, self.numbers), (Array::Advected, self.advected)];
        B::run(&program.code, &[], given, &mut outputs);
        outputs
    }

    /// The momentum `∂l/∂ξ`.
    pub(super) fn momentum(&self, velocity: &[f64]) -> Vec<f64> {
        self.of(&self.codes.code.momentum, Array::Velocity, velocity)
    }

    /// The inertia at rest, row by row.
    pub(super) fn inertia(&self) -> Vec<f64> {
        let given = [(Array::Parameters, self.numbers), (Array::Advected, self.advected)];
        rare::<B>(&self.codes.code.inertia, &[], given)
    }

    /// The energy at a velocity.
    pub(super) fn energy(&self, velocity: &[f64]) -> f64 {
        self.of(&self.codes.code.energy, Array::Velocity, velocity)[0]
    }

    fn velocity_near_rest(&self, momentum: &[f64]) -> Vec<f64> {
        self.of(&self.codes.code.velocity, Array::Momentum, momentum)
    }

    /// The velocity of a momentum, NaN if there is none.
    pub(super) fn velocity(&self, momentum: &[f64]) -> Vec<f64> {
        let near_rest = self.velocity_near_rest(momentum);
        match &self.codes.code.hessian {
            None => near_rest,
            Some(hessian) => self.solved(hessian, momentum, near_rest),
        }
    }

    /// An estimate of the velocity of a momentum, which is finite even if no velocity has this momentum.
    pub(super) fn estimated_velocity(&self, momentum: &[f64]) -> Vec<f64> {
        let velocity = self.velocity(momentum);
        let has_none = self.codes.code.hessian.is_some() && velocity.iter().any(|number| number.is_nan());
        if has_none { self.velocity_near_rest(momentum) } else { velocity }
    }

    /// The solution of `∂l/∂ξ = μ` by Newton's iteration with halved steps.
    fn solved(&self, hessian: &Ready<B::Code>, momentum: &[f64], guess: Vec<f64>) -> Vec<f64> {
        let defect_at = |velocity: &[f64]| difference(momentum, &self.momentum(velocity));
        let derivative_at = |velocity: &[f64]| self.of(hessian, Array::Velocity, velocity);
        let zero = vec![0.0; momentum.len()];
        let (first, of_guess) = (defect_at(&zero), defect_at(&guess));
        let starts = dot(&of_guess, &of_guess) <= dot(&first, &first);
        let bias = difference(momentum, &first);
        let (mut solution_now, mut defect) = if starts { (guess, of_guess) } else { (zero.clone(), first) };
        let at_guess = difference(momentum, &defect);
        let terms = dot(momentum, momentum) + dot(&bias, &bias) + dot(&at_guess, &at_guess);
        let bound = terms * (f64::EPSILON * ROUNDINGS) * (f64::EPSILON * ROUNDINGS);
        for _ in 0..MOST_ITERATIONS {
            let size = dot(&defect, &defect);
            let step = solution(&derivative_at(&solution_now), &defect);
            let (mut fraction, mut has_helped) = (1.0, false);
            for _ in 0..MOST_HALVINGS {
                let candidate: Vec<f64> = solution_now.iter().zip(&step).map(|(x, step)| x + step * fraction).collect();
                let of_candidate = defect_at(&candidate);
                has_helped = dot(&of_candidate, &of_candidate) < size;
                if has_helped {
                    (solution_now, defect) = (candidate, of_candidate);
                }
                // Near rounding a step that doesn't help ends the iteration; farther away it is too long.
                if has_helped || size <= bound {
                    break;
                }
                fraction *= 0.5;
            }
            if !has_helped {
                break;
            }
        }
        let (residual, derivative) = (dot(&defect, &defect), derivative_at(&solution_now));
        let step = solution(&derivative, &defect);
        let rounding = f64::EPSILON * ROUNDINGS_OF_SOLUTION;
        let is_rounded = dot(&step, &step) <= dot(&solution_now, &solution_now) * rounding * rounding;
        let is_settled = residual <= bound || is_rounded && residual <= bound * (AT_MOST * AT_MOST);
        let sign = |matrix: &[f64]| Pivots::of(matrix, zero.len()).least.0;
        // The velocity is the one of two with this momentum to which rest can be continued.
        let is_lost = sign(&derivative_at(&zero)) > 0.0 && sign(&derivative) <= 0.0;
        if is_settled && !is_lost { solution_now } else { vec![f64::NAN; zero.len()] }
    }

    /// Checks that a momentum determines a velocity, and that the kinetic energy is positive along every direction.
    pub(super) fn check_inertia(&self) -> Result<(), SetupError> {
        let n = self.codes.sizes.n;
        let Pivots { least: (pivot, component), determinant, is_finite } = Pivots::of(&self.inertia(), n);
        // A factor of a product has a number; of a single one nothing is to be said.
        let body = || self.codes.is_product().then(|| self.factor_of(component));
        // A smaller absolute value may be the rounding error of zero.
        if pivot < -1e6 * f64::EPSILON {
            return Err(SetupError::NegativeKinetic { pivot, body: body() });
        }
        let is_positive = determinant > 0.0 && pivot > 0.0;
        if !(is_finite && is_positive) {
            let body = if pivot > 0.0 { None } else { body() };
            return Err(SetupError::SingularKinetic { determinant, body });
        }
        Ok(())
    }

    fn factor_of(&self, component: usize) -> usize {
        self.codes.factors.iter().skip(1).filter(|factor| factor.component <= component).count()
    }

    /// Checks that the velocity of a momentum is the one that the user gave, up to rounding.
    pub(super) fn check_velocity(&self, given: &[f64], momentum: &[f64]) -> Result<(), SetupError> {
        let (inertia, found) = (self.inertia(), self.velocity(momentum));
        let times = |v: &[f64]| inertia.chunks(v.len()).map(|row| dot(row, v)).collect::<Vec<f64>>();
        let (image, missed) = (times(given), times(&difference(&found, given)));
        let size = dot(&image, &image);
        // At a fold of the momentum, half of the digits of a velocity are lost. Cancellation in the momentum adds to that.
        let of_fold = size * (f64::EPSILON * 256.0);
        let of_sum = dot(momentum, momentum) * f64::EPSILON * f64::EPSILON * 1e8;
        let missed = dot(&missed, &missed);
        if missed <= of_fold + of_sum {
            return Ok(());
        }
        Err(SetupError::AmbiguousVelocity { difference: (missed / size).sqrt() })
    }

    /// The covectors of the reactions, one after the other, and the squares of their parts across those before.
    fn reactions(&self, constants: &[f64]) -> Option<[Vec<f64>; 2]> {
        let reactions = self.codes.code.reactions.as_ref()?;
        let mut found = rare::<B>(reactions, constants, [(Array::Advected, self.advected), (Array::Half, &[])]);
        let n = self.codes.sizes.n;
        let squares = found.split_off(found.len() / (n + 1) * n);
        Some([found, squares])
    }

    /// The momentum with reactions, `μ − Aᵀ (A J⁻¹ Aᵀ)⁻¹ A ξ`, whose velocity satisfies the constraints on velocities.
    pub(super) fn constrained(&self, momentum: Vec<f64>, constants: &[f64]) -> Vec<f64> {
        let Some(covectors) = self.covectors(constants) else { return momentum };
        let velocity = self.velocity(&momentum);
        self.reacted(momentum, &velocity, &covectors)
    }

    /// A change of the momentum with reactions, so that the change of the velocity satisfies the constraints.
    pub(super) fn constrained_change(&self, change: &[f64], constants: &[f64]) -> Vec<f64> {
        let Some(covectors) = self.covectors(constants) else { return change.to_vec() };
        let velocity = solution(&self.inertia(), change);
        self.reacted(change.to_vec(), &velocity, &covectors)
    }

    fn covectors(&self, constants: &[f64]) -> Option<Vec<f64>> {
        self.reactions(constants).map(|[covectors, _]| covectors)
    }

    fn reacted(&self, momentum: Vec<f64>, velocity: &[f64], covectors: &[f64]) -> Vec<f64> {
        let inertia = self.inertia();
        let covectors: Vec<&[f64]> = covectors.chunks(velocity.len()).collect();
        let along: Vec<Vec<f64>> = covectors.iter().map(|covector| solution(&inertia, covector)).collect();
        let squares: Vec<f64> =
            covectors.iter().flat_map(|covector| along.iter().map(|along| dot(covector, along))).collect();
        let rates: Vec<f64> = covectors.iter().map(|covector| dot(covector, velocity)).collect();
        let impulses = solution(&squares, &rates);
        covectors.iter().zip(impulses).fold(momentum, |momentum, (covector, impulse)| {
            momentum.iter().zip(*covector).map(|(momentum, entry)| momentum - impulse * entry).collect()
        })
    }

    /// Checks that the velocity of a momentum satisfies the constraints on velocities, and that none repeats others.
    pub(super) fn check_constraints(&self, momentum: &[f64], constants: &[f64]) -> Result<(), SetupError> {
        let Some([covectors, squares]) = self.reactions(constants) else { return Ok(()) };
        let velocity = self.velocity(momentum);
        for (constraint, (covector, square)) in covectors.chunks(velocity.len()).zip(squares).enumerate() {
            NonholonomicCheck {
                constraint,
                size: dot(covector, covector),
                across: square,
                rate: dot(covector, &velocity),
                speed: dot(&velocity, &velocity),
                epsilon: f64::EPSILON,
            }
            .passed()?;
        }
        Ok(())
    }

    /// Checks that a momentum is that of a velocity.
    pub(super) fn check_momentum(&self, momentum: &[f64]) -> Result<(), SetupError> {
        if self.codes.code.hessian.is_some() && !are_finite(&self.velocity(momentum)) {
            return Err(SetupError::NoVelocity);
        }
        Ok(())
    }
}

fn difference(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}
