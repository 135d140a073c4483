//! The state of a motion, and what can be read off it.

use core::ops::Deref;

use crate::groups::LieGroup;
use crate::motion::summation::Motion;
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
}

impl<G: LieGroup, A, K> Deref for State<G, A, K> {
    type Target = Motion<G, A>;

    #[hot]
    fn deref(&self) -> &Motion<G, A> {
        &self.motion
    }
}
