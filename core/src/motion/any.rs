//! A stepper whose scene and method aren't in its type.

use alloc::boxed::Box;
use alloc::rc::Rc;
use core::any::Any;
use core::fmt::{self, Debug};

use crate::error::{SetupError, StepError};
use crate::groups::{Advected, LieGroup};
use crate::mechanics::{Effect, FactoredInertia, Group, Scalar, Vector};
use crate::motion::integrator::Integrator;
use crate::motion::plan::{Cost, NextSteps, Plan};
use crate::motion::report::StepReport;
use crate::motion::state::State;
use crate::motion::stepper::{StateOf, Stepper};
use crate::motion::summation::Motion;
use crate::numbers::real;

/// A [`Stepper`] of any scene and any method on the group `G`, by [`Stepper::into_any`]: for programs that find out when
/// they run what they step.
///
/// A step costs an indirect call more.
///
/// A copy is the same stepper, and costs nothing.
pub struct AnyStepper<G: LieGroup, A>(Rc<dyn Erased<G, A>>);

impl<G: LieGroup, A> Clone for AnyStepper<G, A> {
    fn clone(&self) -> Self {
        Self(Rc::clone(&self.0))
    }
}

/// The state of an [`AnyStepper`].
pub type AnyState<G, A> = State<G, A, AnyKept>;

/// What a method keeps, whichever it is.
pub struct AnyKept(Box<dyn ErasedKept>);

trait ErasedKept: Any + Debug {
    fn copied(&self) -> Box<dyn ErasedKept>;
    fn as_any(&self) -> &dyn Any;
    fn as_any_mut(&mut self) -> &mut dyn Any;
    fn equals(&self, other: &dyn ErasedKept) -> bool;
}

impl<K: Any + Clone + Debug + PartialEq> ErasedKept for K {
    fn copied(&self) -> Box<dyn ErasedKept> {
        Box::new(self.clone())
    }

    fn as_any(&self) -> &dyn Any {
        self
    }

    fn as_any_mut(&mut self) -> &mut dyn Any {
        self
    }

    fn equals(&self, other: &dyn ErasedKept) -> bool {
        other.as_any().downcast_ref::<K>() == Some(self)
    }
}

impl Clone for AnyKept {
    fn clone(&self) -> Self {
        // Through the box: that is such a memory, too.
        Self(self.0.as_ref().copied())
    }
}

impl PartialEq for AnyKept {
    fn eq(&self, other: &Self) -> bool {
        self.0.as_ref().equals(other.0.as_ref())
    }
}

impl Debug for AnyKept {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.as_ref().fmt(f)
    }
}

/// A stepper with its types left out. A run is so many steps, and whether an error is explained.
trait Erased<G: LieGroup, A> {
    fn start(&self, attitude: G, velocity: G::Vector) -> Result<AnyState<G, A>, SetupError>;
    fn step(&self, motion: &mut Motion<G, A>, kept: &mut AnyKept) -> Result<StepReport, StepError>;
    fn run(&self, motion: &mut Motion<G, A>, kept: &mut AnyKept, run: (u64, bool)) -> Result<u64, StepError>;
    fn run_shown(
        &self,
        motion: &mut Motion<G, A>,
        kept: &mut AnyKept,
        steps: u64,
        next: &mut NextSteps<'_, G, A>,
    ) -> Result<u64, StepError>;
    fn part(&self, motion: &Motion<G, A>, kept: &AnyKept, fraction: G::Scalar) -> Result<Motion<G, A>, StepError>;
    fn adopt(&self, motion: &Motion<G, A>) -> AnyState<G, A>;
    fn step_size(&self) -> G::Scalar;
    fn velocity(&self, motion: &Motion<G, A>) -> G::Vector;
    fn energy(&self, motion: &Motion<G, A>) -> G::Scalar;
    fn factored_inertia(&self) -> Option<FactoredInertia<G>>;
    fn velocity_and_energy(
        &self,
        motion: &Motion<G, A>,
        inertia: Option<&FactoredInertia<G>>,
    ) -> (G::Vector, G::Scalar);
    fn cost(&self) -> Cost;
}

/// The state that a stepper of its own type needs: what another has kept is of no use, and it begins anew.
fn own<S, P>(stepper: &Stepper<S, P>, motion: &Motion<Group<S>, S::Advected>, kept: &AnyKept) -> StateOf<S, P>
where
    S: Effect,
    P: Plan<S, Kept: 'static>,
{
    let kept = kept.0.as_ref().as_any().downcast_ref::<P::Kept>().copied();
    State { motion: *motion, kept: kept.unwrap_or_else(|| stepper.plan.keep(&stepper.scene, motion)) }
}

