//! The two flows of the thesis: on increments, (2.5), and on momenta, (2.8).

use crate::advected::Advected;
use crate::coordinates::Coordinates as _;
use crate::error::{SetupError, StepError};
use crate::groups::LieGroup;
use crate::lagrangian::{DiscreteLagrangian, Group, Scalar, Vector};
use crate::newton::{Problem, Root, orientation, trusted_radius};
use crate::retraction::Retraction;
use crate::scalar::{is_finite, real, reported};
use nalgebra::{SimdBool as _, SimdPartialOrd as _};

/// The discrete advected Lie–Poisson flow `(μ_i, w_i) ↦ (μ_{i+1}, w_{i+1})`, \[RDAE, (2.8), (2.9)\].
///
/// It is `𝔽l_d⁺ ∘ (𝔽l_d⁻)⁻¹`: Newton's iteration inverts the momentum equation (2.7).
#[derive(Clone, Debug)]
pub struct DiscreteLiePoisson<L: DiscreteLagrangian> {
    lagrangian: L,
    h: Scalar<L>,
    constants: L::Constants,
    orientation: Scalar<L>,
    trusted: Scalar<L>,
}

/// One application of a flow.
#[derive(Clone, Copy, Debug)]
pub struct Increment<L: DiscreteLagrangian> {
    /// The coordinates `ξ` of `F_i = τ(ξ)`: a guess for the next solve.
    pub coordinates: Vector<L>,
    /// `F_i − I`.
    pub increment: <Group<L> as LieGroup>::Matrix,
    /// `μ_{i+1}`.
    pub momentum: Vector<L>,
    /// `w_{i+1}`.
    pub advected: L::Advected,
    /// Newton iterations, counted as in [`StepReport`](crate::StepReport).
    pub iterations: u32,
}

impl<L: DiscreteLagrangian> Increment<L> {
    /// `F_i`.
    #[must_use]
    pub fn element(&self) -> Group<L> {
        Group::<L>::from_increment(&self.increment)
    }
}

impl<L: DiscreteLagrangian> DiscreteLiePoisson<L> {
    /// Checks the parameters and folds the constants for the step `h`, in seconds.
    ///
    /// A negative `h` is the inverse map of `−h` where `l_d` is self-adjoint; `h = 0` is the identity.
    ///
    /// # Errors
    ///
    /// [`SetupError`] for a parameter or a step that can't be used, and for a degenerate kinetic part.
    pub fn new(lagrangian: L, h: Scalar<L>) -> Result<Self, SetupError> {
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
        let orientation = orientation(h, <Group<L> as LieGroup>::DIMENSION);
        let mut flow = Self { lagrangian, h, constants, orientation, trusted: real(0.0) };
        if flow.h == real(0.0) {
            return Ok(flow);
        }
        if !flow.is_in_range() {
            return Err(SetupError::InvalidStep { step: reported(h) });
        }
        if L::JACOBIAN_IS_DEAR {
            flow.trusted = trusted_radius(&flow.lagrangian, &flow.constants, h);
        }
        Ok(flow)
    }

    /// Whether the Newton system at rest can be solved in this scalar: with an extreme `h` its determinant can't.
    fn is_in_range(&self) -> bool {
        let zero = Vector::<L>::zero();
        let terms = L::step_terms(&self.constants, &zero, &self.lagrangian.advected());
        let (_, jacobian) = L::newton_system(&self.constants, &terms, &zero);
        let (_, determinant) = Vector::<L>::solve(&jacobian, &zero);
        is_finite(determinant) && !determinant.simd_eq(real(0.0)).any()
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
        problem.attempt(&terms, guess).map(|root| Group::<L>::from_increment(&root.increment))
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
        if self.h == real(0.0) {
            return Ok(Self::stand_still(momentum, advected));
        }
        let problem = self.problem(momentum, advected);
        let Root { xi, increment, iterations } = match problem.solve_directly(guess) {
            Some(root) => root,
            None => self.solve_carefully(momentum, advected, guess)?,
        };
        let next = advected.advect(&increment);
        let momentum = *momentum
            + (Group::<L>::adjoint_transpose_increment(&increment, &problem.a)
                + (problem.a - *momentum)
                + L::kick_after(&self.constants, &increment, &next));
        if momentum.is_finite() && next.is_finite() {
            Ok(Increment { coordinates: xi, increment, momentum, advected: next, iterations })
        } else {
            Err(StepError::NonFinite { what: "momentum after the step" })
        }
    }

