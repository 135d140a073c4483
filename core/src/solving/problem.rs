//! Newton's iteration for the momentum equation (2.7), with a check of the branch.
//!
//! The equation has several solutions (four for a free asymmetric body at small `h`); the wanted one continues
//! `F = I` as the right side grows from zero. On the way the determinant of the Jacobian never vanishes, so its sign
//! at a solution tells. For (3.13) with a physical body more is known: `det = tr(P) tr(Fᵀ adj J_d)/h² − det J_d/h³`
//! with `P = F J_d/h` and `det J_d ≥ 0` keeps `tr P` from zero while `det > 0`, so determinant and trace together
//! single out the component of the identity. Below 90° there is at most one solution, and the determinant alone
//! decides.
//!
//! Where one iteration has come near enough, the next is made with the [same Jacobian](super::reused_jacobian).
//!
//! SIMD lanes iterate [together](super::lanes) until all have settled. One that has settled earlier stays as it is, so that no lane's
//! digits depend on its neighbours: each is, bit for bit, what a scalar of its own would have given. Only a logarithm
//! or an exponential in the Lagrangian takes the series that the lane farthest from the identity needs, and rounds by
//! it.

use crate::error::StepError;
use crate::groups::{LieGroup, Retraction};
use crate::mechanics::{Effect, Group, Matrix, Scalar, Square, Vector};
use crate::numbers::{Coordinates, Mask, Pattern, Real, nowhere, real, reported};
use nalgebra::{SimdBool as _, SimdComplexField as _, SimdPartialOrd as _, SimdRealField as _, SimdValue as _};

/// Quadratic convergence needs at most nine up to 0.999 of the fold; more means that there is no solution.
pub(super) const MAX_ITERATIONS: u32 = 20;
/// The damped retry shortens its steps, and so needs more of them.
pub(super) const MAX_DAMPED_ITERATIONS: u32 = 60;

/// A solution of the momentum equation.
#[derive(Clone, Copy)]
pub(crate) struct Root<L: Effect> {
    /// Half the coordinates of `F`, `y = ξ/2`.
    pub(crate) half: Vector<L>,
    /// `F − I`.
    pub(crate) increment: Matrix<L>,
    /// Iterations, those of abandoned attempts included.
    pub(crate) iterations: u32,
    /// The lanes that 3/2 of `half` would take out of where a solution is surely the wanted one.
    pub(crate) far: Mask<Scalar<L>>,
    pub(crate) kick: Kick<L>,
}

/// The [`moving_kick`](crate::mechanics::Residual::moving_kick) that a solve has come by.
#[derive(Clone, Copy)]
pub(crate) struct Kick<L: Effect> {
    pub(crate) value: Vector<L>,
    /// The lanes in which it is that of the solution, to its rounding.
    pub(crate) found: Mask<Scalar<L>>,
}

impl<L: Effect> Kick<L> {
    #[inline(always)]
    pub(super) fn none() -> Self {
        Self { value: Vector::<L>::zero(), found: nowhere::<Scalar<L>>() }
    }
}

impl<L: Effect> Root<L> {
    pub(crate) fn at(half: &Vector<L>, iterations: u32) -> Self {
        let increment = L::Retraction::increment_of_half(half);
        Self { half: *half, increment, iterations, far: far::<L>(half), kick: Kick::none() }
    }

    pub(super) fn of(lanes: &Lanes<L>, iterations: u32) -> Self {
        let Kick { value, found } = lanes.kick;
        Self { kick: Kick { value, found }, ..Self::at(&lanes.half, iterations) }
    }
}

/// Where the lanes of an iteration have come to.
pub(super) struct Lanes<L: Effect> {
    pub(super) half: Vector<L>,
    /// Of the last Jacobian: at the iterate before `half`, or before two [short updates](super::reused_jacobian).
    pub(super) det: Scalar<L>,
    pub(super) settled: Mask<Scalar<L>>,
    pub(super) kick: Kick<L>,
}

impl<L: Effect> Lanes<L> {
    #[inline(always)]
    pub(super) fn starting_at(half: &Vector<L>) -> Self {
        Self { half: *half, det: real(0.0), settled: nowhere::<Scalar<L>>(), kick: Kick::none() }
    }

    /// Takes `part` of the update in the lanes that haven't settled.
    #[inline(always)]
    pub(super) fn advance(&mut self, update: &Vector<L>, det: Scalar<L>, part: &Vector<L>) {
        let next = self.half - *part;
        let settled = settled::<L>(update, &next);
        self.half = self.half.select(self.settled, next);
        self.det = self.det.select(self.settled, det);
        self.settled = self.settled | settled;
    }

    /// The lanes of the mask as they are, the others at another start.
    pub(super) fn keeping(mut self, accepted: Mask<Scalar<L>>, start: &Vector<L>) -> Self {
        self.half = self.half.select(accepted, *start);
        self.settled = accepted;
        self.kick.found = self.kick.found & accepted;
        self
    }
}

