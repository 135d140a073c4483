//! Newton's iteration for the momentum equation (2.7), with a check of the branch.
//!
//! The equation has several solutions (four for a free asymmetric body at small `h`); the wanted one continues
//! `F = I` as the right side grows from zero. On the way the determinant of the Jacobian never vanishes, so its sign
//! at a solution tells. For (3.13) with a physical body more is known: `det = tr(P) tr(Fᵀ adj J_d)/h² − det J_d/h³` with
//! `P = F J_d/h` and `det J_d ≥ 0` keeps `tr P` from zero while `det > 0`, so determinant and trace together single out
//! the component of the identity. Below 90° there is at most one solution, and the determinant alone decides.
//!
//! SIMD lanes iterate together until all have settled. One that has settled earlier stays as it is, so that no lane's
//! digits depend on its neighbours: each is, bit for bit, what a scalar of its own would have given.

mod branch;
mod secants;

pub(crate) use branch::trusted_radius;

use crate::coordinates::Coordinates;
use crate::effect::{Effect, Matrix, Scalar, Vector};
use crate::error::StepError;
use crate::retraction::Retraction;
use crate::scalar::{Mask, Real, nowhere, real, reported};
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
    /// Iterations, those of abandoned attempts included.
    pub(crate) iterations: u32,
}

/// Where the lanes of an iteration have come to.
struct Lanes<L: Effect> {
    xi: Vector<L>,
    /// Of the Jacobian at the iterate before `xi`.
    det: Scalar<L>,
    settled: Mask<Scalar<L>>,
}

impl<L: Effect> Lanes<L> {
    #[inline(always)]
    fn starting_at(xi: &Vector<L>) -> Self {
        Self { xi: *xi, det: real(0.0), settled: nowhere::<Scalar<L>>() }
    }

    /// Takes `part` of the update in the lanes that haven't settled.
    #[inline(always)]
    fn advance(&mut self, update: &Vector<L>, det: Scalar<L>, part: &Vector<L>) {
        let next = self.xi - *part;
        let settled = settled::<L>(update, &next);
        self.xi = self.xi.select(self.settled, next);
        self.det = self.det.select(self.settled, det);
        self.settled = self.settled | settled;
    }

    /// The lanes of the mask as they are, the others at another start.
    fn keeping(mut self, accepted: Mask<Scalar<L>>, start: &Vector<L>) -> Self {
        self.xi = self.xi.select(accepted, *start);
        self.settled = accepted;
        self
    }
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
    /// [`trusted_radius`], or zero.
    pub(crate) trusted: Scalar<L>,
}

