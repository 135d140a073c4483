//! The two flows of the thesis: on increments, (2.5), and on momenta, (2.8).

mod euler_poincare;
mod increment;

pub use euler_poincare::{DiscreteEulerPoincare, reconstruct};
pub use increment::Increment;
pub(crate) use increment::Stepped;

use crate::error::{SetupError, StepError};
use crate::groups::{Advected, LieGroup, Retraction};
use crate::mechanics::{Effect, Group, Matrix, Regular, Scalar, Vector};
use crate::numbers::{Coordinates as _, is_finite, real, reported};
use crate::solving::{
    Kick, Problem, Root, Solvability, TurningLimits, largest_fraction, safe, six_digits, trusted_radius,
};
use nalgebra::{SimdBool as _, SimdComplexField as _, SimdPartialOrd as _, SimdRealField as _};

/// The discrete advected Lie–Poisson flow `(μ_i, w_i) ↦ (μ_{i+1}, w_{i+1})`, \[RDAE, (2.8), (2.9)\].
///
/// It is `𝔽l_d⁺ ∘ (𝔽l_d⁻)⁻¹`: Newton's iteration inverts the momentum equation (2.7).
#[derive(Clone, Debug)]
pub struct DiscreteLiePoisson<L: Effect> {
    lagrangian: L,
    h: Scalar<L>,
    constants: L::Constants,
    /// The square of a right side far beyond those of steps that have a solution.
    largest_target: Scalar<L>,
    trusted: Scalar<L>,
    /// What the Jacobian's determinant has to exceed for a solve to do without a second one.
    safe: Scalar<L>,
}

/// A momentum equation and its solution.
pub(crate) struct Solved<L: Effect> {
    /// `a = μ + kick_before(w)`.
    pub(crate) a: Vector<L>,
    pub(crate) root: Root<L>,
}

impl<L: Effect> DiscreteLiePoisson<L> {
    /// Checks the parameters and folds the constants for the step `h`, in seconds.
    ///
    /// A negative `h` is the inverse map of `−h` where `l_d` is self-adjoint; `h = 0` is the identity.
    ///
    /// # Errors
    ///
    /// [`SetupError`] for a parameter or a step that can't be used, and for a degenerate kinetic part.
    pub fn new(lagrangian: L, h: Scalar<L>) -> Result<Self, SetupError>
    where
        L: Regular,
    {
        lagrangian.validate()?;
        // 1/h and the constants made with it must be finite, unless there is no step at all.
        if !is_finite(h) || !(h == real(0.0) || is_finite(real::<Scalar<L>>(1.0) / h)) {
            return Err(SetupError::InvalidStep { step: reported(h) });
        }
        let (unit, determinant) = Vector::<L>::solve(&lagrangian.inertia(), &Vector::<L>::zero());
        if !unit.is_finite() || !determinant.simd_gt(real(0.0)).all() {
            return Err(SetupError::SingularKinetic { determinant: reported(determinant) });
        }
        let constants = lagrangian.constants(h);
        let (at_rest, trace) = jacobian_at_rest(&lagrangian, &constants);
        let safe = safe(at_rest);
        // With an extreme `h` the momentum equation and its derivatives leave the range of this scalar.
        let at_rest = (0..<Group<L> as LieGroup>::DIMENSION).fold(at_rest, |product, _| product / h);
        let is_in_range = is_finite(at_rest) && !at_rest.simd_eq(real(0.0)).any();
        if h != real(0.0) && !is_in_range {
            return Err(SetupError::InvalidStep { step: reported(h) });
        }
        // Without a step there is nothing to solve, which the careful solve sees to.
        let largest = trace / h * real(2.0 * RATIO) / Scalar::<L>::simd_default_epsilon();
        let largest_target = if h == real(0.0) { h } else { largest * largest };
        let is_dear = L::JACOBIAN_IS_DEAR && h != real(0.0);
        let trusted = if is_dear { trusted_radius(&lagrangian, &constants) } else { real(0.0) };
        Ok(Self { lagrangian, h, constants, largest_target, trusted, safe })
    }

    /// The declared Lagrangian.
    #[must_use]
    pub fn lagrangian(&self) -> &L {
        &self.lagrangian
    }