/// Writes a state back.
fn back<G: LieGroup, A, K: Any + Copy + Debug + PartialEq>(
    state: State<G, A, K>,
    motion: &mut Motion<G, A>,
    kept: &mut AnyKept,
) {
    *motion = state.motion;
    match kept.0.as_mut().as_any_mut().downcast_mut::<K>() {
        Some(place) => *place = state.kept,
        None => *kept = AnyKept(Box::new(state.kept)),
    }
}

impl<S, P> Erased<Group<S>, S::Advected> for Stepper<S, P>
where
    S: Effect,
    P: Plan<S, Kept: 'static>,
{
    fn start(&self, attitude: Group<S>, velocity: Vector<S>) -> Result<AnyState<Group<S>, S::Advected>, SetupError> {
        let State { motion, kept } = self.start(attitude, velocity)?;
        Ok(State { motion, kept: AnyKept(Box::new(kept)) })
    }

    fn step(&self, motion: &mut Motion<Group<S>, S::Advected>, kept: &mut AnyKept) -> Result<StepReport, StepError> {
        let mut state = own(self, motion, kept);
        let report = self.step_or_run(&mut state)?;
        back(state, motion, kept);
        Ok(report)
    }

    fn run(
        &self,
        motion: &mut Motion<Group<S>, S::Advected>,
        kept: &mut AnyKept,
        (steps, explain): (u64, bool),
    ) -> Result<u64, StepError> {
        let mut state = own(self, motion, kept);
        let iterations = if explain { self.run(&mut state, steps)? } else { self.run_unexplained(&mut state, steps)? };
        back(state, motion, kept);
        Ok(iterations)
    }

    fn run_shown(
        &self,
        motion: &mut Motion<Group<S>, S::Advected>,
        kept: &mut AnyKept,
        steps: u64,
        next: &mut NextSteps<'_, Group<S>, S::Advected>,
    ) -> Result<u64, StepError> {
        let mut state = own(self, motion, kept);
        let made = Integrator::run_shown(self, &mut state, steps, next);
        // After an error, too, there are the steps before it.
        if state.steps != motion.steps {
            back(state, motion, kept);
        }
        made
    }

    fn part(
        &self,
        motion: &Motion<Group<S>, S::Advected>,
        kept: &AnyKept,
        fraction: Scalar<S>,
    ) -> Result<Motion<Group<S>, S::Advected>, StepError> {
        self.fraction_of_a_step(&own(self, motion, kept), fraction)
    }

    fn adopt(&self, motion: &Motion<Group<S>, S::Advected>) -> AnyState<Group<S>, S::Advected> {
        let State { motion, kept } = self.adopt(motion);
        State { motion, kept: AnyKept(Box::new(kept)) }
    }

    fn step_size(&self) -> Scalar<S> {
        self.step_size()
    }

    fn velocity(&self, motion: &Motion<Group<S>, S::Advected>) -> Vector<S> {
        self.velocity(motion)
    }

    fn energy(&self, motion: &Motion<Group<S>, S::Advected>) -> Scalar<S> {
        self.energy(motion)
    }

    fn factored_inertia(&self) -> Option<FactoredInertia<Group<S>>> {
        Integrator::factored_inertia(self)
    }

    fn velocity_and_energy(
        &self,
        motion: &Motion<Group<S>, S::Advected>,
        inertia: Option<&FactoredInertia<Group<S>>>,
    ) -> (Vector<S>, Scalar<S>) {
        Integrator::velocity_and_energy(self, motion, inertia)
    }

    fn cost(&self) -> Cost {
        self.plan.cost()
    }
}

impl<S: Effect + 'static, P: Plan<S, Kept: 'static> + 'static> Stepper<S, P> {
    /// This stepper without its scene and method in the type.
    #[must_use]
    pub fn into_any(self) -> AnyStepper<Group<S>, S::Advected> {
        AnyStepper(Rc::new(self))
    }
}

impl<G: LieGroup, A: Copy> AnyStepper<G, A> {
    /// As [`Stepper::start`].
    ///
    /// # Errors
    ///
    /// As [`Stepper::start`].
    pub fn start(&self, attitude: impl Into<G>, velocity: G::Vector) -> Result<AnyState<G, A>, SetupError> {
        self.0.start(attitude.into(), velocity)
    }

