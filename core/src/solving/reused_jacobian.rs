//! A last iteration without a Jacobian of its own.
//!
//! Most solves take two of Newton's iterations: one from the guess, and one that brings the rest to rounding. The
//! second needs no better Jacobian than the first had. With that it takes the residual alone and no inverse, and what
//! is left to wait for is shorter. It converges at a rate, not quadratically, so whether it was enough has to be seen.
//!
//! # What is missing
//!
//! Let `C` bound how fast the Jacobian changes, relative to itself: `|A⁻¹(A(y + e) − A)| ≤ 2C|e|`. After an update `u₁`
//! by Newton's iteration `C|u₁|²` are missing; the next, `u₂`, finds what they are; and after it, with the same
//! Jacobian, `2C|u₁||u₂|`. The two updates tell `C` along the first as `|u₂|/|u₁|²`. In other directions it may be
//! larger: in Cayley coordinates it is of the order of one, times the ratio of the largest to the least inertia, by
//! which roundings of the residual are magnified too. So it is taken as one where the updates tell less.
//!
//! # The branch
//!
//! The determinant is that at the iterate before both updates, and they are short: to have changed its sign on the way
//! it would have to change by all of itself within a ten-thousandth of `|y|`. Where it is a sixteenth or less of what
//! it is at rest, as very near a fold, that isn't relied on, and every iteration has its own Jacobian.

use core::any::TypeId;

use super::iteration::{Iterates, Iteration, SETTLED, System};
use crate::groups::LieGroup;
use crate::numbers::{Coordinates as _, Mask, Real, real};
use nalgebra::{SimdBool as _, SimdPartialOrd as _, SimdValue};

/// Error of `y` allowed at the end, in its roundings. It is less than the rounding of the residual in the last update.
const REST: f64 = 1.0 / 16.0;
/// The square of the allowed error for `f64`, as lengths are passed as squares.
const REST_OF_SIZE: f64 = (REST * f64::EPSILON) * (REST * f64::EPSILON);
/// A determinant is safe above this part of the determinant at rest.
const SAFE: f64 = 1.0 / 16.0;
/// The `C` that is assumed for a first update: that of the heavy tops of the thesis at common steps. A top with a
/// larger one wastes a residual in a narrow range of updates.
const TYPICAL_CURVATURE: f64 = 1.0 / 16.0;
/// The tolerance of [`may_suffice`], in roundings.
pub const NEAR_ENOUGH: f64 = 0.5 * REST / TYPICAL_CURVATURE;
/// The tolerance of [`has_sufficed`], in roundings.
pub const SUFFICIENT: f64 = 0.5 * REST;

/// The determinant above which a solve needs no second Jacobian, from that of the Jacobian at rest.
#[must_use]
pub fn safe<T: Real>(at_rest: T) -> T {
    at_rest * real(SAFE)
}

/// Whether linearly converging iterations will do: only with plain floating-point numbers. The derivatives of a dual
/// number converge with its values in the quadratic iteration, but lag behind them in others.
#[hot]
pub(super) fn has_no_derivatives<T: Real>() -> bool {
    let element = TypeId::of::<<T as SimdValue>::Element>();
    element == TypeId::of::<f64>() || element == TypeId::of::<f32>()
}

#[hot]
impl<G: LieGroup> Iterates<G> {
    /// An iteration of the lanes that haven't converged. With `REUSE`, lanes that are near enough after it make one
    /// more with the same Jacobian. If steps are so long that they seldom are, the test costs more than it saves.
    /// Returns whether a lane has converged by the second update.
    pub(super) fn iterate_once<const REUSE: bool>(
        &mut self,
        equation: &(impl System<G> + ?Sized),
        safe: G::Scalar,
    ) -> bool {
        let made = equation.newton_update(&self.half);
        self.advance(&made.update, made.det, &made.update);
        self.reuse_jacobian::<REUSE>(equation, &made, safe)
    }

    /// The second part of [`iterate_once`](Self::iterate_once), with the same Jacobian.
    pub(super) fn reuse_jacobian<const REUSE: bool>(
        &mut self,
        equation: &(impl System<G> + ?Sized),
        made: &Iteration<G>,
        safe: G::Scalar,
    ) -> bool {
        if !REUSE || !has_no_derivatives::<G::Scalar>() || self.settled.all() {
            return false;
        }
        let Some(factors) = &made.factors else { return false };
        let before = made.update.dot(&made.update);
        let is_near = may_suffice(before, self.half.dot(&self.half)) & made.det.simd_gt(safe) & !self.settled;
        if !is_near.any() {
            return false;
        }
        let second = equation.simplified(factors, made.det, &self.half);
        let next = self.half - second;
        self.half = next.select(is_near, self.half);
        let settled = is_near & has_sufficed(before, second.dot(&second), next.dot(&next));
        self.settled = self.settled | settled;
        settled.any()
    }
}

