//! Newton's iteration for the momentum equation (2.7), with a check of the branch.
//!
//! The equation has several solutions; the wanted one continues `F = I` as the right-hand side grows from zero. On the
//! way the determinant of the Jacobian never vanishes, so its sign at a solution is a necessary condition. For (3.13)
//! with a physical body `det = tr(P) tr(Fᵀ adj J_d)/h² − det J_d/h³` with `P = F J_d/h` and `det J_d ≥ 0` keeps `tr P`
//! from zero while `det > 0`, so both signs together single out the component of the identity; below 90° the
//! determinant alone does.
//!
//! Problems that this solve refuses go to the one [with fallbacks](super::careful). SIMD lanes iterate
//! [together](super::lanes), each with the bits of a scalar, except for the series of logarithms and exponentials,
//! which all lanes share.

use super::iteration::{Iterates, Iteration, MAX_ITERATIONS, Root, System, far, is_positive};
use crate::groups::Retraction;
use crate::mechanics::{Effect, Group, Scalar, Square, Vector, pattern};
use crate::numbers::{Coordinates as _, Pattern};
use nalgebra::{SimdBool as _, SimdPartialOrd as _, SimdValue as _};

/// A momentum equation with its right-hand side.
pub(crate) struct Problem<'a, L: Effect> {
    pub(crate) scene: &'a L,
    pub(crate) constants: &'a L::Constants,
    pub(crate) a: Vector<L>,
    pub(crate) w: &'a L::Advected,
    pub(crate) h: Scalar<L>,
    /// A [`safe`](super::safe) determinant for a reused Jacobian.
    pub(crate) safe: Scalar<L>,
}

/// The inlined equation of a step, so that the data of a solve can stay in registers.
pub(super) struct InlinedEquation<'a, L: Effect> {
    pub(super) constants: &'a L::Constants,
    pub(super) terms: &'a L::StepTerms,
}

#[hot]
impl<L: Effect> System<Group<L>> for InlinedEquation<'_, L> {
    fn pattern(&self) -> Pattern {
        pattern::<L>()
    }

    fn newton_update(&self, half: &Vector<L>) -> Iteration<Group<L>> {
        L::newton_update(self.constants, self.terms, half)
    }

    fn residual(&self, half: &Vector<L>) -> Vector<L> {
        L::newton_residual(self.constants, self.terms, half)
    }
}

#[hot]
impl<L: Effect> Problem<'_, L> {
    /// The solution from the guess, if it is near the identity and passes all checks.
    ///
    /// It is the solution that [`solve`](Self::solve) returns. A right-hand side whose square is above `largest` is
    /// doubtful: the Jacobian is lost in its rounding, and an update may vanish far from any solution.
    ///
    /// `REUSE` says whether a Jacobian may be [reused](super::reused_jacobian). No reference is passed to a function
    /// that isn't inlined; that saves a sixth of the time of a step.
    pub(crate) fn solve_directly<const REUSE: bool>(
        &self,
        guess: &Vector<L>,
        largest: Scalar<L>,
    ) -> Option<Root<Group<L>>> {
        let terms = L::step_terms(self.constants, &self.a, self.w);
        let equation = InlinedEquation::<L> { constants: self.constants, terms: &terms };
        if const { Scalar::<L>::LANES > 1 } {
            return self.solve_together::<REUSE>(&equation, guess, largest);
        }
        let mut lanes = Iterates::starting_at(guess);
        let iterations = lanes.iterate(
            MAX_ITERATIONS,
            #[cfg_attr(not(debug_assertions), inline(always))]
            |lanes| lanes.iterate_once::<REUSE>(&equation, self.safe),
        )?;
        self.usual(&lanes.half, lanes.det, iterations, largest)
    }

    /// The root at the end of an iteration, if it passes all checks.
    pub(super) fn usual(
        &self,
        half: &Vector<L>,
        det: Scalar<L>,
        iterations: u32,
        largest: Scalar<L>,
    ) -> Option<Root<Group<L>>> {
        let usual = is_positive(det) & self.a.dot(&self.a).simd_lt(largest);
        // The bound with a margin is tested first: most solutions satisfy it.
        let far = far::<L::Retraction, _>(half);
        if !usual.all() || far.any() && !L::Retraction::is_half_near_identity(half).all() {
            return None;
        }
        let increment = L::Retraction::increment_of_half(half);
        Some(Root { far, ..Root::of(half, increment, iterations) })
    }
}

/// [`Effect::newton_system`] for rare calls. A scene's derived code is most of a user's build, so it is compiled twice
/// only: inlined in a step, and here.
#[inline(never)]
pub(crate) fn newton_system<L: Effect>(
    constants: &L::Constants,
    terms: &L::StepTerms,
    half: &Vector<L>,
) -> (Vector<L>, Square<L>) {
    L::newton_system(constants, terms, half)
}

/// [`Effect::newton_residual`] for rare calls, as [`newton_system`].
#[inline(never)]
pub(crate) fn newton_residual<L: Effect>(
    constants: &L::Constants,
    terms: &L::StepTerms,
    half: &Vector<L>,
) -> Vector<L> {
    L::newton_residual(constants, terms, half)
}

/// [`Effect::step_terms`] for rare calls, as [`newton_system`].
#[inline(never)]
pub(crate) fn step_terms<L: Effect>(constants: &L::Constants, a: &Vector<L>, w: &L::Advected) -> L::StepTerms {
    L::step_terms(constants, a, w)
}
