//! The solve without the Jacobian, for Lagrangians to which it costs more than several residuals.
//!
//! The free body's Jacobian with the same inertia, [`free_momentum_tangent`](crate::groups::Retraction::free_momentum_tangent),
//! replaces it. It is computed once a solve at the guess, and Broyden's good updates correct it along the updates made
//! (in the form that stores the updates and no matrix; C. T. Kelley, *Iterative Methods for Linear and Nonlinear
//! Equations*, SIAM 1995, section 7.3). For a Lagrangian of order four or more the first update already gains a factor
//! of `h²|ξ|²` and `h²` times the curvature of the potential.
//!
//! # Convergence
//!
//! Newton's updates square from one to the next, so that the size of one suffices. Secant updates shrink by a factor
//! that has to be measured: `θ`, the largest ratio of an update to the one before in this solve. The error after the
//! update `s` is `θ|s| + θ²|s| + …`, so the iteration ends when `θ|s| ≤ ε|ξ|/16`: that moves the residual by less than
//! its rounding. Broyden's iteration is faster than linear, but not evenly: a ratio can be small by chance, as when an
//! update happens to lie where the model is good. So the largest of them counts, and no solve ends with one update.
//!
//! Updates of some roundings of `ξ` consist of rounding, and their ratios mean nothing; two such updates end the solve.
//!
//! # The kick
//!
//! The last gradient, before the last update, also gives the diamond. If that update would change the diamond by less
//! than a part of the momentum's rounding, at the rate of the update before, no gradient is evaluated for the diamond
//! alone.
//!
//! # The branch
//!
//! There is no Jacobian, and so no determinant to check. Two criteria replace it; if one of them fails, the solve
//! starts again with Newton's iteration:
//!
//! - `ξ` lies in the ball where, by samples taken when the flow was constructed, the model is near the Jacobian in all
//!   directions, see [`trusted_radius`](super::branch::trusted_radius). If `‖I − B⁻¹A‖ < 1` for the model `B` and the
//!   Jacobian `A`, `det A` has the sign of `det B`, which on that ball is that at the identity. So a ball that contains
//!   the identity has no fold to cross, and a solution in it is the one that Newton's iteration would have accepted.
//! - Each update is shorter than a quarter of the last. Updates alone aren't enough: those of a motion with a symmetry,
//!   such as a planar pendulum's, lie in one plane, and don't test the directions across it. But they test what lies
//!   between the samples of the ball.

use super::iteration::Lanes;
use super::problem::Problem;
use super::reused_jacobian::has_no_derivatives;
use crate::groups::Retraction as _;
use crate::mechanics::{Effect, Group, Residual, Scalar, Vector};
use crate::numbers::{Coordinates as _, Mask, nowhere, real};
use nalgebra::{SimdBool as _, SimdPartialOrd as _, SimdRealField as _, SimdValue as _};

/// Limit of the updates. Beyond, Newton's iteration is cheaper.
const MAX_UPDATES: usize = 8;
/// Ratio by which updates must shrink at least.
const CONTRACTION: f64 = 0.25;
/// Error allowed at the end, in roundings of `ξ`.
const REST: f64 = 1.0 / 16.0;
/// Updates below this many roundings of `ξ` may consist of rounding.
const FLOOR: f64 = 32.0;

/// The updates of a solve, and their contraction. Lengths are squared.
struct Updates<L: Effect> {
    made: [Vector<L>; MAX_UPDATES],
    lengths: [Scalar<L>; MAX_UPDATES],
    count: usize,
    /// The square `θ²`.
    contraction: Scalar<L>,
    /// The square of the largest change of the kick by an update, relative to the update's length.
    kick_slope: Scalar<L>,
    /// Whether the last update was at the level of rounding.
    at_floor: Mask<Scalar<L>>,
}

/// The verdict on an update in each lane.
struct Verdict<L: Effect> {
    settled: Mask<Scalar<L>>,
    doubtful: Mask<Scalar<L>>,
}

#[hot]
impl<L: Effect> Updates<L> {
    fn none() -> Self {
        Self {
            made: [Vector::<L>::zero(); MAX_UPDATES],
            lengths: [real(0.0); MAX_UPDATES],
            count: 0,
            contraction: real(0.0),
            kick_slope: real(0.0),
            at_floor: nowhere::<Scalar<L>>(),
        }
    }