/// Whether a second update will be the last, after a first with the square `first` that has led to `|y|² = size`:
/// `2C|u₁|³ ≤ REST ε|y|` bounds the error after `|u₂| = C|u₁|²` if `C` is one in other directions.
#[hot]
#[must_use]
pub fn may_suffice<T: Real>(first: T, size: T) -> Mask<T> {
    let tolerance = T::simd_default_epsilon() * real(NEAR_ENOUGH);
    (first * first * first).simd_le(size * (tolerance * tolerance))
}

/// Whether the second update was the last: `2|u₁||u₂| max(|u₂|/|u₁|², 1) ≤ REST ε|y|`. Arguments are squares.
#[hot]
#[must_use]
pub fn has_sufficed<T: Real>(first: T, second: T, size: T) -> Mask<T> {
    let tolerance = T::simd_default_epsilon() * real(SUFFICIENT);
    (second * first.simd_max(second / first)).simd_le(size * (tolerance * tolerance))
}

/// The square of `C`, estimated from two updates of Newton's iteration along the first, and at least one.
#[derive(Clone, Copy)]
pub(crate) struct Curvature(Option<f64>);

// All lengths are passed as squares.
#[hot]
impl Curvature {
    /// The estimate from an update of Newton's iteration and the one before, if there was one.
    pub(crate) fn told(before: Option<f64>, update: f64) -> Self {
        Self(before.map(|before| (update / (before * before)).max(1.0)))
    }

    /// Whether an update of Newton's iteration was the last: by [`SETTLED`], or by `C|u|² ≤ REST ε|y|`.
    ///
    /// `C` is estimated along the update before. Along this one it may be larger, by the ratio of inertias, by which
    /// roundings are magnified, too. For chains with slim or heavy links the error is then no larger than with
    /// [`SETTLED`].
    pub(crate) fn has_settled(self, update: f64, size: f64) -> bool {
        let by_curvature = |square| square * update * update <= size * REST_OF_SIZE;
        update <= size * (f64::EPSILON * SETTLED) || self.0.is_some_and(by_curvature)
    }

    /// Whether a second update with the same Jacobian will be the last: `2C²|u₁|³ ≤ REST ε|y|`, or [`may_suffice`].
    pub(crate) fn may_suffice(self, first: f64, size: f64) -> bool {
        match self.0 {
            Some(square) => 4.0 * square * square * (first * first * first) <= size * REST_OF_SIZE,
            None => may_suffice(first, size),
        }
    }

    /// Whether the second update was the last: [`has_sufficed`] with the larger of both estimates of `C`.
    ///
    /// If `u₂` is all rounding, the estimate `C = |u₂|/|u₁|²` is too large. But an update `u₁` that hasn't converged is
    /// longer than `√ε|y|/8`, and with that `2|u₂|²/|u₁| ≤ ε|y|/16` for roundings of up to `512 ε|y|`.
    pub(crate) fn has_sufficed(self, first: f64, second: f64, size: f64) -> bool {
        let along = (self.0.unwrap_or(1.0) * first).max(second / first);
        4.0 * along * second <= size * REST_OF_SIZE
    }
}

#[cfg(test)]
mod tests {
    use super::{Curvature, has_sufficed, may_suffice};

    const EPSILON: f64 = f64::EPSILON;

    /// The two criteria agree for `C = 1/16`, at the first update after which a second is just enough:
    /// `|u₁|³ = ε|y|/2`.
    #[test]
    fn what_is_expected_is_what_is_asked_for() {
        for size in [1e-80_f64, 1e-8, 0.06, 1.0] {
            let limit = (0.5 * EPSILON * size).cbrt();
            for (first, enough) in [(limit * 0.999, true), (limit * 1.001, false)] {
                let second = first * first / 16.0;
                let [first, second, size] = [first, second, size].map(|length| length * length);
                assert_eq!(may_suffice(first, size), enough);
                assert_eq!(has_sufficed(first, second, size), enough);
            }
        }
    }

    /// The estimate of `C` counts if it is above one; below, it counts as one.
    #[test]
    fn a_curvature_that_the_updates_tell_counts() {
        let (first, size) = (1e-6_f64, 0.06_f64);
        let enough = |curvature: f64, size: f64| {
            let second = curvature * first * first;
            has_sufficed(first * first, second * second, size * size)
        };
        let limit = |curvature: f64| 32.0 * curvature * curvature.max(1.0) * first.powi(3) / EPSILON;
        for curvature in [1e-3, 0.1, 10.0, 1e3] {
            assert!(enough(curvature, limit(curvature) * 1.001) && !enough(curvature, limit(curvature) * 0.999));
        }
        assert!(!enough(1.0, f64::NAN) && !has_sufficed(0.0, f64::NAN, size));
    }