    #[inline(always)]
    fn problem<'a>(&'a self, momentum: &Vector<L>, w: &'a L::Advected) -> Problem<'a, L> {
        Problem {
            lagrangian: &self.lagrangian,
            constants: &self.constants,
            a: *momentum + L::kick_before(&self.constants, w),
            w,
            h: self.h,
            orientation: self.orientation,
            trusted: self.trusted,
        }
    }

    #[cold]
    fn stand_still(momentum: &Vector<L>, advected: &L::Advected) -> Increment<L> {
        let coordinates = Vector::<L>::zero();
        let increment = L::Retraction::increment(&coordinates);
        Increment { coordinates, increment, momentum: *momentum, advected: *advected, iterations: 0 }
    }

    /// The solve with all its fallbacks, from the beginning.
    #[cold]
    #[inline(never)]
    fn solve_carefully(
        &self,
        momentum: &Vector<L>,
        advected: &L::Advected,
        guess: &Vector<L>,
    ) -> Result<Root<L>, StepError> {
        self.problem(momentum, advected).solve(guess).map_err(|error| self.explain(error, momentum, advected))
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

    /// The largest fraction of this step, in seconds, whose momentum equation has a solution, to six digits.
    ///
    /// It is found by bisection between zero and `h`, so it costs some dozens of solves. For (3.13) and a physical
    /// body `h |p + (h/2) τ| < J_min` surely has a solution and `> J_max` surely has none.
    #[must_use]
    pub fn max_step(&self, momentum: &Vector<L>, advected: &L::Advected) -> Scalar<L> {
        let solvable = |fraction: f64| {
            let h = self.h * real(fraction);
            let constants = self.lagrangian.constants(h);
            let a = *momentum + L::kick_before(&constants, advected);
            let lagrangian = &self.lagrangian;
            let (orientation, trusted) = (self.orientation, self.trusted);
            let problem = Problem { lagrangian, constants: &constants, a, w: advected, h, orientation, trusted };
            let terms = L::step_terms(&constants, &a, advected);
            problem.attempt(&terms, &Vector::<L>::zero()).is_ok()
        };
        if solvable(1.0) {
            return self.h;
        }
        // Halving down to a solvable fraction first keeps the digits where only a tiny one is.
        let mut low = 1.0;
        while !solvable(low) {
            low *= 0.5;
            if low < 1e-30 {
                return real(0.0);
            }
        }
        let mut high = 2.0 * low;
        while high - low > 1e-6 * high {
            let middle = 0.5 * (low + high);
            if solvable(middle) { low = middle } else { high = middle }
        }
        self.h * real(low)
    }
}

/// The discrete advected Euler–Poincaré flow `(f_i, w_i) ↦ (f_{i+1}, w_{i+1})`, \[RDAE, (2.5)\].
#[derive(Clone, Debug)]
pub struct DiscreteEulerPoincare<L: DiscreteLagrangian> {
    flow: DiscreteLiePoisson<L>,
}

impl<L: DiscreteLagrangian> DiscreteEulerPoincare<L> {
    /// Checks the parameters and folds the constants for the step `h`, in seconds.
    ///
    /// # Errors
    ///
    /// As [`DiscreteLiePoisson::new`].
    pub fn new(lagrangian: L, h: Scalar<L>) -> Result<Self, SetupError> {
        DiscreteLiePoisson::new(lagrangian, h).map(|flow| Self { flow })
    }

    /// One step: `w⁺ = f⁻¹·w`, and `f⁺` with `𝔽l_d⁻(f⁺, w⁺) = 𝔽l_d⁺(f, w)`.
    ///
    /// # Errors
    ///
    /// [`StepError`] where that equation has no solution on the branch of the identity.
    pub fn step(&self, f: &Group<L>, w: &L::Advected) -> Result<(Group<L>, L::Advected), StepError> {
        let momentum = self.flow.lagrangian.legendre_plus(&f.matrix(), w, self.flow.h);
        let next = w.advect(&f.increment());
        let guess = L::Retraction::local_coordinates(f).unwrap_or_else(Vector::<L>::zero);
        let step = self.flow.step(&momentum, &next, &guess)?;
        Ok((step.element(), next))
    }
}

/// The reconstruction `g_{i+1} = g_i f_i`, \[RDAE, (2.10)\].
#[must_use]
pub fn reconstruct<G: LieGroup>(g: &G, f: &G) -> G {
    g.advance(&f.increment())
}

/// Rounded towards zero, as a step a little larger than the largest wouldn't do.
fn six_digits(step: f64) -> f64 {
    let unit = 10.0_f64.powf(5.0 - step.abs().log10().floor());
    (step * unit).trunc() / unit
}
