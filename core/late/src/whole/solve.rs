//! The solve of a step's momentum equation (2.7) on numbers, by the decisions of the library's own solve.

use liestep::StepError;
use liestep_derivation::Array;

use super::family::Name;
use super::stepper::Whole;
use crate::code::Backend;

/// The limit of iterations, that of shortened ones, the longest shortened update in half the coordinates, and the limit of
/// its halvings: those of the library.
const MOST: u32 = 20;
const MOST_DAMPED: u32 = 60;
const LONGEST_DAMPED: f64 = 0.25;
const MOST_HALVINGS: u32 = 40;
/// The square of the last update relative to the unknown's, in roundings.
const SETTLED: f64 = 1.0 / 64.0;
/// The error that a last update without its own Jacobian may leave, in roundings; and the assumed curvature.
const REST: f64 = 1.0 / 16.0;
const TYPICAL_CURVATURE: f64 = 1.0 / 16.0;

/// The numbers of a solve, allocated once for a run.
#[derive(Debug)]
pub(super) struct Scratch {
    /// The target `a`, and `a·a`.
    pub(super) target: Vec<f64>,
    /// The outputs of an iteration.
    made: Vec<f64>,
    /// Those of an iteration with the Jacobian before.
    second: Vec<f64>,
    /// The iterate, half the coordinates of the increment.
    pub(super) half: Vec<f64>,
    /// The state after the step, and what `finish` writes behind it.
    pub(super) end: Vec<f64>,
}

/// The result of iterating.
#[derive(Clone, Copy)]
pub(super) struct Iterated {
    pub(super) iterations: u32,
    pub(super) is_settled: bool,
    pub(super) determinant: f64,
}

/// The determinant relative to the diagonal of several blocks, negative where one is; that of one block as it is.
pub(super) fn determinant(pairs: &[f64], is_one: bool) -> f64 {
    if is_one {
        return pairs.first().copied().unwrap_or(f64::NAN);
    }
    let (mut value, mut is_negative) = (1.0_f64, false);
    for pair in pairs.chunks_exact(2) {
        value *= pair[0] / pair[1].abs();
        is_negative |= pair[0] < 0.0;
    }
    if is_negative { -value.abs() } else { value }
}

fn square(vector: &[f64]) -> f64 {
    vector.iter().map(|number| number * number).sum()
}

impl<B: Backend<f64>> Whole<B> {
    pub(super) fn scratch(&self) -> Scratch {
        let sizes = &self.family.sizes;
        let n = sizes.n;
        Scratch {
            target: vec![0.0; n + 1],
            made: vec![0.0; n + 2 + 2 * sizes.dets + n * n],
            second: vec![0.0; n + 2],
            half: vec![0.0; n],
            end: vec![0.0; sizes.state() + sizes.near],
        }
    }

    /// Writes the target `a = μ + kick_before(w)`.
    pub(super) fn aim(&self, momentum: &[f64], advected: &[f64], scratch: &mut Scratch) {
        let given = [(Array::Momentum, momentum), (Array::Advected, advected)];
        self.family.run(Name::Target, &self.constants, given, &mut scratch.target);
    }

    /// Iterates from the iterate in the scratch.
    pub(super) fn iterate(&self, advected: &[f64], safe: f64, most: u32, scratch: &mut Scratch) -> Iterated {
        let Scratch { target, made, second, half, .. } = scratch;
        let (n, dets, family) = (half.len(), self.family.sizes.dets, &self.family);
        let target = &target[..n];
        let mut found = f64::NAN;
        for iterations in 1..=most {
            let given = [(Array::Half, &half[..]), (Array::Target, target), (Array::Advected, advected)];
            family.run(Name::Iterate, &self.constants, given, made);
            let (next, others) = made.split_at(n);
            let (first, length, factors) = (others[0], others[1], &others[2..]);
            found = determinant(&factors[..2 * dets], self.is_one);
            half.copy_from_slice(next);
            if first <= length * (f64::EPSILON * SETTLED) {
                return Iterated { iterations, is_settled: true, determinant: found };
            }
            let expected = f64::EPSILON * (0.5 * REST / TYPICAL_CURVATURE);
            if first * first * first <= length * (expected * expected) && found > safe {
                let given = [
                    (Array::Half, &half[..]),
                    (Array::Target, target),
                    (Array::Advected, advected),
                    (Array::Factors, factors),
                ];
                family.run(Name::Again, &self.constants, given, second);
                let (change, length) = (second[n], second[n + 1]);
                half.copy_from_slice(&second[..n]);
                let enough = f64::EPSILON * (0.5 * REST);
                if change * first.max(change / first) <= length * (enough * enough) {
                    return Iterated { iterations: iterations + 1, is_settled: true, determinant: found };
                }
            }
        }
        Iterated { iterations: most, is_settled: false, determinant: found }
    }

