//! What one application of a flow makes.

use core::fmt;

use crate::groups::LieGroup;
use crate::mechanics::{Effect, Group, Scalar, Vector};
use crate::numbers::{Entries as _, Mask, real};

/// One application of a flow.
#[derive(Clone, Copy)]
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
    /// `μ_{i+1} − μ_i`, before it was rounded to the digits of `μ_i`.
    pub(crate) change: Vector<L>,
    /// `ξ/2` and whether it is far from zero, as the solve has found them.
    pub(crate) half: Vector<L>,
    pub(crate) far: Mask<Scalar<L>>,
}

impl<L: Effect> Increment<L> {
    /// `F_i`.
    #[must_use]
    pub fn element(&self) -> Group<L> {
        Group::<L>::from_increment(&self.increment)
    }

    /// The sum of all that the step has made.
    #[hot]
    pub(crate) fn total(&self) -> Scalar<L> {
        let mut total = real(0.0);
        self.momentum.each(&mut |entry| total += entry);
        self.advected.each(&mut |entry| total += entry);
        total
    }
}

impl<L: Effect> fmt::Debug for Increment<L> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { coordinates, momentum, advected, iterations, .. } = self;
        let mut shown = f.debug_struct("Increment");
        shown.field("coordinates", coordinates).field("momentum", momentum).field("advected", advected);
        shown.field("iterations", iterations).finish_non_exhaustive()
    }
}