    /// The step `h`, s.
    #[must_use]
    pub fn step_size(&self) -> Scalar<L> {
        self.h
    }

    /// Solves the momentum equation (2.7) for `F`, starting at the coordinates `guess`, without falling back on
    /// another start: where the iteration settles on another branch, that is the error.
    ///
    /// # Errors
    ///
    /// [`StepError`] where there is no solution from this guess on the branch of the identity.
    pub fn invert_legendre_minus(
        &self,
        momentum: &Vector<L>,
        advected: &L::Advected,
        guess: &Vector<L>,
    ) -> Result<Group<L>, StepError> {
        if self.h == real(0.0) {
            return Ok(Group::<L>::identity());
        }
        let problem = self.problem(momentum, advected);
        let terms = L::step_terms(&self.constants, &problem.a, advected);
        problem.attempt(&terms, &(*guess * real(0.5))).map(|root| Group::<L>::from_increment(&root.increment))
    }

    /// One step from `(μ, w)`; `guess` are coordinates near those of `F`, zero if nothing is known.
    ///
    /// # Errors
    ///
    /// [`StepError`] where the momentum equation has no solution on the branch of the identity, or a value isn't
    /// finite.
    #[inline(always)]
    pub fn step(
        &self,
        momentum: &Vector<L>,
        advected: &L::Advected,
        guess: &Vector<L>,
    ) -> Result<Increment<L>, StepError> {
        self.step_from(momentum, advected, &(*guess * real(0.5))).map(|stepped| stepped.step)
    }

    /// As [`step`](Self::step), from half the guess.
    #[inline(always)]
    pub(crate) fn step_from(
        &self,
        momentum: &Vector<L>,
        advected: &L::Advected,
        half_guess: &Vector<L>,
    ) -> Result<Stepped<L>, StepError> {
        match self.step_directly(momentum, advected, half_guess) {
            Some(stepped) => Ok(stepped),
            None => self.step_carefully(momentum, advected, half_guess),
        }
    }

    /// The step, if nothing about it is doubtful.
    #[inline(always)]
    pub(crate) fn step_directly(
        &self,
        momentum: &Vector<L>,
        advected: &L::Advected,
        half_guess: &Vector<L>,
    ) -> Option<Stepped<L>> {
        let problem = self.problem(momentum, advected);
        let root = problem.solve_directly::<true>(half_guess, self.largest_target)?;
        let stepped = self.moved(momentum, advected, &problem.a, &root);
        // A finite sum has finite terms. Where it isn't, it may have overflowed.
        is_finite(stepped.total()).then_some(stepped)
    }

    /// The step, or why there is none.
    #[cold]
    #[inline(never)]
    pub(crate) fn step_carefully(
        &self,
        momentum: &Vector<L>,
        advected: &L::Advected,
        half_guess: &Vector<L>,
    ) -> Result<Stepped<L>, StepError> {
        if self.h == real(0.0) {
            return Ok(Self::stand_still(momentum, advected));
        }
        let root = self.solve_carefully(momentum, advected, half_guess)?;
        let stepped = self.moved(momentum, advected, &kicked::<L>(&self.constants, momentum, advected), &root);
        if stepped.step.momentum.is_finite() && stepped.step.advected.is_finite() {
            Ok(stepped)
        } else {
            Err(StepError::NonFinite { what: "momentum after the step" })
        }
    }

    /// By `F` from `(μ, w)`, with `a = μ + kick_before(w)`.
    #[inline(always)]
    fn moved(&self, momentum: &Vector<L>, advected: &L::Advected, a: &Vector<L>, root: &Root<L>) -> Stepped<L> {
        let Root { half, increment, iterations, far, ref kick } = *root;
        let next = advected.advect(&increment);
        let mut change = Group::<L>::adjoint_transpose_increment(&increment, a);
        if L::PARTS.kick_before {
            change = change + (*a - *momentum);
        }
        if L::PARTS.kick_after {
            change = change + self.kick_after(&increment, &next, kick);
        }
        let momentum = *momentum + change;
        let step = Increment { coordinates: half + half, increment, momentum, advected: next, iterations };
        Stepped { step, half, far }
    }

