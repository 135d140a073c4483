//! The state of a motion, and what can be read off it.

use core::ops::Deref;

use crate::groups::LieGroup;
use crate::motion::summation::Motion;
use crate::numbers::{Real, real, two_sum};
use crate::solving::WarmStart;

/// A [`Motion`], that is attitude, momentum and advected parameters at one time, and what the method keeps for its next
/// step.
///
/// It is made by [`Stepper::start`](crate::Stepper::start), read by the methods of [`Motion`], and moved by
/// [`Stepper::step`](crate::Stepper::step). A copy goes on with the same bits. What is kept, `K`, is the method's own:
/// [`Stepper::adopt`](crate::Stepper::adopt) takes a motion over to another. [`StateOf`](crate::StateOf) names the state by
/// scene and method.
#[derive(Clone, Copy, Debug, PartialEq, Lanes)]
pub struct State<G: LieGroup, A, K = WarmStart<<G as LieGroup>::Vector>> {
    pub(crate) motion: Motion<G, A>,
    pub(crate) kept: K,
    /// What steps of another length have added to the time of those that are counted.
    pub(crate) elapsed: ElapsedTime<G::Scalar>,
}

/// A time that is summed, and what rounding has left behind of the sum.
#[derive(Clone, Copy, Debug, PartialEq, Lanes)]
#[doc(hidden)]
pub struct ElapsedTime<T> {
    pub(crate) sum: T,
    pub(crate) carry: T,
}

impl<T: Real> ElapsedTime<T> {
    pub(crate) fn nothing() -> Self {
        Self { sum: real(0.0), carry: real(0.0) }
    }

    pub(crate) fn add(&mut self, length: T) {
        (self.sum, self.carry) = two_sum(self.sum, length + self.carry);
    }
}

impl<G: LieGroup, A, K> Deref for State<G, A, K> {
    type Target = Motion<G, A>;

    #[hot]
    fn deref(&self) -> &Motion<G, A> {
        &self.motion
    }
}
