//! The state of a motion, and what can be read off it.

use core::ops::Deref;

use crate::groups::LieGroup;
use crate::motion::summation::Motion;
use crate::numbers::Lanes;
use crate::solving::WarmStart;

/// A [`Motion`], that is attitude, momentum and advected parameters at one time, and what the method keeps for its next
/// step.
///
/// It is made by [`Stepper::start`](crate::Stepper::start), read by the methods of [`Motion`], and moved by
/// [`Stepper::step`](crate::Stepper::step). A copy goes on with the same bits. What is kept, `K`, is the method's own:
/// [`Stepper::adopt`](crate::Stepper::adopt) takes a motion over to another. [`StateOf`](crate::StateOf) names the state by
/// scene and method.
#[derive(Clone, Copy, Debug, PartialEq)]
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

/// With the guess and the history of the method, so that a lane goes on with the bits that it would have had.
impl<G, A, K> Lanes for State<G, A, K>
where
    G: LieGroup + Lanes<Lane: LieGroup>,
    Motion<G, A>: Lanes<Lane = Motion<G::Lane, A::Lane>>,
    A: Lanes,
    K: Lanes,
{
    type Lane = State<G::Lane, A::Lane, K::Lane>;

    fn splat(lane: &Self::Lane) -> Self {
        Self { motion: Lanes::splat(&lane.motion), kept: Lanes::splat(&lane.kept) }
    }

    fn lane(&self, k: usize) -> Self::Lane {
        State { motion: self.motion.lane(k), kept: self.kept.lane(k) }
    }

    fn set_lane(&mut self, k: usize, lane: &Self::Lane) -> bool {
        self.motion.set_lane(k, &lane.motion) && self.kept.set_lane(k, &lane.kept)
    }
}
