//! Groups of members that are stepped together: in lanes, or one by one.

use liestep::StepError;
use liestep::motion::{Batch, Batchable, Integrator};
use liestep::numbers::{InLanes, Lanes as _};
use simba::simd::AutoF64x8;

use crate::section::{LANES, Section};

/// A group of running members, numbered from zero.
pub(crate) trait Group<M: Integrator> {
    fn run(&mut self, steps: u64);
    fn state(&self, member: usize) -> M::State;
    /// The state of a member before the last run, if that was of one step.
    fn before(&self, member: usize) -> M::State;
    /// The values of a section's function, if the section computes them in lanes.
    fn values(&self, section: &Section<M>) -> Option<[f64; LANES]>;
    fn error(&self, member: usize) -> Option<StepError>;
}

/// Divides members, in their order, into as few [`group`s](Group) as will do.
pub(crate) type Grouping<M> = fn(&[Start<M>]) -> Vec<(Box<dyn Group<M>>, usize)>;

/// A member's stepper and its initial state.
pub(crate) type Start<M> = (M, <M as Integrator>::State);

/// Members stepped together in lanes.
struct LaneGroup<M: Batchable<AutoF64x8>> {
    batch: Batch<AutoF64x8, M>,
    before: <<M as InLanes<AutoF64x8>>::Together as Integrator>::State,
}

impl<M: Batchable<AutoF64x8> + 'static> Group<M> for LaneGroup<M> {
    fn run(&mut self, steps: u64) {
        if steps == 1 {
            self.before = self.batch.states().clone();
        }
        self.batch.run(steps);
    }

    fn state(&self, member: usize) -> M::State {
        self.batch.state(member)
    }

    fn before(&self, member: usize) -> M::State {
        self.before.lane(member)
    }

    fn values(&self, section: &Section<M>) -> Option<[f64; LANES]> {
        section.lanes(&self.batch.together())
    }

    fn error(&self, member: usize) -> Option<StepError> {
        self.batch.error(member).cloned()
    }
}

/// Groups of eight members, or fewer if a member can't share a batch.
pub(crate) fn in_lanes<M: Batchable<AutoF64x8> + 'static>(mut left: &[Start<M>]) -> Vec<(Box<dyn Group<M>>, usize)> {
    let mut groups: Vec<(Box<dyn Group<M>>, usize)> = Vec::new();
    while let Some((batch, count)) = Batch::<AutoF64x8, M>::of_first(&left[..left.len().min(LANES)]) {
        let before = batch.states().clone();
        groups.push((Box::new(LaneGroup { batch, before }), count));
        left = &left[count..];
    }
    groups
}

/// A member stepped alone.
struct SingleMember<M: Integrator> {
    stepper: M,
    state: M::State,
    before: M::State,
    error: Option<StepError>,
}

impl<M: Integrator> Group<M> for SingleMember<M> {
    /// Runs as [`Batch::run`].
    fn run(&mut self, steps: u64) {
        if self.error.is_some() {
            return;
        }
        if steps == 1 {
            self.before = self.state.clone();
        }
        self.error = self.stepper.run_stretches(&mut self.state, steps, &mut |_, _| 0).err();
    }

    fn state(&self, _: usize) -> M::State {
        self.state.clone()
    }

    fn before(&self, _: usize) -> M::State {
        self.before.clone()
    }

    fn values(&self, _: &Section<M>) -> Option<[f64; LANES]> {
        None
    }

    fn error(&self, _: usize) -> Option<StepError> {
        self.error.clone()
    }
}

/// Groups of one member each.
pub(crate) fn one_by_one<M: Integrator + Clone + 'static>(members: &[Start<M>]) -> Vec<(Box<dyn Group<M>>, usize)> {
    let alone = |(stepper, state): &Start<M>| -> (Box<dyn Group<M>>, usize) {
        let (stepper, state, before) = (stepper.clone(), state.clone(), state.clone());
        (Box::new(SingleMember { stepper, state, before, error: None }), 1)
    };
    members.iter().map(alone).collect()
}
