//! The solve with all its fallbacks, for steps that the usual solve doesn't settle.
//!
//! It calls a scene through a table of functions, and so is compiled once for a group and its scalars: a build compiles
//! only the equation for each scene.

use core::marker::PhantomData;

use super::constrained::{bordered, with_constraints};
use super::iteration::{
    Iterates, Iteration, LONGEST_DAMPED, MAX_DAMPED_ITERATIONS, MAX_ITERATIONS, MOST_HALVINGS, Root, System,
    is_positive,
};
use super::problem::{Problem, newton_system, step_terms};
use crate::error::StepError;
use crate::groups::{LieGroup, Retraction, SquareOf};
use crate::mechanics::{Effect, Group, NewtonUpdate, Square, Vector, pattern, update_of};
use crate::numbers::{Coordinates as _, Mask, Pattern, nowhere, real, reported};
use nalgebra::{SimdBool as _, SimdComplexField as _, SimdPartialOrd as _, SimdRealField as _, SimdValue as _};

impl<L: Effect> Problem<'_, L> {
    /// Solves from the guess; if that fails, from the identity; if that fails, once more with shortened updates.
    pub(crate) fn solve(&self, guess: &Vector<L>) -> Result<Root<Group<L>>, StepError> {
        if !self.a.is_finite() {
            return Err(StepError::NonFinite { what: "momentum" });
        }
        CalledEquation::new(self).careful().solve(guess)
    }

    /// Newton's iteration from one guess; a solution on another branch is an error.
    pub(crate) fn attempt(&self, guess: &Vector<L>) -> Result<Root<Group<L>>, StepError> {
        CalledEquation::new(self).careful().attempt(guess)
    }
}

/// The residuals and Jacobians of a momentum equation that check a doubtful solution.
trait Equation<G: LieGroup>: System<G> {
    /// The residual and the Jacobian.
    fn newton_system(&self, half: &G::Vector) -> (G::Vector, SquareOf<G>);

    /// The residual and the Jacobian for a right-hand side of zero.
    fn unforced_system(&self, half: &G::Vector) -> (G::Vector, SquareOf<G>);

    /// `h` times the [right-trivialised Jacobian](Effect::momentum_jacobian). None if neighbours are coupled: it lacks
    /// the blocks between them.
    fn momentum_jacobian(&self, half: &G::Vector) -> Option<SquareOf<G>>;
}

/// The equation of a [`Problem`], by functions that aren't inlined.
struct CalledEquation<'a, L: Effect> {
    problem: &'a Problem<'a, L>,
    terms: L::StepTerms,
}

impl<'a, L: Effect> CalledEquation<'a, L> {
    fn new(problem: &'a Problem<'a, L>) -> Self {
        Self { problem, terms: step_terms::<L>(problem.constants, &problem.a, problem.w) }
    }

    fn careful(&self) -> CarefulSolve<'_, Group<L>, L::Retraction> {
        CarefulSolve { equation: self, safe: self.problem.safe, retraction: PhantomData }
    }
}

impl<L: Effect> System<Group<L>> for CalledEquation<'_, L> {
    fn pattern(&self) -> Pattern {
        pattern::<L>()
    }

    fn newton_update(&self, half: &Vector<L>) -> Iteration<Group<L>> {
        if const { L::FACTS.links_neighbours } {
            return update_of::<L>(self.problem.constants, &self.terms, half);
        }
        let (residual, jacobian) = Equation::newton_system(self, half);
        NewtonUpdate::of(&residual, &jacobian, self.pattern())
    }

    fn residual(&self, half: &Vector<L>) -> Vector<L> {
        if const { L::FACTS.constraints > 0 } {
            return Equation::newton_system(self, half).0;
        }
        L::newton_residual(self.problem.constants, &self.terms, half)
    }
}

impl<L: Effect> Equation<Group<L>> for CalledEquation<'_, L> {
    fn newton_system(&self, half: &Vector<L>) -> (Vector<L>, Square<L>) {
        with_constraints(self.problem, half, newton_system::<L>(self.problem.constants, &self.terms, half))
    }

    fn unforced_system(&self, half: &Vector<L>) -> (Vector<L>, Square<L>) {
        let Problem { constants, w, .. } = *self.problem;
        let unforced = newton_system::<L>(constants, &step_terms::<L>(constants, &Vector::<L>::zero(), w), half);
        with_constraints(self.problem, half, unforced)
    }

    fn momentum_jacobian(&self, half: &Vector<L>) -> Option<Square<L>> {
        if const { L::FACTS.links_neighbours } {
            return None;
        }
        let Problem { scene, w, h, .. } = *self.problem;
        let f = L::Retraction::retract(&(*half + *half)).matrix();
        Some(bordered(self.problem, &f, scene.momentum_jacobian(&f, w, h) * h))
    }
}

/// A solve of one equation with fallbacks.
struct CarefulSolve<'a, G: LieGroup, R> {
    equation: &'a dyn Equation<G>,
    /// The safe determinant, [`Problem::safe`].
    safe: G::Scalar,
    retraction: PhantomData<R>,
}

