//! What one application of a flow makes.

use crate::groups::LieGroup;
use crate::mechanics::{Effect, Group, Scalar, Vector};
use crate::motion::summation::Proceeded;
use crate::numbers::{Entries as _, Mask, real};

/// One application of a flow.
#[derive(Clone, Copy, Debug)]
pub struct Increment<L: Effect> {
    /// The coordinates `ξ` of `F_i = τ(ξ)`: a guess for the next solve.
    pub coordinates: Vector<L>,
    /// `F_i − I`.
    pub increment: <Group<L> as LieGroup>::Matrix,
    /// `μ_{i+1}`.
    pub momentum: Vector<L>,
    /// `w_{i+1}`.
    pub advected: L::Advected,
    /// Newton iterations, counted as in [`StepReport`](crate::motion::StepReport).
    pub iterations: u32,
}

/// A step, with what its successor needs of the [`Root`](crate::solving::Root).
pub(crate) struct Stepped<L: Effect> {
    pub(crate) step: Increment<L>,
    /// `μ⁺ − μ`, before it was rounded to the digits of `μ`.
    pub(crate) change: Vector<L>,
    pub(crate) half: Vector<L>,
    pub(crate) far: Mask<Scalar<L>>,
}

impl<L: Effect> Stepped<L> {
    /// As it is added to a motion.
    #[hot]
    pub(crate) fn proceeded(&self) -> Proceeded<Group<L>, L::Advected> {
        let Increment { increment, momentum, advected, .. } = self.step;
        Proceeded { increment, change: self.change, momentum, advected }
    }

    /// The sum of all that the step has made.
    #[hot]
    pub(crate) fn total(&self) -> Scalar<L> {
        let mut total = real(0.0);
        self.step.momentum.each(&mut |entry| total += entry);
        self.step.advected.each(&mut |entry| total += entry);
        total
    }
}

impl<L: Effect> Increment<L> {
    /// `F_i`.
    #[must_use]
    pub fn element(&self) -> Group<L> {
        Group::<L>::from_increment(&self.increment)
    }
}