/// One momentum equation to be solved.
pub(crate) struct Problem<'a, L: Effect> {
    pub(crate) scene: &'a L,
    pub(crate) constants: &'a L::Constants,
    pub(crate) a: Vector<L>,
    pub(crate) w: &'a L::Advected,
    pub(crate) h: Scalar<L>,
    /// [`trusted_radius`], or zero.
    pub(crate) trusted: Scalar<L>,
    /// A [`safe`] determinant.
    pub(crate) safe: Scalar<L>,
}

impl<L: Effect> Problem<'_, L> {
    /// The solution from the guess, if it is near the identity and nothing is doubtful.
    ///
    /// What it returns is what [`solve`](Self::solve) returns. A right side whose square is above `largest` is
    /// doubtful: the Jacobian is lost in its rounding, and an update may vanish far from any solution.
    ///
    /// `REUSE` says whether a Jacobian may be [reused](super::reused_jacobian).
    ///
    /// Nothing here is lent to a function that isn't inlined, so that all of it can stay in registers; that is a sixth
    /// of the time of a step.
    #[inline(always)]
    pub(crate) fn solve_directly<const REUSE: bool>(&self, guess: &Vector<L>, largest: Scalar<L>) -> Option<Root<L>> {
        let terms = L::step_terms(self.constants, &self.a, self.w);
        if Self::goes_by_secants() {
            let (lanes, iterations) = self.iterate_by_secants(&terms, guess);
            return lanes.settled.all().then(|| Root::of(&lanes, iterations));
        }
        if Scalar::<L>::LANES > 1 {
            return self.solve_together::<REUSE>(&terms, guess, largest);
        }
        let mut lanes = Lanes::<L>::starting_at(guess);
        for iteration in 1..=MAX_ITERATIONS {
            let again = self.iterate_once::<REUSE>(&terms, &mut lanes);
            if lanes.settled.all() {
                return self.usual(&lanes.half, lanes.det, iteration + u32::from(again), largest);
            }
        }
        None
    }

    /// What an iteration has settled on, if nothing about it is doubtful.
    #[inline(always)]
    pub(super) fn usual(
        &self,
        half: &Vector<L>,
        det: Scalar<L>,
        iterations: u32,
        largest: Scalar<L>,
    ) -> Option<Root<L>> {
        let usual = is_positive(det) & self.a.dot(&self.a).simd_lt(largest);
        // Most are nearer than they have to be.
        let far = far::<L>(half);
        if !usual.all() || far.any() && !L::Retraction::is_half_near_identity(half).all() {
            return None;
        }
        let increment = L::Retraction::increment_of_half(half);
        Some(Root { half: *half, increment, iterations, far, kick: Kick::none() })
    }

    /// From the guess; where that fails from the identity; where that fails, once more with shortened steps.
    pub(crate) fn solve(&self, guess: &Vector<L>) -> Result<Root<L>, StepError> {
        if !self.a.is_finite() {
            return Err(StepError::NonFinite { what: "momentum" });
        }
        let terms = step_terms::<L>(self.constants, &self.a, self.w);
        let (start, spent) = self.start(&terms, guess);
        let (warm, iterations) = self.iterate(&terms, start);
        let accepted = self.accepted(&terms, &warm);
        if accepted.all() {
            return Ok(Root::of(&warm, spent + iterations));
        }
        let (identity, spent) = (Vector::<L>::zero(), spent + MAX_ITERATIONS);
        let (cold, iterations) = self.iterate(&terms, warm.keeping(accepted, &identity));
        let accepted = self.accepted(&terms, &cold);
        if accepted.all() {
            return Ok(Root::of(&cold, spent + iterations));
        }
        let (damped, iterations) = self.iterate_damped(&terms, cold.keeping(accepted, &identity));
        self.conclude(&terms, &damped, iterations).map(|mut root| {
            root.iterations += spent;
            root
        })
    }

    /// All lanes at the guess but those that [`solve_directly`](Self::solve_directly) has solved without the Jacobian,
    /// which alone wouldn't be here.
    pub(super) fn start(&self, terms: &L::StepTerms, guess: &Vector<L>) -> (Lanes<L>, u32) {
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
    pub(super) fn iterate(&self, terms: &L::StepTerms, mut lanes: Lanes<L>) -> (Lanes<L>, u32) {
        for iteration in 1..=MAX_ITERATIONS {
            let again = self.iterate_once::<true>(terms, &mut lanes);
            if lanes.settled.all() {
                return (lanes, iteration + u32::from(again));
            }
        }
        (lanes, MAX_ITERATIONS)
    }

    /// As [`iterate`](Self::iterate), with no update longer than a quarter, half a radian.
    pub(super) fn iterate_damped(&self, terms: &L::StepTerms, mut lanes: Lanes<L>) -> (Lanes<L>, u32) {
        for iteration in 1..=MAX_DAMPED_ITERATIONS {
            let (update, det) = self.update(terms, &lanes.half);
            let length = update.dot(&update).simd_sqrt();
            let longest = real::<Scalar<L>>(0.25);
            let factor = (longest / length).select(length.simd_gt(longest), real(1.0));
            lanes.advance(&update, det, &(update * factor));
            if lanes.settled.all() {
                return (lanes, iteration);
            }
        }
        (lanes, MAX_DAMPED_ITERATIONS)
    }

    pub(super) fn update(&self, terms: &L::StepTerms, half: &Vector<L>) -> (Vector<L>, Scalar<L>) {
        let (residual, jacobian) = newton_system::<L>(self.constants, terms, half);
        let (factors, det) = Vector::<L>::factorise_with(&jacobian, pattern::<L>());
        (Vector::<L>::solve_again_with(&factors, det, pattern::<L>(), &residual), det)
    }

    /// The lanes that have settled on the branch of the identity.
    pub(super) fn accepted(&self, terms: &L::StepTerms, lanes: &Lanes<L>) -> Mask<Scalar<L>> {
        let candidates = lanes.settled & is_positive(lanes.det) & self.is_solved(terms, &lanes.half);
        let near = L::Retraction::is_half_near_identity(&lanes.half);
        if near.all() { candidates } else { candidates & (near | self.look_closer(&lanes.half)) }
    }

    /// Far from the identity the trace of the right-trivialised Jacobian must have kept its sign too, that of each body's
    /// part where there are several.
    pub(super) fn look_closer(&self, half: &Vector<L>) -> Mask<Scalar<L>> {
        let f = L::Retraction::retract(&(*half + *half)).matrix();
        let jacobian = self.scene.momentum_jacobian(&f, self.w, self.h) * self.h;
        let (_, det) = Vector::<L>::factorise_with(&jacobian, pattern::<L>());
        is_positive(det) & is_positive(Vector::<L>::least_trace(&jacobian, pattern::<L>().factors))
    }

    /// Whether the momentum equation holds; a vanishing update alone doesn't say so.
    ///
    /// The bound is far above rounding, and far below the right side where rounding has swallowed the Jacobian.
    pub(super) fn is_solved(&self, terms: &L::StepTerms, half: &Vector<L>) -> Mask<Scalar<L>> {
        let (residual, _) = newton_system::<L>(self.constants, terms, half);
        let still = step_terms::<L>(self.constants, &Vector::<L>::zero(), self.w);
        let (unknown, jacobian) = newton_system::<L>(self.constants, &still, half);
        let size = |v: &Vector<L>| v.dot(v).simd_sqrt();
        let scale = size(&unknown) + size(&(unknown - residual)) + Vector::<L>::trace(&jacobian).simd_abs();
        size(&residual).simd_le(scale * Scalar::<L>::simd_default_epsilon().simd_sqrt())
    }

    /// The root if all lanes have one, otherwise what the others have failed from.
    pub(super) fn conclude(
        &self,
        terms: &L::StepTerms,
        lanes: &Lanes<L>,
        iterations: u32,
    ) -> Result<Root<L>, StepError> {
        let accepted = self.accepted(terms, lanes);
        if accepted.all() {
            return Ok(Root::of(lanes, iterations));
        }
        if lanes.settled.all() {
            return Err(StepError::WrongBranch { determinant: reported(lanes.det) });
        }
        let (update, det) = self.update(terms, &lanes.half);
        if !lanes.half.is_finite() || (det.simd_eq(real(0.0)) & !lanes.settled).any() {
            return Err(StepError::Singular);
        }
        let residual = reported((update.dot(&update) / lanes.half.dot(&lanes.half)).simd_sqrt());
        Err(StepError::NotConverged { iterations, residual })
    }
}

/// What is known of the Newton matrix of an effect.
#[inline(always)]
pub(crate) const fn pattern<L: Effect>() -> Pattern {
    Pattern { factors: <Group<L> as LieGroup>::FACTORS, apart: L::APART }
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

/// Whether the next update would be below rounding.
///
/// Convergence is quadratic: a relative update of `√ε/8` is followed by one of the order of `ε/64`. Stopping earlier
/// would make the energy drift; the residual can't be used, as it stagnates at its rounding floor.
#[inline(always)]
pub(super) fn settled<L: Effect>(update: &Vector<L>, half: &Vector<L>) -> Mask<Scalar<L>> {
    let tolerance = Scalar::<L>::simd_default_epsilon() * real(1.0 / 64.0);
    update.dot(update).simd_le(half.dot(half) * tolerance)
}

#[inline(always)]
pub(super) fn far<L: Effect>(half: &Vector<L>) -> Mask<Scalar<L>> {
    !L::Retraction::is_half_well_near_identity(half)
}

/// The sign that the Jacobian's determinant has at the identity, where it is that of the inertia.
#[inline(always)]
pub(super) fn is_positive<T: Real>(value: T) -> Mask<T> {
    value.simd_gt(real(0.0))
}
