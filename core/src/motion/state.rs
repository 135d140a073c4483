//! The state of a motion.

use core::ops::Deref;

use crate::groups::LieGroup;
use crate::motion::summation::Motion;
use crate::numbers::{Real, real, two_sum};
use crate::solving::WarmStart;

/// A [`Motion`], that is attitude, momentum and advected parameters at one time, and the method's memory for its next
/// step.
///
/// [`Stepper::start`](crate::Stepper::start) constructs it, the methods of [`Motion`] read it, and
/// [`Stepper::step`](crate::Stepper::step) advances it. A copy continues with identical bits. The memory, `K`, is the
/// method's own: [`Stepper::adopt`](crate::Stepper::adopt) converts a motion to a state of another method.
/// [`StateOf`](crate::StateOf) names the state by scene and method.
#[derive(Clone, Copy, Debug, PartialEq, Lanes)]
pub struct State<G: LieGroup, A, K = WarmStart<<G as LieGroup>::Vector>> {
    pub(crate) motion: Motion<G, A>,
    pub(crate) kept: K,
    /// The summed lengths of steps that aren't counted.
    pub(crate) elapsed: ElapsedTime<G::Scalar>,
}

/// A compensated sum of times: the sum, and its rounding error.
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
