//! A solve of SIMD lanes that all need the same iterations.
//!
//! They nearly always do: bodies of one kind at one step need as many iterations. Then no lane has to be protected from
//! updates of the others, and nothing is selected by masks. That matters most for lanes which are arrays: their mask is
//! a truth value for each lane, and selecting by it takes vectors apart and puts them together again.
//!
//! If the lanes part, they continue with masks from the current iterate.

use core::hint::black_box;

use super::iteration::{Iterates, MAX_ITERATIONS, Root, System, settled};
use super::problem::{InlinedEquation, Problem};
use super::reused_jacobian::{has_no_derivatives, has_sufficed, may_suffice};
use crate::mechanics::{Effect, Group, Scalar, Vector};
use crate::numbers::Coordinates as _;
use nalgebra::{SimdBool as _, SimdPartialOrd as _};

impl<L: Effect> Problem<'_, L> {
    /// [`solve_directly`](Self::solve_directly) for several lanes, with equal digits.
    #[hot]
    pub(super) fn solve_together<const REUSE: bool>(
        &self,
        equation: &InlinedEquation<'_, L>,
        guess: &Vector<L>,
        largest: Scalar<L>,
    ) -> Option<Root<Group<L>>> {
        let made = equation.newton_update(guess);
        let half = *guess - made.update;
        let first = made.update.dot(&made.update);
        let settled = settled::<Group<L>>(&made.update, &half);
        if settled.all() {
            return self.usual(&half, made.det, 1, largest);
        }
        let mut started = None;
        // Repeats `reuse_jacobian`: with one function for both, lanes were a quarter slower.
        if REUSE
            && has_no_derivatives::<Scalar<L>>()
            && let Some(factors) = &made.factors
        {
            let is_near = may_suffice(first, half.dot(&half)) & made.det.simd_gt(self.safe) & !settled;
            if is_near.all() {
                let second = equation.simplified(factors, made.det, &half);
                let half = half - second;
                let settled = has_sufficed(first, second.dot(&second), half.dot(&half));
                if settled.all() {
                    return self.usual(&half, made.det, 2, largest);
                }
                // The iterates pass through memory. Otherwise the compiler mixes the code with masks into the code
                // above, which takes half as long again.
                let (half, det, settled) = black_box((half, made.det, settled));
                started = Some(Iterates { half, det, settled });
            }
        }
        let (mut lanes, again) = if let Some(lanes) = started {
            (lanes, false)
        } else {
            let (made, mut lanes) = (black_box(made), Iterates::starting_at(guess));
            lanes.advance(&made.update, made.det, &made.update);
            let again = lanes.reuse_jacobian::<REUSE>(equation, &made, self.safe);
            (lanes, again)
        };
        let iterations = if lanes.settled.all() {
            1 + u32::from(again)
        } else {
            1 + lanes.iterate(
                MAX_ITERATIONS - 1,
                #[cfg_attr(not(debug_assertions), inline(always))]
                |lanes| lanes.iterate_once::<REUSE>(equation, self.safe),
            )?
        };
        self.usual(&lanes.half, lanes.det, iterations, largest)
    }
}
