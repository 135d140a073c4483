//! Newton's iteration for the momentum equation (2.7), with a check of the branch.
//!
//! The equation has several solutions (four for a free asymmetric body at small `h`); the wanted one continues
//! `F = I` as the right side grows from zero. On the way the determinant of the Jacobian never vanishes, so its sign
//! at a solution tells. For (3.13) with a physical body more is known: `det = tr(P) tr(Fᵀ adj J_d)/h² − det J_d/h³` with
//! `P = F J_d/h` and `det J_d ≥ 0` keeps `tr P` from zero while `det > 0`, so determinant and trace together single out
//! the component of the identity. Below 90° there is at most one solution, and the determinant alone decides.

use crate::coordinates::Coordinates;
use crate::effect::{Effect, Matrix, Scalar, Vector};
use crate::error::StepError;
use crate::retraction::Retraction;
use crate::scalar::{Real, real, reported};
use nalgebra::{SimdBool as _, SimdComplexField as _, SimdPartialOrd as _, SimdRealField as _, SimdValue as _};

/// Quadratic convergence needs at most nine up to 0.999 of the fold; more means that there is no solution.
const MAX_ITERATIONS: u32 = 20;
/// The damped retry shortens its steps, and so needs more of them.
const MAX_DAMPED_ITERATIONS: u32 = 60;

/// A solution of the momentum equation.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Root<L: Effect> {
    /// Coordinates of `F`.
    pub(crate) xi: Vector<L>,
    /// `F − I`.
    pub(crate) increment: Matrix<L>,
    /// Newton iterations, those of abandoned attempts included.
    pub(crate) iterations: u32,
}

/// One momentum equation to be solved.
pub(crate) struct Problem<'a, L: Effect> {
    pub(crate) lagrangian: &'a L,
    pub(crate) constants: &'a L::Constants,
    pub(crate) a: Vector<L>,
    pub(crate) w: &'a L::Advected,
    pub(crate) h: Scalar<L>,
    /// The sign of the Jacobian's determinant at the identity.
    pub(crate) orientation: Scalar<L>,
}