    /// As [`Stepper::step`]. A state of another stepper on this group goes on from its attitude and momentum.
    ///
    /// # Errors
    ///
    /// As [`Stepper::step`].
    pub fn step(&self, state: &mut AnyState<G, A>) -> Result<StepReport, StepError> {
        self.0.step(&mut state.motion, &mut state.kept)
    }

    /// As [`Stepper::run`].
    ///
    /// # Errors
    ///
    /// As [`Stepper::run`].
    pub fn run(&self, state: &mut AnyState<G, A>, steps: u64) -> Result<u64, StepError> {
        self.0.run(&mut state.motion, &mut state.kept, (steps, true))
    }

    /// As [`Stepper::run_unexplained`].
    pub(crate) fn run_unexplained(&self, state: &mut AnyState<G, A>, steps: u64) -> Result<u64, StepError> {
        self.0.run(&mut state.motion, &mut state.kept, (steps, false))
    }

    /// As [`Integrator::run_shown`].
    pub(crate) fn run_shown(
        &self,
        state: &mut AnyState<G, A>,
        steps: u64,
        next: &mut NextSteps<'_, G, A>,
    ) -> Result<u64, StepError> {
        self.0.run_shown(&mut state.motion, &mut state.kept, steps, next)
    }

    /// As [`Integrator::part`].
    pub(crate) fn fraction_of_a_step(
        &self,
        state: &AnyState<G, A>,
        fraction: G::Scalar,
    ) -> Result<Motion<G, A>, StepError> {
        self.0.part(&state.motion, &state.kept, fraction)
    }

    /// As [`Stepper::adopt`].
    #[must_use]
    pub fn adopt(&self, motion: &Motion<G, A>) -> AnyState<G, A> {
        self.0.adopt(motion)
    }

    /// The step `h`, s.
    #[must_use]
    pub fn step_size(&self) -> G::Scalar {
        self.0.step_size()
    }

    /// The time since the start, `n h`, s; never accumulated.
    #[must_use]
    #[allow(clippy::cast_precision_loss)] // as `Stepper::time`
    pub fn time(&self, motion: &Motion<G, A>) -> G::Scalar {
        self.step_size() * real(motion.steps as f64)
    }

    /// As [`Stepper::velocity`].
    #[must_use]
    pub fn velocity(&self, motion: &Motion<G, A>) -> G::Vector {
        self.0.velocity(motion)
    }

    /// As [`Stepper::energy`].
    #[must_use]
    pub fn energy(&self, motion: &Motion<G, A>) -> G::Scalar {
        self.0.energy(motion)
    }

    /// As [`Integrator::factored_inertia`].
    pub(crate) fn factored_inertia(&self) -> Option<FactoredInertia<G>> {
        self.0.factored_inertia()
    }

    /// As [`Integrator::velocity_and_energy`].
    pub(crate) fn velocity_and_energy(
        &self,
        motion: &Motion<G, A>,
        inertia: Option<&FactoredInertia<G>>,
    ) -> (G::Vector, G::Scalar) {
        self.0.velocity_and_energy(motion, inertia)
    }

    /// As [`Plan::cost`].
    #[must_use]
    pub fn cost(&self) -> Cost {
        self.0.cost()
    }
}

/// A stepper that hides what is advected: it is kept with what the method keeps.
struct Hiding<G: LieGroup, A>(AnyStepper<G, A>);

#[derive(Clone, Debug, PartialEq)]
struct Hidden<A> {
    advected: A,
    kept: AnyKept,
}

impl<G: LieGroup, A: Advected<G> + 'static> Hiding<G, A> {
    /// As [`own`].
    fn own(&self, motion: &Motion<G, ()>, kept: &AnyKept) -> AnyState<G, A> {
        match kept.0.as_ref().as_any().downcast_ref::<Hidden<A>>() {
            Some(hidden) => State { motion: seeing(motion, hidden.advected), kept: hidden.kept.clone() },
            None => self.anew(motion),
        }
    }

    /// The state of this stepper with the attitude and the momentum of another.
    fn anew(&self, motion: &Motion<G, ()>) -> AnyState<G, A> {
        // Which values it is told to see makes no difference: it sees its own.
        let mut state = self.0.adopt(&seeing(motion, A::from_entries(&mut || real(0.0))));
        state.motion.steps = motion.steps;
        state
    }
}