    /// The update of the corrected model, from that of the model itself, `plain`.
    fn corrected(&self, plain: Vector<L>) -> Vector<L> {
        let Some(last) = self.count.checked_sub(1) else { return plain };
        let along = |k: usize, update: &Vector<L>| self.made[k].dot(update) / self.lengths[k];
        let mut update = plain;
        for k in 0..last {
            update = update + self.made[k + 1] * along(k, &update);
        }
        let one = real::<Scalar<L>>(1.0);
        update * (one / (one - along(last, &update)))
    }

    /// Records the update that has led to `half`.
    fn record(&mut self, update: Vector<L>, half: &Vector<L>) -> Verdict<L> {
        let rounding = Scalar::<L>::simd_default_epsilon();
        let (length, size) = (update.dot(&update), half.dot(half));
        let within = |roundings: f64| {
            let tolerance = rounding * real(roundings);
            size * (tolerance * tolerance)
        };
        let limit = real::<Scalar<L>>(CONTRACTION * CONTRACTION);
        let at_floor = length.simd_le(within(FLOOR));
        let mut verdict = Verdict { settled: length.simd_eq(real(0.0)), doubtful: nowhere::<Scalar<L>>() };
        if let Some(last) = self.count.checked_sub(1) {
            let ratio = length / self.lengths[last];
            let shrinks = ratio.simd_le(limit);
            // At the floor a larger ratio consists of rounding.
            self.contraction = self.contraction.simd_max(ratio.select(shrinks, limit));
            let is_enough = (length * self.contraction).simd_le(within(REST));
            verdict.settled = verdict.settled | is_enough | (at_floor & self.at_floor);
            verdict.doubtful = !(shrinks | at_floor);
        }
        self.made[self.count] = update;
        self.lengths[self.count] = length;
        self.count += 1;
        self.at_floor = at_floor;
        verdict
    }
}

#[hot]
impl<L: Effect> Problem<'_, L> {
    /// Whether the solve starts without the Jacobian.
    pub(super) fn goes_by_secants(&self) -> bool {
        L::jacobian_is_expensive(self.constants) && has_no_derivatives::<Scalar<L>>()
    }

    /// Iterates from the guess until no lane continues; in the lanes `settled` the solution passes both checks. Returns
    /// the number of residuals, too.
    pub(super) fn iterate_by_secants(&self, terms: &L::StepTerms, guess: &Vector<L>) -> (Lanes<Group<L>>, u32) {
        let model = L::Retraction::free_momentum_tangent(&self.scene.inertia(self.w), &(*guess + *guess));
        let mut lanes = Lanes::<Group<L>>::starting_at(guess);
        let mut updates = Updates::<L>::none();
        let radius = self.trusted * real(0.5);
        let in_ball = |half: &Vector<L>| half.dot(half).simd_lt(radius * radius);
        let mut doubtful = !in_ball(guess);
        let mut iterations = 0;
        while updates.count < MAX_UPDATES && !(lanes.settled | doubtful).all() {
            let Residual { momentum_defect, moving_kick } = L::newton_residual(self.constants, terms, &lanes.half);
            let update = updates.corrected(Vector::<L>::solve(&model, &(momentum_defect * real(-1.0))).0);
            let next = lanes.half + update;
            let resting = lanes.settled | doubtful;
            if let Some(kick) = moving_kick {
                let found = self.kick_has_settled(&(kick - lanes.kick.value), &update, &mut updates);
                lanes.kick.value = lanes.kick.value.select(resting, kick);
                lanes.kick.found = (lanes.kick.found & resting) | (found & !resting);
            }
            let verdict = updates.record(update, &next);
            lanes.half = lanes.half.select(resting, next);
            lanes.settled = lanes.settled | (verdict.settled & !resting);
            doubtful = doubtful | (verdict.doubtful & !resting);
            iterations += 1;
        }
        lanes.det = real(1.0);
        lanes.settled = lanes.settled & !doubtful & in_ball(&lanes.half);
        (lanes, iterations)
    }

    /// Whether this update changes the kick by less than its rounding, by the largest change per length so far.
    /// `change` is that of the last recorded update.
    fn kick_has_settled(&self, change: &Vector<L>, update: &Vector<L>, updates: &mut Updates<L>) -> Mask<Scalar<L>> {
        let Some(last) = updates.count.checked_sub(1) else { return nowhere::<Scalar<L>>() };
        updates.kick_slope = updates.kick_slope.simd_max(change.dot(change) / updates.lengths[last]);
        let tolerance = Scalar::<L>::simd_default_epsilon() * real(REST);
        (updates.kick_slope * update.dot(update)).simd_le(self.a.dot(&self.a) * (tolerance * tolerance))
    }
}