impl<L: Effect> Problem<'_, L> {
    /// The solution from the guess, if it is near the identity and nothing is doubtful.
    ///
    /// What it returns is what [`solve`](Self::solve) returns. Nothing here is lent to a function that isn't inlined,
    /// so that all of it can stay in registers; that is a sixth of the time of a step.
    #[inline(always)]
    pub(crate) fn solve_directly(&self, guess: &Vector<L>) -> Option<Root<L>> {
        let terms = L::step_terms(self.constants, &self.a, self.w);
        let mut xi = *guess;
        for iteration in 0..MAX_ITERATIONS {
            let (update, det) = self.update(&terms, &xi);
            xi = xi - update;
            if settled::<L>(&update, &xi) {
                if !self.is_oriented(det) || !L::Retraction::is_near_identity(&xi) {
                    return None;
                }
                let increment = L::Retraction::increment(&xi);
                return Some(Root { xi, increment, iterations: iteration + 1 });
            }
        }
        None
    }

    /// From the guess; if that fails from the identity; if that fails, once more with shortened steps.
    pub(crate) fn solve(&self, guess: &Vector<L>) -> Result<Root<L>, StepError> {
        if !self.a.is_finite() {
            return Err(StepError::NonFinite { what: "momentum" });
        }
        let terms = L::step_terms(self.constants, &self.a, self.w);
        if let Ok(root) = self.attempt(&terms, guess) {
            return Ok(root);
        }
        let cold = Vector::<L>::zero();
        self.attempt(&terms, &cold).or_else(|_| self.attempt_damped(&terms, &cold)).map(|mut root| {
            root.iterations += MAX_ITERATIONS;
            root
        })
    }

    /// Newton's iteration from one guess, refused where it settles on another branch.
    pub(crate) fn attempt(&self, terms: &L::StepTerms, guess: &Vector<L>) -> Result<Root<L>, StepError> {
        let mut xi = *guess;
        for iteration in 1..=MAX_ITERATIONS {
            let (update, det) = self.update(terms, &xi);
            xi = xi - update;
            if settled::<L>(&update, &xi) {
                return self.accept(xi, det, iteration);
            }
        }
        Err(self.failure(terms, &xi, MAX_ITERATIONS))
    }

    /// As [`attempt`](Self::attempt), with no update longer than half a radian.
    fn attempt_damped(&self, terms: &L::StepTerms, guess: &Vector<L>) -> Result<Root<L>, StepError> {
        let mut xi = *guess;
        for iteration in 1..=MAX_DAMPED_ITERATIONS {
            let (update, det) = self.update(terms, &xi);
            let length = update.dot(&update).simd_sqrt();
            let half = real::<Scalar<L>>(0.5);
            let shortened = length.simd_gt(half);
            let factor = (half / length).select(shortened, real(1.0));
            xi = xi - update * factor;
            if settled::<L>(&update, &xi) {
                return self.accept(xi, det, iteration);
            }
        }
        Err(self.failure(terms, &xi, MAX_DAMPED_ITERATIONS))
    }

    #[inline(always)]
    fn update(&self, terms: &L::StepTerms, xi: &Vector<L>) -> (Vector<L>, Scalar<L>) {
        let (residual, jacobian) = L::newton_system(self.constants, terms, xi);
        Vector::<L>::solve(&jacobian, &residual)
    }

    #[inline(always)]
    fn is_oriented(&self, det: Scalar<L>) -> bool {
        (det * self.orientation).simd_gt(real(0.0)).all()
    }

    fn accept(&self, xi: Vector<L>, det: Scalar<L>, iterations: u32) -> Result<Root<L>, StepError> {
        if !self.is_oriented(det) {
            return Err(StepError::WrongBranch { determinant: reported(det) });
        }
        let increment = L::Retraction::increment(&xi);
        if !L::Retraction::is_near_identity(&xi) {
            self.look_closer(&xi)?;
        }
        Ok(Root { xi, increment, iterations })
    }

    /// Far from the identity the trace of the right-trivialised Jacobian must have kept its sign too.
    fn look_closer(&self, xi: &Vector<L>) -> Result<(), StepError> {
        use crate::groups::LieGroup as _;
        let f = L::Retraction::retract(xi).matrix();
        let jacobian = self.lagrangian.momentum_jacobian(&f, self.w, self.h);
        let (_, det) = Vector::<L>::solve(&jacobian, &self.a);
        let trace = Vector::<L>::trace(&jacobian) * self.h;
        if self.is_oriented(det) && trace.simd_gt(real(0.0)).all() {
            Ok(())
        } else {
            Err(StepError::WrongBranch { determinant: reported(det) })
        }
    }

    fn failure(&self, terms: &L::StepTerms, xi: &Vector<L>, iterations: u32) -> StepError {
        let (update, det) = self.update(terms, xi);
        if !xi.is_finite() || det == real(0.0) {
            return StepError::Singular;
        }
        let residual = reported((update.dot(&update) / xi.dot(xi)).simd_sqrt());
        StepError::NotConverged { iterations, residual }
    }
}

/// Whether the next update would be below rounding.
///
/// Convergence is quadratic: a relative update of `√ε/8` is followed by one of the order of `ε/64`. Stopping earlier
/// would make the energy drift; the residual can't be used, as it stagnates at its rounding floor.
#[inline(always)]
fn settled<L: Effect>(update: &Vector<L>, xi: &Vector<L>) -> bool {
    let tolerance = Scalar::<L>::simd_default_epsilon() * real(1.0 / 64.0);
    update.dot(update).simd_le(xi.dot(xi) * tolerance).all()
}

/// The sign that the Jacobian's determinant has at the identity: that of `h^d`, as the inertia is positive.
pub(crate) fn orientation<T: Real>(h: T, dimension: usize) -> T {
    let sign = real::<T>(1.0).simd_copysign(h);
    if dimension.is_multiple_of(2) { sign * sign } else { sign }
}
