//! A stepper without its scene and method in the type.

use alloc::boxed::Box;
use alloc::rc::Rc;
use core::any::Any;
use core::fmt::{self, Debug};
use core::mem;

use crate::error::{SetupError, StepError};
use crate::groups::{Advected, LieGroup};
use crate::mechanics::{Effect, FactoredInertia, Group};
use crate::motion::integrator::{Integrator, seeing};
use crate::motion::plan::{Cost, NextSteps, Plan};
use crate::motion::report::StepReport;
use crate::motion::state::State;
use crate::motion::stepper::Stepper;
use crate::motion::summation::Motion;

/// A [`Stepper`] of any scene and any method on the group `G`, by [`Stepper::into_any`]: for programs that choose scene
/// and method at run time.
///
/// The stepper steps, runs and is read as an [`Integrator`]. A step costs one more indirect call. A state of another
/// stepper on this group continues from its attitude and momentum.
///
/// A clone is the same stepper, and costs nothing.
pub struct AnyStepper<G: LieGroup, A> {
    stepper: Rc<dyn Integrator<Group = G, Advected = A, State = AnyState<G, A>>>,
    start: Rc<Start<G, A>>,
    cost: Cost,
}

/// The function that constructs a state from an attitude and a velocity.
type Start<G, A> = dyn Fn(G, <G as LieGroup>::Vector) -> Result<AnyState<G, A>, SetupError>;

impl<G: LieGroup, A> Clone for AnyStepper<G, A> {
    fn clone(&self) -> Self {
        Self { stepper: Rc::clone(&self.stepper), start: Rc::clone(&self.start), cost: self.cost }
    }
}

/// The state of an [`AnyStepper`].
pub type AnyState<G, A> = State<G, A, AnyHistory>;

/// The memory of any method.
#[doc(hidden)]
pub struct AnyHistory(Box<dyn AnyMemory>);

trait AnyMemory: Any + Debug {
    fn copied(&self) -> Box<dyn AnyMemory>;
    fn equals(&self, other: &dyn AnyMemory) -> bool;
}

impl<K: Any + Clone + Debug + PartialEq> AnyMemory for K {
    fn copied(&self) -> Box<dyn AnyMemory> {
        Box::new(self.clone())
    }

    fn equals(&self, other: &dyn AnyMemory) -> bool {
        (other as &dyn Any).downcast_ref::<K>() == Some(self)
    }
}

impl AnyHistory {
    fn of(kept: impl AnyMemory) -> Self {
        Self(Box::new(kept))
    }
}

impl Clone for AnyHistory {
    fn clone(&self) -> Self {
        // Dereferenced explicitly, because the box implements `AnyMemory`, too.
        Self(self.0.as_ref().copied())
    }
}

impl PartialEq for AnyHistory {
    fn eq(&self, other: &Self) -> bool {
        self.0.as_ref().equals(other.0.as_ref())
    }
}

impl Debug for AnyHistory {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.as_ref().fmt(f)
    }
}

/// The functions of an integrator around another. Its `change` steps the inner integrator, which reads a state as `own`
/// and a motion as `seen`, and calls `shown` after each stretch.
macro_rules! wraps {
    ($self:ident, $inner:expr, $state:ident => $own:expr, $motion:ident: $type:ty, $seen:expr, $next:ident => $shown:expr) => {
        fn step(&$self, state: &mut Self::State) -> Result<StepReport, StepError> {
            $self.change(state, |own| $inner.step(own))
        }

        fn run(&$self, state: &mut Self::State, steps: u64) -> Result<u64, StepError> {
            $self.change(state, |own| $inner.run(own, steps))
        }

        fn attempt(&$self, state: &mut Self::State, steps: u64) -> Result<u64, StepError> {
            $self.change(state, |own| $inner.attempt(own, steps))
        }

        fn run_stretches(
            &$self,
            state: &mut Self::State,
            steps: u64,
            $next: &mut NextSteps<'_, Self::Group, Self::Advected>,
        ) -> Result<u64, StepError> {
            $self.change(state, |own| $inner.run_stretches(own, steps, $shown))
        }

        fn cost(&$self) -> Option<Cost> {
            Integrator::cost(&$inner)
        }

        fn time(&$self, $state: &Self::State) -> G::Scalar {
            $inner.time($own)
        }

        fn length(&$self, $state: &Self::State) -> Option<G::Scalar> {
            $inner.length($own)
        }

        fn step_size(&$self) -> G::Scalar {
            $inner.step_size()
        }

        fn velocity(&$self, $motion: $type) -> G::Vector {
            $inner.velocity($seen)
        }

        fn energy(&$self, $motion: $type) -> G::Scalar {
            $inner.energy($seen)
        }

        fn factored_inertia(&$self) -> Option<FactoredInertia<G>> {
            $inner.factored_inertia()
        }

        fn velocity_and_energy(
            &$self,
            $motion: $type,
            inertia: Option<&FactoredInertia<G>>,
        ) -> (G::Vector, G::Scalar) {
            $inner.velocity_and_energy($seen, inertia)
        }
    };
}

