//! Where a body is, and how the changes of a step are added to that.

use nalgebra::Vector3;

use crate::groups::{Advected, Factor, LieGroup, SO3};
use crate::mechanics::{Group, Term};
use crate::numbers::Real;

/// How many steps go by between two looks at what roundings have done to the attitude.
///
/// The worst of them, the same in every step, make no more in a thousand steps than [`TOLERATED`].
pub(crate) const STEPS_BETWEEN_CHECKS: u32 = 1024;

/// How many go by with several bodies. What these do to each other cancels in the whole as far as their attitudes are
/// rotations, and what they see is what is between these: else the whole momentum drifts in proportion to the steps.
const STEPS_BETWEEN_SEVERAL: u32 = 64;

/// How far from its group an attitude may be, in units of rounding. A random walk gets there in some ten million steps.
pub(crate) const TOLERATED: f64 = 2048.0;

/// Whether several bodies turn.
#[hot]
const fn has_several<G: LieGroup>() -> bool {
    G::ATTITUDES > 1
}

/// Attitude, momentum and advected parameters at one time, and the number of steps up to it.
///
/// A [`State`](crate::State) is this and what its method remembers.
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
    /// The attitude `g_i`, body to space.
    #[must_use]
    pub fn attitude(&self) -> G {
        self.attitude
    }

    /// The momentum `μ_i`, body frame; on SO(3) the physical angular momentum, kg m²/s.
    #[must_use]
    pub fn momentum(&self) -> G::Vector {
        self.momentum
    }

    /// The momentum of the body that is the factor `K` of a product, in its frame.
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

    /// The number of steps made.
    #[must_use]
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// The momentum in space, `Ad*_{g⁻¹} μ` (`R Π` on SO(3)); constant where nothing is advected.
    #[must_use]
    pub fn spatial_momentum(&self) -> G::Vector {
        self.attitude.inverse().adjoint_transpose(&self.momentum)
    }

    /// How far the attitude has left the group, `‖RᵀR − I‖` on SO(3).
    #[must_use]
    pub fn orthogonality_defect(&self) -> G::Scalar {
        self.attitude.defect()
    }
}

impl<T: Real, A: Advected<SO3<T>>> Motion<SO3<T>, A> {
    /// The spatial momentum's component along a direction given in space, `e₃ · R Π` for the vertical, (3.20).
    #[must_use]
    pub fn momentum_along(&self, direction: &Vector3<T>) -> T {
        self.spatial_momentum().dot(direction)
    }
}

/// How the changes of a step are added to a motion: rounded, as by [`Motion`] itself, or with what rounding leaves behind
/// carried to the next step.
///
/// A [`Plan`](crate::motion::Plan) makes all its changes by these functions, and so works with any summation.
#[hot]
pub trait Summation<G: LieGroup, A: Advected<G>>: Copy {
    /// Whether what rounding leaves behind is kept.
    const CARRIES: bool;

    /// The motion, rounded.
    fn now(&self) -> &Motion<G, A>;

    /// Turns the body by `F = I + D`: the attitude to `g F`, \[RDAE, (2.10)\], and what is advected to `F⁻¹·w`. The
    /// momentum stays.
    fn turn(&mut self, increment: &G::Matrix);

    /// What is advected, after that turn.
    fn turned(&self, increment: &G::Matrix) -> A;

    /// Adds to the momentum.
    fn push(&mut self, change: &G::Vector);

    /// One after the other: a turn that carries the momentum along.
    fn turn_and_push(&mut self, increment: &G::Matrix, change: &G::Vector) {
        self.turn(increment);
        self.push(change);
    }

    /// As [`turn_and_push`](Self::turn_and_push), where the rounded sums `(μ⁺, w⁺)` are there already.
    fn proceed(&mut self, increment: &G::Matrix, change: &G::Vector, end: (G::Vector, A));

    /// Counts a step.
    fn count(&mut self) {
        self.recount(self.now().steps + 1);
    }

    /// Counts anew from here.
    fn recount(&mut self, steps: u64);

    /// Puts the attitude back into the group, and what is advected to what it sees, where roundings have taken it far;
    /// `spatial` is the value `a_0` of what is advected.
    fn restore(&mut self, spatial: &A);

    /// Another motion in the place of this one; nothing is carried over.
    fn replace(&mut self, motion: Motion<G, A>);

    /// Another motion in the place of this one, as rounded as it is; what is carried stays.
    fn show(&mut self, motion: Motion<G, A>);

    /// Counts a step, and now and then [restores](Self::restore).
    fn finish(&mut self, spatial: impl FnOnce() -> A) {
        self.count();
        if is_due::<G>(self.now().steps) {
            by_copy(self, |near| near.restore(&spatial()));
        }
    }
}

/// A change that is seldom made, by a function that is called.
///
/// What such a function is shown stays in memory in all the steps between, too. There the next step reads what the last
/// one has just written, often in other pieces than it was written in, and waits for it. A copy leaves the motion in
/// registers.
#[hot]
fn by_copy<M: Copy>(motion: &mut M, change: impl FnOnce(&mut M)) {
    let mut changed = *motion;
    change(&mut changed);
    *motion = changed;
}

/// Whether it is time to look how far roundings have gone.
#[hot]
pub(crate) fn is_due<G: LieGroup>(steps: u64) -> bool {
    steps.is_multiple_of(u64::from(if has_several::<G>() { STEPS_BETWEEN_SEVERAL } else { STEPS_BETWEEN_CHECKS }))
}

/// A [`Summation`] of a scene's motions.
#[doc(hidden)]
pub trait SumsOf<S: Term>: Summation<Group<S>, S::Advected> {}

impl<S: Term, M: Summation<Group<S>, S::Advected>> SumsOf<S> for M {}

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

/// Restores the motion from so many units of rounding on; returns the lanes in which that was necessary, if there is one.
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
