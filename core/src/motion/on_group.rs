//! A stepper of any method on a group that is known: its states are motions, and numbers below.

use alloc::vec;
use alloc::vec::Vec;
use core::fmt::{self, Debug};
use core::marker::PhantomData;
use core::ops::Deref;

use crate::error::{SetupError, StepError};
use crate::groups::layout::Factor;
use crate::groups::{Advected, LieGroup};
use crate::motion::any::{AnyMotion, AnyState, AnyStepper, read};
use crate::motion::integrator::Integrator;
use crate::motion::plan::Cost;
use crate::motion::report::StepReport;
use crate::motion::summation::Motion;
use crate::numbers::Entries as _;

/// An [`AnyStepper`] on the group `G`, by [`AnyStepper::on_group`]: the method isn't in the type, and states are typed motions.
#[derive(Clone)]
pub struct GroupStepper<G, A> {
    any: AnyStepper,
    of: PhantomData<fn() -> (G, A)>,
}

/// The state of a [`GroupStepper`].
#[derive(Clone, PartialEq)]
pub struct GroupState<G: LieGroup, A> {
    any: AnyState,
    motion: Motion<G, A>,
}

impl<G: LieGroup, A> Deref for GroupState<G, A> {
    type Target = Motion<G, A>;

    fn deref(&self) -> &Motion<G, A> {
        &self.motion
    }
}

impl<G: LieGroup, A: Debug> Debug for GroupState<G, A> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        Debug::fmt(&self.motion, f)
    }
}

impl<G, A> Debug for GroupStepper<G, A> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        Debug::fmt(&self.any, f)
    }
}

impl AnyStepper {
    /// The stepper with typed states, on this group and with these advected parameters; none if its layout is another.
    #[must_use]
    pub fn on_group<G: LieGroup<Scalar = f64>, A: Advected<G>>(self) -> Option<GroupStepper<G, A>> {
        let mut advected = 0;
        A::from_entries(&mut || {
            advected += 1;
            0.0
        });
        let is_same = self.layout().factors == G::factors() && self.layout().advected.len() == advected;
        is_same.then_some(GroupStepper { any: self, of: PhantomData })
    }
}

impl<G: LieGroup<Scalar = f64>, A: Advected<G>> GroupStepper<G, A> {
    inherent_steps!();

    /// The stepper whose states are numbers.
    #[must_use]
    pub const fn any(&self) -> &AnyStepper {
        &self.any
    }

    /// A state from an attitude and a velocity, as by [`Stepper::start`](crate::Stepper::start).
    ///
    /// # Errors
    ///
    /// The errors of [`Stepper::start`](crate::Stepper::start).
    pub fn start(&self, attitude: impl Into<G>, velocity: G::Vector) -> Result<GroupState<G, A>, SetupError> {
        self.any.start_at(attitude.into(), velocity).map(typed)
    }

    /// The state of a motion as numbers, with a method's memory of zeros.
    fn numbers(&self, motion: &Motion<G, A>) -> AnyMotion {
        let mut numbers = vec![0.0; self.any.layout().state()];
        let mut places = numbers.iter_mut();
        let mut write = |number: f64| places.next().map_or((), |place| *place = number);
        motion.attitude.matrix().each(&mut write);
        motion.momentum.each(&mut write);
        motion.advected.each(&mut write);
        self.any.motion_of(numbers.into(), motion.steps)
    }

    fn change<R>(
        &self,
        state: &mut GroupState<G, A>,
        steps: impl FnOnce(&AnyStepper, &mut AnyState) -> Result<R, StepError>,
    ) -> Result<R, StepError> {
        let result = steps(&self.any, &mut state.any);
        state.motion = motion(&state.any);
        result
    }
}

fn motion<G: LieGroup<Scalar = f64>, A: Advected<G>>(any: &AnyMotion) -> Motion<G, A> {
    Motion {
        attitude: G::from_matrix_unchecked(read(any.attitude())),
        momentum: read(any.momentum()),
        advected: read(any.advected()),
        steps: any.steps(),
    }
}

fn typed<G: LieGroup<Scalar = f64>, A: Advected<G>>(any: AnyState) -> GroupState<G, A> {
    let motion = motion(&any);
    GroupState { any, motion }
}

impl<G: LieGroup<Scalar = f64>, A: Advected<G>> Integrator for GroupStepper<G, A> {
    type Scalar = f64;
    type Motion = Motion<G, A>;
    type Velocity = G::Vector;
    type Inertia = ();
    type State = GroupState<G, A>;

    fn step(&self, state: &mut Self::State) -> Result<StepReport, StepError> {
        self.change(state, Integrator::step)
    }

    fn run(&self, state: &mut Self::State, steps: u64) -> Result<u64, StepError> {
        self.change(state, |any, own| any.run(own, steps))
    }

    fn run_stretches(
        &self,
        state: &mut Self::State,
        steps: u64,
        next: &mut dyn FnMut(&Motion<G, A>, f64) -> u64,
    ) -> Result<u64, StepError> {
        self.change(state, |any, own| any.run_stretches(own, steps, &mut |reached, time| next(&motion(reached), time)))
    }

    fn part(&self, state: &Self::State, fraction: f64) -> Result<Motion<G, A>, StepError> {
        self.any.part(&state.any, fraction).map(|reached| motion(&reached))
    }

    fn adopt(&self, motion: &Motion<G, A>) -> Self::State {
        typed(self.any.adopt(&self.numbers(motion)))
    }

    fn steps(motion: &Motion<G, A>) -> u64 {
        motion.steps
    }

    fn cost(&self) -> Option<Cost> {
        self.any.cost()
    }

    fn step_size(&self) -> f64 {
        self.any.step_size()
    }

    fn time(&self, state: &Self::State) -> f64 {
        self.any.time(&state.any)
    }

    fn length(&self, state: &Self::State) -> Option<f64> {
        self.any.length(&state.any)
    }

    fn velocity(&self, motion: &Motion<G, A>) -> G::Vector {
        read(&self.any.velocity(&self.numbers(motion)))
    }

    fn energy(&self, motion: &Motion<G, A>) -> f64 {
        self.any.energy(&self.numbers(motion))
    }

    fn factors(&self) -> Vec<Factor> {
        G::factors()
    }

    fn inertia(&self) {}

    fn write(&self, motion: &Motion<G, A>, (): &(), attitude: &mut [f64], row: &mut [f64]) {
        self.any.write(&self.numbers(motion), &(), attitude, row);
    }
}
