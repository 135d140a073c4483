//! The motion of a body, and the addition of a step's changes to it.

use nalgebra::Vector3;

use crate::groups::{Advected, Factor, LieGroup, SO3};
use crate::mechanics::{Group, Term};
use crate::numbers::Real;

/// The number of steps between two corrections of the attitude's rounding errors.
///
/// Even constant rounding errors of the largest size stay below [`TOLERATED`] over a thousand steps.
pub const STEPS_BETWEEN_CHECKS: u32 = 1024;

/// The number for several bodies. Their internal forces cancel only as far as attitudes are rotations and relative
/// attitudes agree with them; otherwise the total momentum drifts in proportion to the steps.
pub const STEPS_BETWEEN_SEVERAL: u32 = 64;

/// The tolerated distance of an attitude from its group, in units of rounding. A random walk reaches it in some ten
/// million steps.
pub const TOLERATED: f64 = 2048.0;

/// Whether the group has several attitudes.
#[hot]
const fn has_several<G: LieGroup>() -> bool {
    G::ATTITUDES > 1
}

/// The attitude, momentum and advected parameters at one time, and the number of steps up to it.
///
/// A [`State`](crate::State) is a motion and the memory of its method.
#[derive(Clone, Copy, Debug, PartialEq, Lanes)]
pub struct Motion<G: LieGroup, A> {
    pub(crate) attitude: G,
    pub(crate) momentum: G::Vector,
    pub(crate) advected: A,
    #[shared]
    pub(crate) steps: u64,
}

/// The type of a scene's motions.
pub(crate) type MotionOf<S> = Motion<Group<S>, <S as Term>::Advected>;

impl<G: LieGroup, A: Advected<G>> Motion<G, A> {
    /// The attitude `g_i`, from body to space.
    #[must_use]
    pub fn attitude(&self) -> G {
        self.attitude
    }

    /// The momentum `μ_i` in the body frame; on SO(3) the physical angular momentum, kg m²/s.
    #[must_use]
    pub fn momentum(&self) -> G::Vector {
        self.momentum
    }

    /// The momentum of the factor `K` of a product of groups, in that body's frame.
    #[must_use]
    pub fn momentum_of<const K: usize>(&self) -> <G::Of as LieGroup>::Vector
    where
        G: Factor<K>,
    {
        G::components(&self.momentum)
    }

    /// The advected parameters `w_i = g_i⁻¹ · a_0`.
    #[must_use]
    pub fn advected(&self) -> A {
        self.advected
    }

    /// The number of steps since the start.
    #[must_use]
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// The momentum in space, `Ad*_{g⁻¹} μ` (`R Π` on SO(3)); constant if there are no advected parameters.
    #[must_use]
    pub fn spatial_momentum(&self) -> G::Vector {
        self.attitude.inverse().adjoint_transpose(&self.momentum)
    }

    /// The distance of the attitude from the group, `‖RᵀR − I‖` on SO(3).
    #[must_use]
    pub fn orthogonality_defect(&self) -> G::Scalar {
        self.attitude.defect()
    }
}

impl<T: Real, A: Advected<SO3<T>>> Motion<SO3<T>, A> {
    /// The spatial momentum's component along a direction in space, `e₃ · R Π` for the vertical, (3.20).
    #[must_use]
    pub fn momentum_along(&self, direction: &Vector3<T>) -> T {
        self.spatial_momentum().dot(direction)
    }
}

/// The addition of a step's changes to a motion: rounded, as by [`Motion`] itself, or compensated, with rounding errors
/// carried to the next step.
///
/// A [`Plan`](crate::motion::Plan) applies all its changes by these functions, and so works with any summation.
#[hot]
pub trait Summation<G: LieGroup, A: Advected<G>>: Copy {
    /// Whether rounding errors are carried.
    const CARRIES: bool;

    /// The motion, rounded.
    fn now(&self) -> &Motion<G, A>;

    /// Turns the body by `F = I + D`: the attitude becomes `g F`, \[RDAE, (2.10)\], and the advected parameters
    /// `F⁻¹·w`. The momentum stays.
    fn turn(&mut self, increment: &G::Matrix);