    /// Iterates from rest with shortened updates, which are halved while they leave the domain of the Lagrangian.
    fn iterate_damped(&self, advected: &[f64], scratch: &mut Scratch) -> Iterated {
        let n = scratch.half.len();
        scratch.half.fill(0.0);
        let (mut found, mut update, mut tried) = (f64::NAN, vec![0.0; n], vec![0.0; n]);
        for iterations in 1..=MOST_DAMPED {
            let given =
                [(Array::Half, &scratch.half[..]), (Array::Target, &scratch.target[..n]), (Array::Advected, advected)];
            self.family.run(Name::Iterate, &self.constants, given, &mut scratch.made);
            found = determinant(&scratch.made[n + 2..n + 2 + 2 * self.family.sizes.dets], self.is_one);
            for (place, (half, next)) in update.iter_mut().zip(scratch.half.iter().zip(&scratch.made)) {
                *place = half - next;
            }
            let first = scratch.made[n];
            let mut factor = if first.sqrt() > LONGEST_DAMPED { LONGEST_DAMPED / first.sqrt() } else { 1.0 };
            for _ in 0..MOST_HALVINGS {
                tried
                    .iter_mut()
                    .zip(scratch.half.iter().zip(&update))
                    .for_each(|(to, (half, u))| *to = half - u * factor);
                if self.residual(&tried, &scratch.target[..n], advected) < f64::INFINITY {
                    break;
                }
                factor *= 0.5;
            }
            scratch.half.copy_from_slice(&tried);
            if first <= square(&scratch.half) * (f64::EPSILON * SETTLED) {
                return Iterated { iterations, is_settled: true, determinant: found };
            }
        }
        Iterated { iterations: MOST_DAMPED, is_settled: false, determinant: found }
    }

    /// The length of the residual, as the update by a Jacobian of one.
    fn residual(&self, half: &[f64], target: &[f64], advected: &[f64]) -> f64 {
        let (n, dets) = (half.len(), self.family.sizes.dets);
        let mut factors = vec![1.0; 2 * dets + n * n];
        for (at, place) in factors[2 * dets..].iter_mut().enumerate() {
            *place = f64::from(u8::from(at / n == at % n));
        }
        let given =
            [(Array::Half, half), (Array::Target, target), (Array::Advected, advected), (Array::Factors, &factors[..])];
        let mut outputs = vec![0.0; n + 2];
        self.family.run(Name::Again, &self.constants, given, &mut outputs);
        outputs[n].sqrt()
    }

    /// Whether a solution is on the branch of the identity, near it, and satisfies the momentum equation.
    fn is_accepted(&self, iterated: &Iterated, advected: &[f64], scratch: &Scratch) -> bool {
        if !(iterated.is_settled && iterated.determinant > 0.0 && self.is_near(&scratch.half, advected)) {
            return false;
        }
        let n = scratch.half.len();
        let residual = self.residual(&scratch.half, &scratch.target[..n], advected);
        let unforced = self.residual(&scratch.half, &vec![0.0; n], advected);
        residual <= (residual + unforced + self.trace.abs()) * f64::EPSILON.sqrt()
    }

    /// Whether all increments are near the identity, up to a right angle on SO(3).
    fn is_near(&self, half: &[f64], advected: &[f64]) -> bool {
        let sizes = &self.family.sizes;
        let mut end = vec![0.0; sizes.state() + sizes.near];
        let (momentum, attitude) = (vec![0.0; sizes.n], self.family.identity());
        let history = vec![0.0; 2 * sizes.n];
        let given = [
            (Array::Half, half),
            (Array::Target, &momentum[..]),
            (Array::Advected, advected),
            (Array::Momentum, &momentum[..]),
            (Array::Attitude, &attitude[..]),
            (Array::History, &history[..]),
        ];
        self.family.run(Name::Finish, &self.constants, given, &mut end);
        end[sizes.state()..].iter().all(|near| near * 4.0 < 1.0)
    }

    /// The solve with all its fallbacks: from the guess, from rest, and from rest by shortened updates. The iterate is in the
    /// scratch, and its iterations are returned.
    pub(super) fn solve_carefully(
        &self,
        advected: &[f64],
        guess: &[f64],
        scratch: &mut Scratch,
    ) -> Result<u32, StepError> {
        let n = guess.len();
        if !scratch.target.iter().all(|number| number.is_finite()) {
            return Err(StepError::NonFinite { what: "momentum" });
        }
        let safe = self.safe_at(advected);
        scratch.half.copy_from_slice(guess);
        let warm = self.iterate(advected, safe, MOST, scratch);
        if self.is_accepted(&warm, advected, scratch) {
            return Ok(warm.iterations);
        }
        scratch.half.fill(0.0);
        let cold = self.iterate(advected, safe, MOST, scratch);
        if self.is_accepted(&cold, advected, scratch) {
            return Ok(MOST + cold.iterations);
        }
        let damped = self.iterate_damped(advected, scratch);
        if self.is_accepted(&damped, advected, scratch) {
            return Ok(2 * MOST + damped.iterations);
        }
        if damped.is_settled {
            return Err(StepError::WrongBranch { determinant: damped.determinant });
        }
        if !scratch.half.iter().all(|number| number.is_finite()) || damped.determinant == 0.0 {
            return Err(StepError::Singular);
        }
        let residual = (scratch.made[n] / square(&scratch.half)).sqrt();
        Err(StepError::NotConverged { iterations: damped.iterations, residual })
    }

    /// Whether Newton's iteration from rest has a solution, with shortened updates where it leaves the domain.
    pub(super) fn is_solvable(&self, momentum: &[f64], advected: &[f64]) -> bool {
        let mut scratch = self.scratch();
        self.aim(momentum, advected, &mut scratch);
        let mut found = self.iterate(advected, self.safe_at(advected), MOST, &mut scratch);
        if !scratch.half.iter().all(|number| number.is_finite()) {
            found = self.iterate_damped(advected, &mut scratch);
        }
        self.is_accepted(&found, advected, &scratch)
    }
}
