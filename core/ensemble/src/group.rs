//! Some members that are stepped side by side: in lanes, or one by one.

use liestep::motion::{Batch, Batchable, Integrator};
use liestep::{SetupError, StepError};
use simba::simd::AutoF64x8;

/// The lanes of `AutoF64x8`.
pub(crate) const LANES: usize = 8;

/// Members under way, numbered from zero.
pub(crate) trait Group<M: Integrator> {
    fn run(&mut self, steps: u64);
    fn state(&self, member: usize) -> M::State;
    fn error(&self, member: usize) -> Option<StepError>;
}

/// Members as [`group`s](Group), in their order: as few as will do.
pub(crate) type Grouping<M> = fn(&[Start<M>]) -> Vec<(Box<dyn Group<M>>, usize)>;

/// A member's stepper and where it starts.
pub(crate) type Start<M> = (M, <M as Integrator>::State);

impl<M: Batchable<AutoF64x8>> Group<M> for Batch<AutoF64x8, M> {
    fn run(&mut self, steps: u64) {
        self.run(steps);
    }

    fn state(&self, member: usize) -> M::State {
        self.state(member)
    }

    fn error(&self, member: usize) -> Option<StepError> {
        self.error(member).cloned()
    }
}

/// Eight in a batch, and fewer where one is unlike those before it.
pub(crate) fn in_lanes<M: Batchable<AutoF64x8> + 'static>(members: &[Start<M>]) -> Vec<(Box<dyn Group<M>>, usize)> {
    let mut groups: Vec<(Box<dyn Group<M>>, usize)> = Vec::new();
    let mut left = members;
    while !left.is_empty() {
        let mut count = left.len().min(LANES);
        let batch = loop {
            match Batch::<AutoF64x8, M>::new(&left[..count]) {
                Ok(batch) => break batch,
                Err(SetupError::Unlike { lane }) if lane > 0 => count = lane,
                Err(error) => unreachable!("one body is like itself: {error}"),
            }
        };
        groups.push((Box::new(batch), count));
        left = &left[count..];
    }
    groups
}

/// One member.
struct SingleMember<M: Integrator> {
    stepper: M,
    state: M::State,
    error: Option<StepError>,
}

impl<M: Integrator> Group<M> for SingleMember<M> {
    /// As [`Batch::run`].
    fn run(&mut self, steps: u64) {
        if self.error.is_some() {
            return;
        }
        self.error = self.stepper.run_stretches(&mut self.state, steps, &mut |_| 0).err();
    }

    fn state(&self, _: usize) -> M::State {
        self.state.clone()
    }

    fn error(&self, _: usize) -> Option<StepError> {
        self.error.clone()
    }
}

/// Each by itself.
pub(crate) fn one_by_one<M: Integrator + Clone + 'static>(members: &[Start<M>]) -> Vec<(Box<dyn Group<M>>, usize)> {
    let alone = |(stepper, state): &Start<M>| -> (Box<dyn Group<M>>, usize) {
        (Box::new(SingleMember { stepper: stepper.clone(), state: state.clone(), error: None }), 1)
    };
    members.iter().map(alone).collect()
}