    /// The iterates of `y' = C y²`, whose solution is zero, are their own errors, and the next is below a sixteenth of
    /// a rounding of `y = 1e-4` if and only if the estimate of two updates implies it.
    #[test]
    fn a_curvature_of_two_updates_tells_what_is_missing() {
        let (size, rest) = (1e-4_f64, EPSILON * 1e-4 / 16.0);
        for curvature in [1.5_f64, 8.0, 100.0] {
            let (mut settled, mut missed) = (0, 0);
            for exponent in 30..90 {
                let before = 1.2_f64.powi(-exponent) * 0.1;
                let update = curvature * before * before;
                // Updates that SETTLED accepts are tested elsewhere.
                if update < 4e-9 * size {
                    break;
                }
                let told = Curvature::told(Some(before * before), update * update);
                let is_settled = told.has_settled(update * update, size * size);
                assert_eq!(is_settled, curvature * update * update <= rest, "{curvature}: {update:e}");
                settled += u32::from(is_settled);
                missed += u32::from(!is_settled);
                let expected = 2.0 * curvature * curvature * update * update * update <= rest;
                assert_eq!(told.may_suffice(update * update, size * size), expected, "{curvature}: {update:e}");
            }
            assert!(missed > 0 && settled > 0, "{curvature}: {settled} {missed}");
        }
    }

    /// An estimate of `C` below one counts as one. One update gives no estimate, nor does one after zero: [`SETTLED`]
    /// decides.
    #[test]
    fn a_curvature_is_one_at_least() {
        let size = 1e-4_f64;
        let limit = (EPSILON * size / 16.0).sqrt();
        let settles = |told: Curvature, update: f64| told.has_settled(update * update, size * size);
        for curvature in [0.0, 1e-3, 0.5, 1.0] {
            let told = Curvature::told(Some(1e-10), (curvature * 1e-10_f64).powi(2));
            assert!(settles(told, limit * 0.999) && !settles(told, limit * 1.001), "{curvature}");
        }
        let by_itself = EPSILON.sqrt() / 8.0 * size;
        for told in [Curvature::told(None, 1e-6), Curvature::told(Some(0.0), 1e-6)] {
            assert!(settles(told, by_itself * 0.999) && !settles(told, by_itself * 1.001));
        }
        assert!(settles(Curvature::told(Some(0.0), 0.0), 0.0));
    }

    /// The larger of the two estimates of `C` bounds the error after the second update.
    #[test]
    fn the_larger_of_two_curvatures_counts() {
        let first = 1e-6_f64;
        for (before, along) in [(1.0, 100.0), (100.0, 1.0), (8.0, 8.0), (0.1, 0.5), (0.1, 30.0), (30.0, 0.1)] {
            let told = Curvature::told(Some(1e-10), (before * 1e-10_f64).powi(2));
            let second = along * first * first;
            let enough = |size: f64| told.has_sufficed(first * first, second * second, size * size);
            // The limit has `2C|u₁||u₂| = ε|y|/16`.
            let limit = 32.0 * f64::max(before, along).max(1.0) * first * second / EPSILON;
            assert!(enough(limit * 1.001) && !enough(limit * 0.999), "{before} {along}");
        }
        let told = Curvature::told(Some(1e-10), 1e-20);
        assert!(!told.has_sufficed(1e-12, f64::NAN, 1.0) && !told.has_sufficed(1e-12, 1e-40, f64::NAN));
        assert!(told.has_sufficed(0.0, 0.0, 1.0));
    }

    /// A second update that is all rounding, up to 512 roundings, is the last after a first that hasn't quite
    /// converged.
    #[test]
    fn roundings_suffice() {
        let told = Curvature::told(Some(1e-10), 1e-20);
        for size in [1e-4_f64, 0.06, 1.0] {
            let first = EPSILON.sqrt() / 8.0 * size;
            for (roundings, enough) in [(1.0, true), (511.0, true), (513.0, false)] {
                let second = roundings * EPSILON * size;
                let [first, second, size] = [first, second, size].map(|length| length * length);
                assert_eq!(told.has_sufficed(first, second, size), enough, "{size} {roundings}");
                assert_eq!(
                    Curvature::told(None, first).has_sufficed(first, second, size),
                    enough,
                    "{size} {roundings}"
                );
            }
        }
    }
}