    /// `kick_after(F, w⁺)`, in the lanes that have come by it from what the solve has found.
    #[inline(always)]
    fn kick_after(&self, increment: &Matrix<L>, next: &L::Advected, kick: &Kick<L>) -> Vector<L> {
        let direct = || L::kick_after(&self.constants, increment, next);
        if !L::JACOBIAN_IS_DEAR || !kick.found.any() {
            return direct();
        }
        let mut found = kick.value + Group::<L>::adjoint_transpose_increment(increment, &kick.value);
        if let Some(beside) = L::kick_beside(&self.constants, increment, next) {
            found = found + beside;
        }
        if kick.found.all() { found } else { found.select(kick.found, direct()) }
    }

    /// `F` of the step from `(μ, w)`; the guess is of half the coordinates.
    #[inline(always)]
    pub(crate) fn solve(
        &self,
        momentum: &Vector<L>,
        advected: &L::Advected,
        half_guess: &Vector<L>,
    ) -> Result<Solved<L>, StepError> {
        let problem = self.problem(momentum, advected);
        let root = match problem.solve_directly::<true>(half_guess, self.largest_target) {
            Some(root) => root,
            None => self.solve_carefully(momentum, advected, half_guess)?,
        };
        Ok(Solved { a: problem.a, root })
    }

    /// Both kicks of a step from `w` to `next`.
    #[inline(always)]
    pub(crate) fn kicks(
        &self,
        w: &L::Advected,
        increment: &Matrix<L>,
        next: &L::Advected,
        kick: &Kick<L>,
    ) -> Vector<L> {
        match (L::PARTS.kick_before, L::PARTS.kick_after) {
            (true, true) => L::kick_before(&self.constants, w) + self.kick_after(increment, next, kick),
            (true, false) => L::kick_before(&self.constants, w),
            (false, true) => self.kick_after(increment, next, kick),
            (false, false) => Vector::<L>::zero(),
        }
    }

    #[inline(always)]
    fn problem<'a>(&'a self, momentum: &Vector<L>, w: &'a L::Advected) -> Problem<'a, L> {
        Problem {
            lagrangian: &self.lagrangian,
            constants: &self.constants,
            a: kicked::<L>(&self.constants, momentum, w),
            w,
            h: self.h,
            trusted: self.trusted,
            safe: self.safe,
        }
    }

    #[cold]
    fn stand_still(momentum: &Vector<L>, advected: &L::Advected) -> Stepped<L> {
        let Root { half, increment, iterations, far, .. } = Root::<L>::at(&Vector::<L>::zero(), 0);
        let step = Increment { coordinates: half, increment, momentum: *momentum, advected: *advected, iterations };
        Stepped { step, half, far }
    }

    /// The solve with all its fallbacks, from the beginning.
    #[cold]
    #[inline(never)]
    fn solve_carefully(
        &self,
        momentum: &Vector<L>,
        advected: &L::Advected,
        half_guess: &Vector<L>,
    ) -> Result<Root<L>, StepError> {
        let is_finite = momentum.is_finite() && advected.is_finite();
        if is_finite && self.solvability(momentum, advected) == Solvability::Impossible {
            let largest = reported(self.max_step(momentum, advected));
            return Err(StepError::BeyondSolvable { step: reported(self.h), largest: six_digits(largest) });
        }
        self.problem(momentum, advected).solve(half_guess).map_err(|error| self.explain(error, momentum, advected))
    }

    /// Finds out whether a smaller step would do, which turns a failed solve into the error that says so.
    fn explain(&self, error: StepError, momentum: &Vector<L>, advected: &L::Advected) -> StepError {
        if !momentum.is_finite() {
            return StepError::NonFinite { what: "momentum" };
        }
        if !advected.is_finite() {
            return StepError::NonFinite { what: "advected parameter" };
        }
        let largest = self.max_step(momentum, advected);
        if largest == real(0.0) {
            return error;
        }
        StepError::BeyondSolvable { step: reported(self.h), largest: six_digits(reported(largest)) }
    }

