//! Diagnosis of steps without a solution: bounds that decide before a solve, and the largest solvable step.

use liestep::__private::{Solvability, TurningLimits, largest_fraction, six_digits, turning_limits};
use liestep::groups::{CayleyRetraction, Retraction as _};
use liestep::{SO3, StepError};
use liestep_derivation::Array;
use liestep_derivation::whole::Form;
use nalgebra::{Matrix3, Vector3};

use super::care::Root;
use super::codes::{Codes, rare};
use super::constants::{StepConstants, folded};
use super::iteration::Problem;
use super::limit::Limit;
use super::linear::{are_finite, dot};
use crate::code::Backend;

/// A step from a momentum and advected parameters.
pub(super) struct Step<'a, B: Backend<f64>> {
    pub(super) codes: &'a Codes<B>,
    pub(super) numbers: &'a [f64],
    pub(super) constants: &'a StepConstants,
    pub(super) momentum: &'a [f64],
    pub(super) advected: &'a [f64],
}

impl<B: Backend<f64>> Step<'_, B> {
    /// The solve with all its fallbacks, from the beginning.
    #[cold]
    pub(super) fn solve_carefully(&self, guess: &[f64], safe: f64) -> Result<Root, StepError> {
        let StepConstants { h, numbers: constants, .. } = self.constants;
        let target = self.kicked(constants);
        // The bounds don't apply to an infinite kick.
        let is_finite = are_finite(&target) && are_finite(self.advected);
        if is_finite && self.solvability(*h, constants, self.limits()) == Solvability::Impossible {
            return Err(self.beyond_solvable(self.largest_solvable()));
        }
        let problem = self.problem(*h, constants, &target, safe);
        problem.solve(guess).map_err(|error| self.explain(error, &problem))
    }

    /// Replaces the error of a failed solve by one that names the largest solvable step, if there is one.
    fn explain(&self, error: StepError, problem: &Problem<'_, B>) -> StepError {
        if !are_finite(self.momentum) {
            return StepError::NonFinite { what: "momentum" };
        }
        if !are_finite(self.advected) {
            return StepError::NonFinite { what: "advected parameter" };
        }
        // An example is an attraction between bodies at one position.
        if !are_finite(&problem.residual(&vec![0.0; self.momentum.len()])) {
            return StepError::NonFinite { what: "momentum equation" };
        }
        let largest = self.largest_solvable();
        if largest == 0.0 { error } else { self.beyond_solvable(largest) }
    }

    fn problem<'b>(&'b self, h: f64, constants: &'b [f64], target: &'b [f64], safe: f64) -> Problem<'b, B> {
        Problem { codes: self.codes, numbers: self.numbers, h, constants, target, advected: self.advected, safe }
    }

    /// The right side `a = μ + kick_before(w)`.
    fn kicked(&self, constants: &[f64]) -> Vec<f64> {
        let given = [(Array::Momentum, self.momentum), (Array::Advected, self.advected)];
        let mut target = rare::<B>(&self.codes.code.target, constants, given);
        target.truncate(self.momentum.len());
        target
    }

    fn solvability(&self, h: f64, constants: &[f64], limits: Option<TurningLimits>) -> Solvability {
        let turn: Vec<f64> = self.kicked(constants).iter().map(|entry| entry * h).collect();
        limits.map_or(Solvability::Open, |limits| limits.decide(dot(&turn, &turn).sqrt()))
    }

    /// The proved bounds at this step and at half of it, as they hold for one dependence of the kinetic part on `h` only.
    fn limits(&self) -> Option<TurningLimits> {
        // A reaction can be as large as it needs be.
        let is_constrained = self.codes.code.reactions.is_some();
        if is_constrained || !matches!(&self.codes.factors[..], [factor] if factor.form == Form::Rotation) {
            return None;
        }
        let limit = Limit { codes: self.codes, numbers: self.numbers, advected: self.advected };
        let inertia = Matrix3::from_row_slice(&limit.inertia());
        let denominators = self.codes.declaration.denominators.cast_signed();
        let at = |h: f64| {
            let constants = folded(self.codes, self.numbers, h);
            let zero = [0.0; 3];
            let problem = self.problem(h, &constants, &zero, 0.0);
            let unknown = |f: &SO3| {
                let half: Vector3<f64> = CayleyRetraction::local_coordinates(f)? * 0.5;
                let factor = (1.0 + half.dot(&half)).powi(denominators);
                Some(Vector3::from_column_slice(&problem.residual(half.as_slice())) * (2.0 / factor))
            };
            turning_limits::<SO3>(&unknown, &inertia)
        };
        at(self.constants.h * 0.5).and(at(self.constants.h))
    }

    /// The largest solvable step; zero if there is none.
    fn largest_solvable(&self) -> f64 {
        let limits = self.limits();
        let solvable = |fraction: f64| {
            let h = self.constants.h * fraction;
            let constants = folded(self.codes, self.numbers, h);
            match self.solvability(h, &constants, limits) {
                Solvability::Certain => return true,
                Solvability::Impossible => return false,
                Solvability::Open => {}
            }
            let target = self.kicked(&constants);
            self.problem(h, &constants, &target, self.constants.safe).attempt(&vec![0.0; target.len()]).is_ok()
        };
        largest_fraction(solvable).map_or(0.0, |fraction| self.constants.h * fraction)
    }

    /// The error that names the largest step, and the turn that the whole step would take, with the kick at its beginning.
    pub(super) fn beyond_solvable(&self, largest: f64) -> StepError {
        let h = self.constants.h;
        let limit = Limit { codes: self.codes, numbers: self.numbers, advected: self.advected };
        let velocity = limit.estimated_velocity(&self.kicked(&self.constants.numbers));
        // Translations are ignored: a metre isn't a radian.
        let turning = self.codes.factors.iter().flat_map(|factor| factor.basis.generators.iter().map(|e| is_skew(e)));
        let turns: Vec<f64> =
            velocity.iter().zip(turning).filter(|(_, turns)| *turns).map(|(entry, _)| entry * h).collect();
        let turn = dot(&turns, &turns).sqrt();
        let turn = if turn > 0.0 { turn } else { 0.0 };
        StepError::BeyondSolvable { step: h, largest: six_digits(largest), turn, body: None }
    }
}

fn is_skew(generator: &[f64]) -> bool {
    let n = generator.len().isqrt();
    (0..n * n).all(|at| generator[at] + generator[at % n * n + at / n] == 0.0)
}