/// An integrator that erases the type of its state's memory.
struct Erasure<I>(I);

impl<I, G, A, K> Erasure<I>
where
    I: Integrator<Group = G, Advected = A, State = State<G, A, K>>,
    G: LieGroup,
    A: Advected<G>,
    K: AnyMemory + Clone,
{
    /// The inner integrator's state. A memory of another method is useless to it, and a new one is initialised.
    fn own(&self, state: &AnyState<G, A>) -> I::State {
        if let Some(kept) = (state.kept.0.as_ref() as &dyn Any).downcast_ref::<K>() {
            return State { motion: state.motion, kept: kept.clone(), elapsed: state.elapsed };
        }
        let mut own = self.0.adopt(&state.motion);
        own.motion = self.0.seen(&seeing(&state.motion, ()));
        own.elapsed = state.elapsed;
        own
    }

    /// Applies `steps` to the inner state. The state is updated to the last step even after an error.
    fn change<R>(&self, state: &mut AnyState<G, A>, steps: impl FnOnce(&mut I::State) -> R) -> R {
        let mut own = self.own(state);
        let made = steps(&mut own);
        if own.steps != state.steps {
            (state.motion, state.elapsed) = (own.motion, own.elapsed);
            match (state.kept.0.as_mut() as &mut dyn Any).downcast_mut::<K>() {
                Some(place) => *place = own.kept,
                None => state.kept = AnyHistory::of(own.kept),
            }
        }
        made
    }
}

fn erased<G: LieGroup, A, K: AnyMemory>(state: State<G, A, K>) -> AnyState<G, A> {
    State { motion: state.motion, kept: AnyHistory::of(state.kept), elapsed: state.elapsed }
}

impl<I, G, A, K> Integrator for Erasure<I>
where
    I: Integrator<Group = G, Advected = A, State = State<G, A, K>>,
    G: LieGroup,
    A: Advected<G>,
    K: AnyMemory + Clone,
{
    type Group = G;
    type Advected = A;
    type State = AnyState<G, A>;

    fn part(&self, state: &Self::State, fraction: G::Scalar) -> Result<Motion<G, A>, StepError> {
        self.0.part(&self.own(state), fraction)
    }

    fn adopt(&self, motion: &Motion<G, A>) -> Self::State {
        erased(self.0.adopt(motion))
    }

    fn seen(&self, motion: &Motion<G, ()>) -> Motion<G, A> {
        self.0.seen(motion)
    }

    wraps!(self, self.0, state => &self.own(state), motion: &Motion<G, A>, motion, next => next);
}

/// # Wrap: a stepper of any type
impl<S: Effect + 'static, P: Plan<S, Kept: 'static> + 'static> Stepper<S, P> {
    /// Erases the scene and the method from the type.
    #[must_use]
    pub fn into_any(self) -> AnyStepper<Group<S>, S::Advected> {
        let (cost, stepper) = (self.plan.cost(), Rc::new(Erasure(self)));
        let start = Rc::clone(&stepper);
        let start = Rc::new(move |attitude, velocity| start.0.start(attitude, velocity).map(erased));
        AnyStepper { stepper, start, cost }
    }
}

impl<G: LieGroup, A> AnyStepper<G, A> {
    /// A state from an attitude and a velocity, as by [`Stepper::start`].
    ///
    /// # Errors
    ///
    /// The errors of [`Stepper::start`].
    pub fn start(&self, attitude: impl Into<G>, velocity: G::Vector) -> Result<AnyState<G, A>, SetupError> {
        (self.start)(attitude.into(), velocity)
    }

