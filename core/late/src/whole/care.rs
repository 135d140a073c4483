//! The solve with all its fallbacks, for steps that the usual solve doesn't settle.

use liestep::__private::{LONGEST_DAMPED, MAX_DAMPED_ITERATIONS, MAX_ITERATIONS, MOST_HALVINGS, SETTLED};
use liestep::StepError;
use liestep_derivation::Array;

use super::iteration::{Iterates, Problem};
use super::linear::{are_finite, dot};
use crate::code::Backend;

/// A solution of the momentum equation, and the number of iterations.
pub(super) type Root = (Vec<f64>, u32);

/// An iterate, with the determinant of the Jacobian before it.
struct Iterate {
    half: Vec<f64>,
    det: f64,
    is_settled: bool,
}

/// The Newton system at an iterate.
struct System {
    residual: Vec<f64>,
    jacobian: Vec<f64>,
    update: Vec<f64>,
    det: f64,
}

impl System {
    fn trace(&self) -> f64 {
        let diagonal = self.jacobian.iter().step_by(self.residual.len() + 1);
        diagonal.copied().reduce(|sum, entry| sum + entry).unwrap_or(0.0)
    }
}

fn norm(v: &[f64]) -> f64 {
    dot(v, v).sqrt()
}

impl<B: Backend<f64>> Problem<'_, B> {
    /// Solves from the guess; if that fails, from the identity; if that fails, once more with shortened updates.
    pub(super) fn solve(&self, guess: &[f64]) -> Result<Root, StepError> {
        if !are_finite(self.target) {
            return Err(StepError::NonFinite { what: "momentum" });
        }
        let (warm, iterations) = self.iterated(guess);
        if self.accepts(&warm) {
            return Ok((warm.half, iterations));
        }
        let identity = vec![0.0; guess.len()];
        let (cold, iterations) = self.iterated(&identity);
        if self.accepts(&cold) {
            return Ok((cold.half, MAX_ITERATIONS + iterations));
        }
        let (damped, iterations) = self.iterated_damped(identity);
        self.conclude(damped, iterations).map(|(half, iterations)| (half, MAX_ITERATIONS + iterations))
    }

    /// Newton's iteration from one guess; a solution on another branch is an error. If the iterates leave the domain of the
    /// Lagrangian, it starts again with shortened updates.
    pub(super) fn attempt(&self, guess: &[f64]) -> Result<Root, StepError> {
        let (found, iterations) = self.iterated(guess);
        if are_finite(&found.half) {
            return self.conclude(found, iterations);
        }
        let (damped, iterations) = self.iterated_damped(vec![0.0; guess.len()]);
        self.conclude(damped, iterations)
    }

    /// The residual at an iterate.
    pub(super) fn residual(&self, half: &[f64]) -> Vec<f64> {
        self.system(half, self.target).residual
    }

    fn system(&self, half: &[f64], target: &[f64]) -> System {
        let (program, n) = (&self.codes.code.newton, half.len());
        let mut numbers = vec![0.0; program.outputs];
        let given = [(Array::Half, half), (Array::Target, target), (Array::Advected, self.advected)];
        B::run(&program.code, self.constants, given, &mut numbers);
        let det = self.codes.determinant(&numbers[2 * n + n * n..]);
        let update = numbers[n + n * n..2 * n + n * n].to_vec();
        let jacobian = numbers[n..n + n * n].to_vec();
        numbers.truncate(n);
        System { residual: numbers, jacobian, update, det }
    }

    fn iterated(&self, guess: &[f64]) -> (Iterate, u32) {
        let mut room = vec![0.0; Iterates::room(self.codes)];
        let mut iterates = Iterates::at(guess, self.codes, &mut room);
        let iterations = iterates.iterate(self, MAX_ITERATIONS).unwrap_or(MAX_ITERATIONS);
        let (det, is_settled) = (iterates.det, iterates.is_settled);
        (Iterate { half: iterates.half.to_vec(), det, is_settled }, iterations)
    }

    /// Iterates with no update longer than a limit, and halves an update while it leaves the domain of the Lagrangian.
    fn iterated_damped(&self, half: Vec<f64>) -> (Iterate, u32) {
        let mut iterate = Iterate { half, det: 0.0, is_settled: false };
        for iteration in 1..=MAX_DAMPED_ITERATIONS {
            let System { update, det, .. } = self.system(&iterate.half, self.target);
            let square = dot(&update, &update);
            let length = square.sqrt();
            let mut factor = if length > LONGEST_DAMPED { LONGEST_DAMPED / length } else { 1.0 };
            let moved = |factor: f64| -> Vec<f64> {
                iterate.half.iter().zip(&update).map(|(half, update)| half - update * factor).collect()
            };
            for _ in 0..MOST_HALVINGS {
                let residual = self.residual(&moved(factor));
                if dot(&residual, &residual) < f64::INFINITY {
                    break;
                }
                factor *= 0.5;
            }
            let half = moved(factor);
            let is_settled = square <= dot(&half, &half) * (f64::EPSILON * SETTLED);
            iterate = Iterate { half, det, is_settled };
            if is_settled {
                return (iterate, iteration);
            }
        }
        (iterate, MAX_DAMPED_ITERATIONS)
    }

    /// Whether an iterate is a solution on the branch of the identity.
    fn accepts(&self, iterate: &Iterate) -> bool {
        let is_candidate = iterate.is_settled && iterate.det > 0.0 && self.is_solved(&iterate.half);
        is_candidate && self.is_on_branch(&iterate.half)
    }

    /// Whether a solution is on the branch of the identity: near the identity the determinant says so, and farther away the
    /// trace of the right-trivialised Jacobian is positive too, for several factors that of each factor's part.
    fn is_on_branch(&self, half: &[f64]) -> bool {
        let (program, sizes) = (&self.codes.code.branch, &self.codes.sizes);
        let mut numbers = vec![0.0; program.outputs];
        let given = [
            (Array::Half, half),
            (Array::Step, &[self.h][..]),
            (Array::Parameters, self.numbers),
            (Array::Advected, self.advected),
        ];
        B::run(&program.code, self.constants, given, &mut numbers);
        let (near, jacobian) = numbers.split_at(sizes.near);
        let (determinants, traces) = jacobian.split_at(2 * sizes.dets);
        let is_near = near.iter().all(|near| near * 4.0 < 1.0);
        is_near || self.codes.determinant(determinants) > 0.0 && traces.iter().all(|&trace| trace > 0.0)
    }

    /// Whether the momentum equation holds, which a vanishing update doesn't imply.
    ///
    /// The bound is far above rounding, and far below the right side when rounding has swallowed the Jacobian.
    fn is_solved(&self, half: &[f64]) -> bool {
        let residual = self.residual(half);
        let unforced = self.system(half, &vec![0.0; half.len()]);
        let forced: Vec<f64> = unforced.residual.iter().zip(&residual).map(|(unknown, all)| unknown - all).collect();
        let scale = norm(&unforced.residual) + norm(&forced) + unforced.trace().abs();
        norm(&residual) <= scale * f64::EPSILON.sqrt()
    }

    /// The root at the end of an iteration, or its error.
    fn conclude(&self, iterate: Iterate, iterations: u32) -> Result<Root, StepError> {
        if self.accepts(&iterate) {
            return Ok((iterate.half, iterations));
        }
        if iterate.is_settled {
            return Err(StepError::WrongBranch { determinant: iterate.det });
        }
        let System { update, det, .. } = self.system(&iterate.half, self.target);
        if !are_finite(&iterate.half) || det == 0.0 {
            return Err(StepError::Singular);
        }
        let residual = (dot(&update, &update) / dot(&iterate.half, &iterate.half)).sqrt();
        Err(StepError::NotConverged { iterations, residual })
    }
}
