//! The result of one application of a flow.

use core::fmt;

use crate::groups::LieGroup;
use crate::mechanics::{Effect, Group, Scalar, Vector};
use crate::numbers::{Entries as _, Mask, real};

/// The increment `F_i` of one application of a flow, and the momentum and advected parameters after it.
#[derive(Clone, Copy)]
pub struct Increment<L: Effect> {
    /// The coordinates `ξ` of `F_i = τ(ξ)`: an initial guess for the next solve.
    pub coordinates: Vector<L>,
    /// The matrix `F_i − I`.
    pub increment: <Group<L> as LieGroup>::Matrix,
    /// The momentum `μ_{i+1}`.
    pub momentum: Vector<L>,
    /// The advected parameters `w_{i+1}`.
    pub advected: L::Advected,
    /// Newton iterations, counted as in [`StepReport`](crate::motion::StepReport).
    pub iterations: u32,
    /// The change `μ_{i+1} − μ_i`, before it was rounded to the digits of `μ_i`.
    pub(crate) change: Vector<L>,
    /// Half the coordinates, `ξ/2`, and whether they are far from zero.
    pub(crate) half: Vector<L>,
    pub(crate) far: Mask<Scalar<L>>,
}

impl<L: Effect> Increment<L> {
    /// The group element `F_i`.
    #[must_use]
    pub fn element(&self) -> Group<L> {
        Group::<L>::from_increment(&self.increment)
    }

    /// The sum of all components after the step, which isn't finite if one of them isn't.
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
