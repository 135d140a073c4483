//! Newton's iteration for the momentum equation of a step, with a Jacobian that may be used twice.

use liestep::__private::{SETTLED, has_sufficed, may_suffice};
use liestep_derivation::Array;

use super::codes::Codes;
use crate::code::Backend;

/// A momentum equation with its right side.
pub(super) struct Problem<'a, B: Backend<f64>> {
    pub(super) codes: &'a Codes<B>,
    pub(super) numbers: &'a [f64],
    pub(super) h: f64,
    pub(super) constants: &'a [f64],
    pub(super) target: &'a [f64],
    pub(super) advected: &'a [f64],
    /// A determinant above which a Jacobian may be used again.
    pub(super) safe: f64,
}

/// The iterates of a solve, and the places of an iteration's results.
pub(super) struct Iterates<'a> {
    pub(super) half: &'a mut [f64],
    made: &'a mut [f64],
    second: &'a mut [f64],
    /// The determinant of the last Jacobian.
    pub(super) det: f64,
    pub(super) is_settled: bool,
}

impl<'a> Iterates<'a> {
    /// The number of numbers that iterates need.
    pub(super) fn room<B: Backend<f64>>(codes: &Codes<B>) -> usize {
        2 * codes.sizes.n + 2 + codes.code.iterate.outputs
    }

    pub(super) fn at<B: Backend<f64>>(guess: &[f64], codes: &Codes<B>, room: &'a mut [f64]) -> Self {
        let (half, rest) = room.split_at_mut(codes.sizes.n);
        let (second, made) = rest.split_at_mut(codes.sizes.n + 2);
        half.copy_from_slice(guess);
        Self { half, made, second, det: 0.0, is_settled: false }
    }

    /// Iterates until the end, at most `most` times; returns the number of iterations.
    #[inline]
    pub(super) fn iterate<B: Backend<f64>>(&mut self, problem: &Problem<'_, B>, most: u32) -> Option<u32> {
        for iteration in 1..=most {
            let again = self.iterate_once(problem);
            if self.is_settled {
                return Some(iteration + u32::from(again));
            }
        }
        None
    }

    /// An iteration, and a second with its Jacobian if that is likely to be the last; returns whether it was.
    #[inline]
    fn iterate_once<B: Backend<f64>>(&mut self, problem: &Problem<'_, B>) -> bool {
        let Problem { codes, constants, target, advected, .. } = *problem;
        let (n, determinants) = (codes.sizes.n, 2 * codes.sizes.dets);
        let given = [(Array::Half, &*self.half), (Array::Target, target), (Array::Advected, advected)];
        B::run(&codes.code.iterate.code, constants, given, self.made);
        let (next, others) = self.made.split_at(n);
        let (first, size, factors) = (others[0], others[1], &others[2..]);
        self.half.copy_from_slice(next);
        self.det = codes.determinant(&factors[..determinants]);
        self.is_settled = first <= size * (f64::EPSILON * SETTLED);
        if self.is_settled || !(may_suffice(first, size) && self.det > problem.safe) {
            return false;
        }
        let given = [
            (Array::Half, &*self.half),
            (Array::Target, target),
            (Array::Advected, advected),
            (Array::Factors, factors),
        ];
        B::run(&codes.code.again.code, constants, given, self.second);
        let (next, squares) = self.second.split_at(n);
        self.half.copy_from_slice(next);
        self.is_settled = has_sufficed(first, squares[0], squares[1]);
        self.is_settled
    }
}