    /// The advected parameters after a turn of the body by this increment.
    fn turned(&self, increment: &G::Matrix) -> A;

    /// Adds a change to the momentum.
    fn push(&mut self, change: &G::Vector);

    /// Turns the body, and then adds the change of the momentum.
    fn turn_and_push(&mut self, increment: &G::Matrix, change: &G::Vector) {
        self.turn(increment);
        self.push(change);
    }

    /// Turns the body and changes its momentum, as [`turn_and_push`](Self::turn_and_push), if the sums `(μ⁺, w⁺)` are
    /// known.
    fn proceed(&mut self, increment: &G::Matrix, change: &G::Vector, end: (G::Vector, A));

    /// Counts a step.
    fn count(&mut self) {
        self.recount(self.now().steps + 1);
    }

    /// Sets the number of steps.
    fn recount(&mut self, steps: u64);

    /// Projects the attitude onto the group, and recomputes the advected parameters from it, if rounding errors are
    /// large; `spatial` is the value `a_0` of the parameters.
    fn restore(&mut self, spatial: &A);

    /// Replaces the motion; carried rounding errors are dropped.
    fn replace(&mut self, motion: Motion<G, A>);

    /// Replaces the rounded motion; carried rounding errors stay.
    fn show(&mut self, motion: Motion<G, A>);

    /// Counts a step, and from time to time [restores](Self::restore) the attitude.
    fn finish(&mut self, spatial: impl FnOnce() -> A) {
        self.count();
        if is_due::<G>(self.now().steps) {
            by_copy(self, |near| near.restore(&spatial()));
        }
    }
}

/// A rare change, by a function that isn't inlined.
///
/// A reference to such a function would force the motion to memory in all other steps, too. There the next step would
/// load what the last one has just stored, often in other pieces, and wait for the stores. A copy leaves the motion in
/// registers.
#[hot]
fn by_copy<M: Copy>(motion: &mut M, change: impl FnOnce(&mut M)) {
    let mut changed = *motion;
    change(&mut changed);
    *motion = changed;
}

/// Whether a correction of rounding errors is due.
#[hot]
pub(crate) fn is_due<G: LieGroup>(steps: u64) -> bool {
    steps.is_multiple_of(u64::from(if has_several::<G>() { STEPS_BETWEEN_SEVERAL } else { STEPS_BETWEEN_CHECKS }))
}

#[hot]
impl<G: LieGroup, A: Advected<G>> Summation<G, A> for Motion<G, A> {
    const CARRIES: bool = false;

    fn now(&self) -> &Motion<G, A> {
        self
    }

    fn turn(&mut self, increment: &G::Matrix) {
        self.attitude = self.attitude.advance(increment);
        self.advected = self.advected.advect(increment);
    }

    fn turned(&self, increment: &G::Matrix) -> A {
        self.advected.advect(increment)
    }

    fn push(&mut self, change: &G::Vector) {
        self.momentum = self.momentum + *change;
    }

    fn proceed(&mut self, increment: &G::Matrix, _: &G::Vector, end: (G::Vector, A)) {
        self.attitude = self.attitude.advance(increment);
        (self.momentum, self.advected) = end;
    }

    fn recount(&mut self, steps: u64) {
        self.steps = steps;
    }

    #[cold]
    fn restore(&mut self, spatial: &A) {
        let _ = restored(self, spatial, if has_several::<G>() { 0.0 } else { TOLERATED });
    }

    fn replace(&mut self, motion: Motion<G, A>) {
        *self = motion;
    }

    fn show(&mut self, motion: Motion<G, A>) {
        *self = motion;
    }
}

/// Restores attitudes with errors above this number of units of rounding; returns the lanes with such errors, if there
/// are any.
pub(crate) fn restored<G: LieGroup, A: Advected<G>>(
    motion: &mut Motion<G, A>,
    spatial: &A,
    beyond: f64,
) -> Option<crate::numbers::Mask<G::Scalar>> {
    use nalgebra::SimdValue as _;
    let (attitude, far) = motion.attitude.restored(beyond)?;
    motion.attitude = attitude;
    motion.advected = spatial.seen_from(&attitude).zip(&motion.advected, &mut |seen, w| seen.select(far, w));
    Some(far)
}