    /// The cost of a step, as by [`Plan::cost`].
    #[must_use]
    pub fn cost(&self) -> Cost {
        self.cost
    }

    #[allow(clippy::unused_self)] // by the form that `wraps` asks for
    fn change<R>(&self, state: &mut AnyState<G, A>, steps: impl FnOnce(&mut AnyState<G, A>) -> R) -> R {
        steps(state)
    }
}

impl<G: LieGroup, A: Advected<G>> Integrator for AnyStepper<G, A> {
    type Group = G;
    type Advected = A;
    type State = AnyState<G, A>;

    fn part(&self, state: &Self::State, fraction: G::Scalar) -> Result<Motion<G, A>, StepError> {
        self.stepper.part(state, fraction)
    }

    fn adopt(&self, motion: &Motion<G, A>) -> Self::State {
        self.stepper.adopt(motion)
    }

    fn seen(&self, motion: &Motion<G, ()>) -> Motion<G, A> {
        self.stepper.seen(motion)
    }

    wraps!(self, *self.stepper, state => state, motion: &Motion<G, A>, motion, next => next);
}

/// A stepper that hides the advected parameters: its memory contains them.
struct WithoutAdvected<G: LieGroup, A>(AnyStepper<G, A>);

#[derive(Clone, Debug, PartialEq)]
struct HiddenState<A> {
    advected: A,
    kept: AnyHistory,
}

impl<G: LieGroup, A: Advected<G>> WithoutAdvected<G, A> {
    #[allow(clippy::unused_self)] // by the form that `wraps` asks for
    fn change<R>(&self, state: &mut State<G, (), HiddenState<A>>, steps: impl FnOnce(&mut AnyState<G, A>) -> R) -> R {
        let kept = mem::replace(&mut state.kept.kept, AnyHistory::of(()));
        let mut own = State { motion: seeing(&state.motion, state.kept.advected), kept, elapsed: state.elapsed };
        let made = steps(&mut own);
        *state = hidden(own);
        made
    }
}

fn hidden<G: LieGroup, A: Copy>(State { motion, kept, elapsed }: AnyState<G, A>) -> State<G, (), HiddenState<A>> {
    State { motion: seeing(&motion, ()), kept: HiddenState { advected: motion.advected, kept }, elapsed }
}

fn shown<G: LieGroup, A: Copy>(state: &State<G, (), HiddenState<A>>) -> AnyState<G, A> {
    let HiddenState { advected, kept } = state.kept.clone();
    State { motion: seeing(&state.motion, advected), kept, elapsed: state.elapsed }
}

impl<G: LieGroup, A: Advected<G>> Integrator for WithoutAdvected<G, A> {
    type Group = G;
    type Advected = ();
    type State = State<G, (), HiddenState<A>>;

    fn part(&self, state: &Self::State, fraction: G::Scalar) -> Result<Motion<G, ()>, StepError> {
        Ok(seeing(&self.0.part(&shown(state), fraction)?, ()))
    }

    fn adopt(&self, motion: &Motion<G, ()>) -> Self::State {
        hidden(self.0.adopt(&self.0.seen(motion)))
    }

    wraps!(
        self, self.0, state => &shown(state), motion: &Motion<G, ()>, &self.0.seen(motion),
        next => &mut |shown, time| next(&seeing(shown, ()), time)
    );
}

impl<G: LieGroup, A: Advected<G> + 'static> AnyStepper<G, A> {
    /// Erases the advected parameters from the type: for programs with steppers of different scenes in one collection.
    ///
    /// The steps are the same to the bit. The advected parameters of a motion without a memory are computed from its
    /// attitude. So a [velocity](Integrator::velocity) and an [energy](Integrator::energy) that depend on them are the
    /// same to rounding.
    #[must_use]
    pub fn hiding_advected(self) -> AnyStepper<G, ()> {
        let (start, cost) = (Rc::clone(&self.start), self.cost);
        let start = Rc::new(move |attitude, velocity| start(attitude, velocity).map(hidden).map(erased));
        AnyStepper { stepper: Rc::new(Erasure(WithoutAdvected(self))), start, cost }
    }
}

impl<G: LieGroup, A> Debug for AnyStepper<G, A> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("AnyStepper").finish_non_exhaustive()
    }
}
