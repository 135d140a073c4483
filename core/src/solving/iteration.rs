//! Newton's iteration: its iterates, its end, and the solution. A single body is one lane.

use crate::groups::{LieGroup, Retraction, SquareOf};
use crate::mechanics::NewtonUpdate;
use crate::numbers::{Coordinates as _, Mask, Pattern, Real, nowhere, real};
use nalgebra::{SimdBool as _, SimdPartialOrd as _, SimdValue as _};

/// Limit of the iterations. Quadratic convergence needs at most nine up to 0.999 of the fold.
pub const MAX_ITERATIONS: u32 = 20;
/// Limit of the iterations with shortened updates, which converge more slowly.
pub const MAX_DAMPED_ITERATIONS: u32 = 60;
/// Length of the longest shortened update, in half the coordinates: half a radian.
pub const LONGEST_DAMPED: f64 = 0.25;
/// Limit of the halvings of an update that leaves the domain of the Lagrangian.
pub const MOST_HALVINGS: u32 = 40;
/// Criterion of convergence: the square of the last update relative to the unknown's, in roundings.
///
/// Convergence is quadratic: a relative update of `√ε/8` is followed by one of the order of `ε/64`. Stopping earlier
/// would make the energy drift; the residual can't be used, as it stagnates at its rounding floor.
pub const SETTLED: f64 = 1.0 / 64.0;

/// The result of a Newton iteration: its update, and the factors of its Jacobian for another update.
pub(super) type Iteration<G> = NewtonUpdate<<G as LieGroup>::Vector, SquareOf<G>, <G as LieGroup>::Scalar>;

/// The functions of a momentum equation that Newton's iteration calls.
pub(super) trait System<G: LieGroup> {
    /// The sparsity of the Jacobian.
    fn pattern(&self) -> Pattern;

    /// The update of Newton's iteration at half the coordinates.
    fn newton_update(&self, half: &G::Vector) -> Iteration<G>;

    /// The update at `half` with the Jacobian of another iterate, by its factors.
    #[hot]
    fn simplified(&self, factors: &SquareOf<G>, det: G::Scalar, half: &G::Vector) -> G::Vector {
        G::Vector::solve_again_with(factors, det, self.pattern(), &self.residual(half))
    }

    /// The residual of the momentum equation alone.
    fn residual(&self, half: &G::Vector) -> G::Vector;
}

/// A solution of the momentum equation.
#[derive(Clone, Copy)]
pub(crate) struct Root<G: LieGroup> {
    /// Half the coordinates of `F`, `y = ξ/2`.
    pub(crate) half: G::Vector,
    /// The increment `F − I`.
    pub(crate) increment: G::Matrix,
    /// Number of iterations, including those of abandoned attempts.
    pub(crate) iterations: u32,
    /// The lanes in which `3/2 half` lies outside of the ball where a solution is surely the wanted one.
    pub(crate) far: Mask<G::Scalar>,
}

impl<G: LieGroup> Root<G> {
    pub(crate) fn at<R: Retraction<G>>(half: &G::Vector, iterations: u32) -> Self {
        Self { far: far::<R, G>(half), ..Self::of(half, R::increment_of_half(half), iterations) }
    }

    /// A root with no lane far from the identity.
    #[hot]
    pub(super) fn of(half: &G::Vector, increment: G::Matrix, iterations: u32) -> Self {
        Self { half: *half, increment, iterations, far: nowhere::<G::Scalar>() }
    }
}

/// The iterates of all lanes.
pub(super) struct Iterates<G: LieGroup> {
    pub(super) half: G::Vector,
    /// The determinant of the last Jacobian: at the iterate before `half`, or before two [short
    /// updates](super::reused_jacobian).
    pub(super) det: G::Scalar,
    pub(super) settled: Mask<G::Scalar>,
}

impl<G: LieGroup> Iterates<G> {
    #[hot]
    pub(super) fn starting_at(half: &G::Vector) -> Self {
        Self { half: *half, det: real(0.0), settled: nowhere::<G::Scalar>() }
    }

    /// Iterates until all lanes have converged, at most `most` times. `once` makes an iteration, and returns whether a
    /// lane has converged by a [second update](super::reused_jacobian) in it. Returns the number of iterations; `None`
    /// if some lane hasn't converged.
    #[hot]
    pub(super) fn iterate(&mut self, most: u32, mut once: impl FnMut(&mut Self) -> bool) -> Option<u32> {
        for iteration in 1..=most {
            let again = once(self);
            if self.settled.all() {
                return Some(iteration + u32::from(again));
            }
        }
        None
    }

    /// Adds `part` of the update in the lanes that haven't converged.
    #[hot]
    pub(super) fn advance(&mut self, update: &G::Vector, det: G::Scalar, part: &G::Vector) {
        let next = self.half - *part;
        let settled = settled::<G>(update, &next);
        self.half = self.half.select(self.settled, next);
        self.det = self.det.select(self.settled, det);
        self.settled = self.settled | settled;
    }

    /// Retains the iterates in the lanes of the mask, and moves the others to `start`.
    pub(super) fn keeping(mut self, accepted: Mask<G::Scalar>, start: &G::Vector) -> Self {
        self.half = self.half.select(accepted, *start);
        self.settled = accepted;
        self
    }

    pub(super) fn root<R: Retraction<G>>(&self, iterations: u32) -> Root<G> {
        Root::at::<R>(&self.half, iterations)
    }
}

/// Whether the next update would be below rounding; see [`SETTLED`].
#[hot]
pub(super) fn settled<G: LieGroup>(update: &G::Vector, half: &G::Vector) -> Mask<G::Scalar> {
    use nalgebra::SimdRealField as _;
    let tolerance = G::Scalar::simd_default_epsilon() * real(SETTLED);
    update.dot(update).simd_le(half.dot(half) * tolerance)
}

#[hot]
pub(super) fn far<R: Retraction<G>, G: LieGroup>(half: &G::Vector) -> Mask<G::Scalar> {
    !R::is_half_well_near_identity(half)
}

/// Whether a determinant has its sign at the identity, that of the inertia.
#[hot]
pub(super) fn is_positive<T: Real>(value: T) -> Mask<T> {
    value.simd_gt(real(0.0))
}