impl<G: LieGroup, R: Retraction<G>> CarefulSolve<'_, G, R> {
    /// Solves from this guess; if that fails, from the identity; if that fails, once more with shortened updates.
    fn solve(&self, guess: &G::Vector) -> Result<Root<G>, StepError> {
        let (warm, iterations) = self.iterate(Iterates::starting_at(guess));
        let accepted = self.accepted(&warm);
        if accepted.all() {
            return Ok(warm.root::<R>(iterations));
        }
        let (identity, spent) = (G::Vector::zero(), MAX_ITERATIONS);
        let (cold, iterations) = self.iterate(warm.keeping(accepted, &identity));
        let accepted = self.accepted(&cold);
        if accepted.all() {
            return Ok(cold.root::<R>(spent + iterations));
        }
        let (damped, iterations) = self.iterate_damped(cold.keeping(accepted, &identity));
        self.conclude(&damped, iterations).map(|mut root| {
            root.iterations += spent;
            root
        })
    }

    /// Newton's iteration from one guess; a solution on another branch is an error. If the iterates leave the domain of
    /// the Lagrangian, it starts again with shortened updates.
    fn attempt(&self, guess: &G::Vector) -> Result<Root<G>, StepError> {
        let (mut lanes, mut iterations) = self.iterate(Iterates::starting_at(guess));
        if !lanes.half.is_finite() {
            let accepted = self.accepted(&lanes);
            (lanes, iterations) = self.iterate_damped(lanes.keeping(accepted, &G::Vector::zero()));
        }
        self.conclude(&lanes, iterations)
    }

    /// Iterates until all lanes have converged, or the iterations are used up; returns their number.
    fn iterate(&self, mut lanes: Iterates<G>) -> (Iterates<G>, u32) {
        let made = lanes.iterate(MAX_ITERATIONS, |lanes| lanes.iterate_once::<true>(self.equation, self.safe));
        (lanes, made.unwrap_or(MAX_ITERATIONS))
    }

    /// Iterates as [`iterate`](Self::iterate) with no update longer than [`LONGEST_DAMPED`], and halves an update while
    /// it leaves the domain of the Lagrangian, such as velocities below that of light.
    fn iterate_damped(&self, mut lanes: Iterates<G>) -> (Iterates<G>, u32) {
        let made = lanes.iterate(MAX_DAMPED_ITERATIONS, |lanes| {
            let (update, det) = self.update(&lanes.half);
            let length = update.dot(&update).simd_sqrt();
            let longest = real::<G::Scalar>(LONGEST_DAMPED);
            let mut factor = (longest / length).select(length.simd_gt(longest), real(1.0));
            for _ in 0..MOST_HALVINGS {
                let residual = self.equation.residual(&(lanes.half - update * factor));
                let size = residual.dot(&residual);
                // A comparison with NaN is false.
                let is_defined = size.simd_lt(real(f64::INFINITY)) | lanes.settled;
                if is_defined.all() {
                    break;
                }
                factor = factor.select(is_defined, factor * real(0.5));
            }
            lanes.advance(&update, det, &(update * factor));
            false
        });
        (lanes, made.unwrap_or(MAX_DAMPED_ITERATIONS))
    }

    fn update(&self, half: &G::Vector) -> (G::Vector, G::Scalar) {
        let NewtonUpdate { update, det, .. } = self.equation.newton_update(half);
        (update, det)
    }

    /// The lanes that have converged on the branch of the identity.
    fn accepted(&self, lanes: &Iterates<G>) -> Mask<G::Scalar> {
        let candidates = lanes.settled & is_positive(lanes.det) & self.is_solved(&lanes.half);
        let near = R::is_half_near_identity(&lanes.half);
        if near.all() { candidates } else { candidates & (near | self.look_closer(&lanes.half)) }
    }

    /// The second check of the branch, far from the identity: the trace of the right-trivialised Jacobian must be
    /// positive too, for several bodies that of each body's part. Without the whole Jacobian no lane is accepted.
    fn look_closer(&self, half: &G::Vector) -> Mask<G::Scalar> {
        let Some(jacobian) = self.equation.momentum_jacobian(half) else { return nowhere::<G::Scalar>() };
        let pattern = self.equation.pattern();
        let (_, det) = G::Vector::factorise_with(&jacobian, pattern);
        is_positive(det) & is_positive(G::Vector::least_trace(&jacobian, pattern.factors))
    }

    /// Whether the momentum equation holds, which a vanishing update doesn't imply.
    ///
    /// The bound is far above rounding, and far below the right-hand side when rounding has swallowed the Jacobian.
    fn is_solved(&self, half: &G::Vector) -> Mask<G::Scalar> {
        let (residual, _) = self.equation.newton_system(half);
        let (unknown, jacobian) = self.equation.unforced_system(half);
        let size = |v: &G::Vector| v.dot(v).simd_sqrt();
        let scale = size(&unknown) + size(&(unknown - residual)) + G::Vector::trace(&jacobian).simd_abs();
        size(&residual).simd_le(scale * G::Scalar::simd_default_epsilon().simd_sqrt())
    }

    /// The root if all lanes have one, otherwise the error of a lane without one.
    fn conclude(&self, lanes: &Iterates<G>, iterations: u32) -> Result<Root<G>, StepError> {
        let accepted = self.accepted(lanes);
        if accepted.all() {
            return Ok(lanes.root::<R>(iterations));
        }
        if lanes.settled.all() {
            return Err(StepError::WrongBranch { determinant: reported(lanes.det) });
        }
        let (update, det) = self.update(&lanes.half);
        if !lanes.half.is_finite() || (det.simd_eq(real(0.0)) & !lanes.settled).any() {
            return Err(StepError::Singular);
        }
        let residual = reported((update.dot(&update) / lanes.half.dot(&lanes.half)).simd_sqrt());
        Err(StepError::NotConverged { iterations, residual })
    }
}
