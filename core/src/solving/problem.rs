//! Newton's iteration for the momentum equation (2.7), with a check of the branch.
//!
//! The equation has several solutions; the wanted one continues `F = I` as the right side grows from zero. On the way the
//! determinant of the Jacobian never vanishes, so its sign at a solution tells. For (3.13) with a physical body
//! `det = tr(P) tr(Fᵀ adj J_d)/h² − det J_d/h³` with `P = F J_d/h` and `det J_d ≥ 0` keeps `tr P` from zero while
//! `det > 0`, so both together single out the component of the identity; below 90° the determinant alone does.
//!
//! What this can't solve at once is solved [with care](super::careful). SIMD lanes iterate [together](super::lanes), each
//! with the bits of a scalar, but for the series of logarithms and exponentials, which all share.

use super::iteration::{Iteration, Lanes, MAX_ITERATIONS, Root, System, far, is_positive};
use crate::groups::Retraction;
use crate::mechanics::{Effect, Group, Scalar, Square, Vector, pattern};
use crate::numbers::{Coordinates as _, Pattern};
use nalgebra::{SimdBool as _, SimdPartialOrd as _, SimdValue as _};

/// One momentum equation to be solved.
pub(crate) struct Problem<'a, L: Effect> {
    pub(crate) scene: &'a L,
    pub(crate) constants: &'a L::Constants,
    pub(crate) a: Vector<L>,
    pub(crate) w: &'a L::Advected,
    pub(crate) h: Scalar<L>,
    /// [`trusted_radius`](super::trusted_radius), or zero.
    pub(crate) trusted: Scalar<L>,
    /// A [`safe`](super::safe) determinant.
    pub(crate) safe: Scalar<L>,
}

/// The equation where steps are made: inlined, so that all of a solve can stay in registers.
pub(super) struct InlinedEquation<'a, L: Effect> {
    pub(super) constants: &'a L::Constants,
    pub(super) terms: &'a L::StepTerms,
}

#[hot]
impl<L: Effect> System<Group<L>> for InlinedEquation<'_, L> {
    fn pattern(&self) -> Pattern {
        pattern::<L>(self.constants)
    }

    fn newton_update(&self, half: &Vector<L>) -> Iteration<Group<L>> {
        L::newton_update(self.constants, self.terms, half)
    }

    fn residual(&self, half: &Vector<L>) -> Vector<L> {
        L::newton_residual(self.constants, self.terms, half).momentum_defect
    }
}

#[hot]
impl<L: Effect> Problem<'_, L> {
    /// The solution from the guess, if it is near the identity and nothing is doubtful.
    ///
    /// What it returns is what [`solve`](Self::solve) returns. A right side whose square is above `largest` is
    /// doubtful: the Jacobian is lost in its rounding, and an update may vanish far from any solution.
    ///
    /// `REUSE` says whether a Jacobian may be [reused](super::reused_jacobian). Nothing here is lent to a function that isn't inlined; that is a sixth of the time of a step.
    pub(crate) fn solve_directly<const REUSE: bool>(
        &self,
        guess: &Vector<L>,
        largest: Scalar<L>,
    ) -> Option<Root<Group<L>>> {
        let terms = L::step_terms(self.constants, &self.a, self.w);
        if const { L::JACOBIAN_IS_EXPENSIVE } && self.goes_by_secants() {
            let (lanes, iterations) = self.iterate_by_secants(&terms, guess);
            return lanes.settled.all().then(|| lanes.root::<L::Retraction>(iterations));
        }
        let equation = InlinedEquation::<L> { constants: self.constants, terms: &terms };
        if const { Scalar::<L>::LANES > 1 } {
            return self.solve_together::<REUSE>(&equation, guess, largest);
        }
        let mut lanes = Lanes::starting_at(guess);
        let iterations = lanes.iterate(
            MAX_ITERATIONS,
            #[cfg_attr(not(debug_assertions), inline(always))]
            |lanes| lanes.iterate_once::<REUSE>(&equation, self.safe),
        )?;
        self.usual(&lanes.half, lanes.det, iterations, largest)
    }

    /// What an iteration has settled on, if nothing about it is doubtful.
    pub(super) fn usual(
        &self,
        half: &Vector<L>,
        det: Scalar<L>,
        iterations: u32,
        largest: Scalar<L>,
    ) -> Option<Root<Group<L>>> {
        let usual = is_positive(det) & self.a.dot(&self.a).simd_lt(largest);
        // Most are nearer than they have to be.
        let far = far::<L::Retraction, _>(half);
        if !usual.all() || far.any() && !L::Retraction::is_half_near_identity(half).all() {
            return None;
        }
        let increment = L::Retraction::increment_of_half(half);
        Some(Root { far, ..Root::of(half, increment, iterations) })
    }
}

/// [`Effect::newton_system`] for what is seldom asked. A scene has it inlined where steps are made and here, and no
/// third time: its derived code is most of what a user's build compiles.
#[inline(never)]
pub(crate) fn newton_system<L: Effect>(
    constants: &L::Constants,
    terms: &L::StepTerms,
    half: &Vector<L>,
) -> (Vector<L>, Square<L>) {
    L::newton_system(constants, terms, half)
}

/// [`Effect::step_terms`] for what is seldom asked, as [`newton_system`].
#[inline(never)]
pub(crate) fn step_terms<L: Effect>(constants: &L::Constants, a: &Vector<L>, w: &L::Advected) -> L::StepTerms {
    L::step_terms(constants, a, w)
}