/// The same motion with these advected values.
fn seeing<G: LieGroup, A, B>(motion: &Motion<G, A>, advected: B) -> Motion<G, B> {
    Motion { attitude: motion.attitude, momentum: motion.momentum, advected, steps: motion.steps }
}

fn hidden<G: LieGroup, A: Debug + PartialEq + Copy + 'static>(state: AnyState<G, A>) -> AnyState<G, ()> {
    let State { motion, kept } = state;
    State { motion: seeing(&motion, ()), kept: AnyKept(Box::new(Hidden { advected: motion.advected, kept })) }
}

fn taken_apart<G: LieGroup>(state: AnyState<G, ()>) -> (Motion<G, ()>, AnyKept) {
    (state.motion, state.kept)
}

impl<G: LieGroup, A: Advected<G> + 'static> Erased<G, ()> for Hiding<G, A> {
    fn start(&self, attitude: G, velocity: G::Vector) -> Result<AnyState<G, ()>, SetupError> {
        self.0.start(attitude, velocity).map(hidden)
    }

    fn step(&self, motion: &mut Motion<G, ()>, kept: &mut AnyKept) -> Result<StepReport, StepError> {
        let mut state = self.own(motion, kept);
        let report = self.0.step(&mut state)?;
        (*motion, *kept) = taken_apart(hidden(state));
        Ok(report)
    }

    fn run(
        &self,
        motion: &mut Motion<G, ()>,
        kept: &mut AnyKept,
        (steps, explain): (u64, bool),
    ) -> Result<u64, StepError> {
        let mut state = self.own(motion, kept);
        let made = if explain { self.0.run(&mut state, steps) } else { self.0.run_unexplained(&mut state, steps) };
        let iterations = made?;
        (*motion, *kept) = taken_apart(hidden(state));
        Ok(iterations)
    }

    fn run_shown(
        &self,
        motion: &mut Motion<G, ()>,
        kept: &mut AnyKept,
        steps: u64,
        next: &mut NextSteps<'_, G, ()>,
    ) -> Result<u64, StepError> {
        let mut state = self.own(motion, kept);
        let made = self.0.run_shown(&mut state, steps, &mut |shown| next(&seeing(shown, ())));
        if state.steps != motion.steps {
            (*motion, *kept) = taken_apart(hidden(state));
        }
        made
    }

    fn part(&self, motion: &Motion<G, ()>, kept: &AnyKept, fraction: G::Scalar) -> Result<Motion<G, ()>, StepError> {
        let part = self.0.fraction_of_a_step(&self.own(motion, kept), fraction)?;
        Ok(seeing(&part, ()))
    }

    fn adopt(&self, motion: &Motion<G, ()>) -> AnyState<G, ()> {
        let mut state = self.anew(motion);
        state.motion.steps = 0;
        hidden(state)
    }

    fn step_size(&self) -> G::Scalar {
        self.0.step_size()
    }

    fn velocity(&self, motion: &Motion<G, ()>) -> G::Vector {
        self.0.velocity(&self.anew(motion))
    }

    fn energy(&self, motion: &Motion<G, ()>) -> G::Scalar {
        self.0.energy(&self.anew(motion))
    }

    fn factored_inertia(&self) -> Option<FactoredInertia<G>> {
        self.0.factored_inertia()
    }

    fn velocity_and_energy(
        &self,
        motion: &Motion<G, ()>,
        inertia: Option<&FactoredInertia<G>>,
    ) -> (G::Vector, G::Scalar) {
        self.0.velocity_and_energy(&self.anew(motion), inertia)
    }

    fn cost(&self) -> Cost {
        self.0.cost()
    }
}

impl<G: LieGroup, A: Advected<G> + 'static> AnyStepper<G, A> {
    /// The same without what is advected in its type: for programs that keep steppers of different scenes side by side.
    ///
    /// The steps are the same to the bit. Of a motion alone what is advected is as its attitude sees it, so that a
    /// [velocity](Self::velocity) and an [energy](Self::energy) that depend on it are the same to rounding.
    #[must_use]
    pub fn hiding_advected(self) -> AnyStepper<G, ()> {
        AnyStepper(Rc::new(Hiding(self)))
    }
}

impl<G: LieGroup, A> Debug for AnyStepper<G, A> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("AnyStepper").finish_non_exhaustive()
    }
}