impl<L: Effect> Problem<'_, L> {
    /// The solution from the guess, if it is near the identity and nothing is doubtful.
    ///
    /// What it returns is what [`solve`](Self::solve) returns. A right side whose square is above `largest` is doubtful:
    /// the Jacobian is lost in its rounding, and an update may vanish far from any solution.
    ///
    /// Nothing here is lent to a function that isn't inlined, so that all of it can stay in registers; that is a sixth
    /// of the time of a step.
    #[inline(always)]
    pub(crate) fn solve_directly(&self, guess: &Vector<L>, largest: Scalar<L>) -> Option<Root<L>> {
        let terms = L::step_terms(self.constants, &self.a, self.w);
        if Self::goes_by_secants() {
            let (lanes, iterations) = self.iterate_by_secants(&terms, guess);
            return lanes.settled.all().then(|| Self::root(&lanes, iterations));
        }
        let mut lanes = Lanes::<L>::starting_at(guess);
        for iteration in 0..MAX_ITERATIONS {
            let (update, det) = self.update(&terms, &lanes.xi);
            lanes.advance(&update, det, &update);
            if lanes.settled.all() {
                let xi = lanes.xi;
                let usual = self.is_oriented(lanes.det) & self.a.dot(&self.a).simd_lt(largest);
                if !usual.all() || !L::Retraction::is_near_identity(&xi).all() {
                    return None;
                }
                let increment = L::Retraction::increment(&xi);
                return Some(Root { xi, increment, iterations: iteration + 1 });
            }
        }
        None
    }

    /// From the guess; where that fails from the identity; where that fails, once more with shortened steps.
    pub(crate) fn solve(&self, guess: &Vector<L>) -> Result<Root<L>, StepError> {
        if !self.a.is_finite() {
            return Err(StepError::NonFinite { what: "momentum" });
        }
        let terms = L::step_terms(self.constants, &self.a, self.w);
        let (start, spent) = self.start(&terms, guess);
        let (warm, iterations) = self.iterate(&terms, start);
        let accepted = self.accepted(&terms, &warm);
        if accepted.all() {
            return Ok(Self::root(&warm, spent + iterations));
        }
        let (identity, spent) = (Vector::<L>::zero(), spent + MAX_ITERATIONS);
        let (cold, iterations) = self.iterate(&terms, warm.keeping(accepted, &identity));
        let accepted = self.accepted(&terms, &cold);
        if accepted.all() {
            return Ok(Self::root(&cold, spent + iterations));
        }
        let (damped, iterations) = self.iterate_damped(&terms, cold.keeping(accepted, &identity));
        self.conclude(&terms, &damped, iterations).map(|mut root| {
            root.iterations += spent;
            root
        })
    }

    /// All lanes at the guess but those that [`solve_directly`](Self::solve_directly) has solved without the Jacobian,
    /// which alone wouldn't be here.
    fn start(&self, terms: &L::StepTerms, guess: &Vector<L>) -> (Lanes<L>, u32) {
        if !Self::goes_by_secants() {
            return (Lanes::starting_at(guess), 0);
        }
        let (lanes, iterations) = self.iterate_by_secants(terms, guess);
        let settled = lanes.settled;
        (lanes.keeping(settled, guess), iterations)
    }

    /// Newton's iteration from one guess, refused where it settles on another branch.
    pub(crate) fn attempt(&self, terms: &L::StepTerms, guess: &Vector<L>) -> Result<Root<L>, StepError> {
        let (lanes, iterations) = self.iterate(terms, Lanes::starting_at(guess));
        self.conclude(terms, &lanes, iterations)
    }

    /// Until all lanes have settled or the iterations are used up; how many there were.
    fn iterate(&self, terms: &L::StepTerms, mut lanes: Lanes<L>) -> (Lanes<L>, u32) {
        for iteration in 1..=MAX_ITERATIONS {
            let (update, det) = self.update(terms, &lanes.xi);
            lanes.advance(&update, det, &update);
            if lanes.settled.all() {
                return (lanes, iteration);
            }
        }
        (lanes, MAX_ITERATIONS)
    }

    /// As [`iterate`](Self::iterate), with no update longer than half a radian.
    fn iterate_damped(&self, terms: &L::StepTerms, mut lanes: Lanes<L>) -> (Lanes<L>, u32) {
        for iteration in 1..=MAX_DAMPED_ITERATIONS {
            let (update, det) = self.update(terms, &lanes.xi);
            let length = update.dot(&update).simd_sqrt();
            let half = real::<Scalar<L>>(0.5);
            let factor = (half / length).select(length.simd_gt(half), real(1.0));
            lanes.advance(&update, det, &(update * factor));
            if lanes.settled.all() {
                return (lanes, iteration);
            }
        }
        (lanes, MAX_DAMPED_ITERATIONS)
    }

    #[inline(always)]
    fn update(&self, terms: &L::StepTerms, xi: &Vector<L>) -> (Vector<L>, Scalar<L>) {
        let (residual, jacobian) = L::newton_system(self.constants, terms, xi);
        Vector::<L>::solve(&jacobian, &residual)
    }

    #[inline(always)]
    fn is_oriented(&self, det: Scalar<L>) -> Mask<Scalar<L>> {
        (det * self.orientation).simd_gt(real(0.0))
    }

    /// The lanes that have settled on the branch of the identity.
    fn accepted(&self, terms: &L::StepTerms, lanes: &Lanes<L>) -> Mask<Scalar<L>> {
        let candidates = lanes.settled & self.is_oriented(lanes.det) & self.is_solved(terms, &lanes.xi);
        let near = L::Retraction::is_near_identity(&lanes.xi);
        if near.all() { candidates } else { candidates & (near | self.look_closer(&lanes.xi)) }
    }

    /// Far from the identity the trace of the right-trivialised Jacobian must have kept its sign too.
    fn look_closer(&self, xi: &Vector<L>) -> Mask<Scalar<L>> {
        use crate::groups::LieGroup as _;
        let f = L::Retraction::retract(xi).matrix();
        let jacobian = self.lagrangian.momentum_jacobian(&f, self.w, self.h);
        let (_, det) = Vector::<L>::solve(&jacobian, &self.a);
        let trace = Vector::<L>::trace(&jacobian) * self.h;
        self.is_oriented(det) & trace.simd_gt(real(0.0))
    }

    /// Whether the momentum equation holds; a vanishing update alone doesn't say so.
    ///
    /// The bound is far above rounding, and far below the right side where rounding has swallowed the Jacobian.
    fn is_solved(&self, terms: &L::StepTerms, xi: &Vector<L>) -> Mask<Scalar<L>> {
        let (residual, _) = L::newton_system(self.constants, terms, xi);
        let (unknown, jacobian) =
            L::newton_system(self.constants, &L::step_terms(self.constants, &Vector::<L>::zero(), self.w), xi);
        let size = |v: &Vector<L>| v.dot(v).simd_sqrt();
        let scale = size(&unknown) + size(&(unknown - residual)) + Vector::<L>::trace(&jacobian).simd_abs();
        size(&residual).simd_le(scale * Scalar::<L>::simd_default_epsilon().simd_sqrt())
    }

    fn root(lanes: &Lanes<L>, iterations: u32) -> Root<L> {
        Root { xi: lanes.xi, increment: L::Retraction::increment(&lanes.xi), iterations }
    }

    /// The root if all lanes have one, otherwise what the others have failed from.
    fn conclude(&self, terms: &L::StepTerms, lanes: &Lanes<L>, iterations: u32) -> Result<Root<L>, StepError> {
        let accepted = self.accepted(terms, lanes);
        if accepted.all() {
            return Ok(Self::root(lanes, iterations));
        }
        if lanes.settled.all() {
            return Err(StepError::WrongBranch { determinant: reported(lanes.det) });
        }
        let (update, det) = self.update(terms, &lanes.xi);
        if !lanes.xi.is_finite() || (det.simd_eq(real(0.0)) & !lanes.settled).any() {
            return Err(StepError::Singular);
        }
        let residual = reported((update.dot(&update) / lanes.xi.dot(&lanes.xi)).simd_sqrt());
        Err(StepError::NotConverged { iterations, residual })
    }
}

/// Whether the next update would be below rounding.
///
/// Convergence is quadratic: a relative update of `√ε/8` is followed by one of the order of `ε/64`. Stopping earlier
/// would make the energy drift; the residual can't be used, as it stagnates at its rounding floor.
#[inline(always)]
fn settled<L: Effect>(update: &Vector<L>, xi: &Vector<L>) -> Mask<Scalar<L>> {
    let tolerance = Scalar::<L>::simd_default_epsilon() * real(1.0 / 64.0);
    update.dot(update).simd_le(xi.dot(xi) * tolerance)
}

/// The sign that the Jacobian's determinant has at the identity: that of `h^d`, as the inertia is positive.
pub(crate) fn orientation<T: Real>(h: T, dimension: usize) -> T {
    let sign = real::<T>(1.0).simd_copysign(h);
    if dimension.is_multiple_of(2) { sign * sign } else { sign }
}