    /// Whether the step from `(μ, w)` surely has a solution or surely has none, where bounds are known: for the kinetic
    /// part of (3.13) and potentials of the positions, with `a = μ + (h/2) τ`, below `h|a| = J_min` and above `J_max`.
    ///
    /// A step asks only when its solve hasn't succeeded at once, so that the steps that do cost nothing more.
    #[must_use]
    pub fn solvability(&self, momentum: &Vector<L>, advected: &L::Advected) -> Solvability {
        let decide = |limits: TurningLimits| limits.decide(Self::size(self.h, &self.constants, momentum, advected));
        self.turning_limits(advected).map_or(Solvability::Open, decide)
    }

    /// `|h a|`.
    fn size(h: Scalar<L>, constants: &L::Constants, momentum: &Vector<L>, advected: &L::Advected) -> f64 {
        let turn = kicked::<L>(constants, momentum, advected) * h;
        reported(turn.dot(&turn).simd_sqrt())
    }

    /// The bounds for this `w`, at this step and at half of it: a kinetic part that depends on `h` in another way isn't
    /// the one that they are proved for.
    fn turning_limits(&self, advected: &L::Advected) -> Option<TurningLimits> {
        let at = |h: Scalar<L>| {
            let constants = self.lagrangian.constants(h);
            let terms = L::step_terms(&constants, &Vector::<L>::zero(), advected);
            let unknown = |f: &Group<L>| {
                let xi = L::Retraction::local_coordinates(f)?;
                let half = xi * real(0.5);
                let factor = (real::<Scalar<L>>(1.0) + half.dot(&half)).simd_powi(L::DENOMINATORS.cast_signed());
                Some(L::newton_system(&constants, &terms, &half).0 * (real::<Scalar<L>>(2.0) / factor))
            };
            Group::<L>::turning_limits(&unknown, &self.lagrangian.inertia())
        };
        at(self.h * real(0.5)).and(at(self.h))
    }

    /// The largest fraction of this step, in seconds, whose momentum equation has a solution, to six digits.
    ///
    /// It is found by bisection between zero and `h`, so it costs up to some dozens of solves, fewer where the bounds
    /// of [`solvability`](Self::solvability) decide.
    #[must_use]
    pub fn max_step(&self, momentum: &Vector<L>, advected: &L::Advected) -> Scalar<L> {
        let limits = self.turning_limits(advected);
        let solvable = |fraction: f64| {
            let h = self.h * real(fraction);
            let constants = self.lagrangian.constants(h);
            match limits.map(|limits| limits.decide(Self::size(h, &constants, momentum, advected))) {
                Some(Solvability::Certain) => return true,
                Some(Solvability::Impossible) => return false,
                Some(Solvability::Open) | None => {}
            }
            let a = kicked::<L>(&constants, momentum, advected);
            let lagrangian = &self.lagrangian;
            let problem = Problem {
                lagrangian,
                constants: &constants,
                a,
                w: advected,
                h,
                trusted: self.trusted,
                safe: self.safe,
            };
            let terms = L::step_terms(&constants, &a, advected);
            problem.attempt(&terms, &Vector::<L>::zero()).is_ok()
        };
        largest_fraction(solvable).map_or(real(0.0), |fraction| self.h * real(fraction))
    }
}

/// `a = μ + kick_before(w)`.
#[inline(always)]
fn kicked<L: Effect>(constants: &L::Constants, momentum: &Vector<L>, w: &L::Advected) -> Vector<L> {
    if L::PARTS.kick_before { *momentum + L::kick_before(constants, w) } else { *momentum }
}

/// The Newton Jacobian is that at rest and, from the right side, a matrix of rank one. Up to this part of `1/ε` times
/// the former, `10¹²` times in `f64`, the rounding of the latter doesn't reach it.
const RATIO: f64 = 1.0 / 4096.0;

/// Determinant and trace of the Newton system for a body at rest.
fn jacobian_at_rest<L: Effect>(lagrangian: &L, constants: &L::Constants) -> (Scalar<L>, Scalar<L>) {
    let zero = Vector::<L>::zero();
    let terms = L::step_terms(constants, &zero, &lagrangian.advected());
    let (_, jacobian) = L::newton_system(constants, &terms, &zero);
    (Vector::<L>::solve(&jacobian, &zero).1, Vector::<L>::trace(&jacobian))
}
