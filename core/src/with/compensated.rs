//! Compensated summation: the rounding error of each sum in a state is stored and added to the next summand.
//!
//! A step adds small changes to the attitude, the momentum and the advected parameters: `R + R D`, `w + Dᵀ w`,
//! `p + (Dᵀ a + kicks)`. Each sum loses some `ε` of the state, and these errors walk at random; the changes themselves
//! are wrong by some `ε` of a change only. With compensation only the walk of the changes is left, smaller by the angle
//! of a step: at `h = 10⁻⁴` it can't be measured in 10⁷ steps, near a radian a step nothing is gained.

use crate::error::{SetupError, StepError};
use crate::groups::{Advected, LieGroup};
use crate::mechanics::{Effect, Group, Scalar, SceneVisitor, Vector};
use crate::methods::{Composition, KineticFlow, LinkedBodies, ProcessedSplitting, Splitting};
use crate::motion::{
    Kept, Motion, MotionOf, OwnStep, Plan, Steerable, StepReport, Stepper, Summation, TOLERATED, Variable, restored,
};
use crate::numbers::{Entries, carried_sum, replaced, zero};
use crate::with::remedies::Substeps;
use nalgebra::SimdValue as _;

/// A plan whose sums are compensated, by [`Stepper::compensated`].
///
/// The step is the same map; only its rounding differs. `cargo bench -p liestep-benches -- heavy-top` measures its cost.
///
/// # Examples
///
/// ```
/// use liestep::effects::PrincipalBody;
/// use liestep::{SO3, Stepper};
/// use liestep::groups::LieGroup as _;
/// use liestep::mechanics::DiagonalNonstandardInertia;
/// use nalgebra::Vector3;
///
/// let J_d = DiagonalNonstandardInertia::from_principal_moments(Vector3::new(1.0, 2.0, 2.5))?;
/// let stepper = Stepper::new(PrincipalBody { J_d }, 1e-4)?.compensated();
/// let mut state = stepper.start(SO3::identity(), Vector3::new(0.01, 2.0, 0.02))?;
/// for _ in 0..1000 {
///     stepper.step(&mut state)?;
/// }
/// assert!(state.orthogonality_defect() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Lanes, InLanes)]
pub struct CompensatedSums<P>(P);

/// The exact sums less the rounded ones, stored beside the plan's memory.
#[derive(Clone, Copy, Debug, PartialEq, Lanes)]
pub struct Carry<G: LieGroup, A> {
    attitude: G::Matrix,
    momentum: G::Vector,
    advected: A,
}

impl<G: LieGroup, A: Advected<G>> Carry<G, A> {
    fn nothing() -> Self {
        Self { attitude: zero(), momentum: zero(), advected: zero() }
    }
}

/// A plan that leaves the sums of its steps to its caller, which can compensate them.
///
/// Collocation isn't one: its sums are compensated already, in quaternion and momentum.
#[diagnostic::on_unimplemented(
    message = "the sums of `{Self}` can't be compensated",
    label = "not with this method",
    note = "Gauss collocation compensates its own sums, and compensated sums needn't be compensated again"
)]
pub trait Compensable {}

impl<S: Effect> Compensable for OwnStep<S> {}
impl<S: Effect> Compensable for Composition<S> {}
impl<S: Effect, const N: usize> Compensable for LinkedBodies<S, N> {}
impl<S: Effect, K: KineticFlow<Scalar<S>>> Compensable for Splitting<S, K> {}
impl<S: Effect, K: KineticFlow<Scalar<S>>> Compensable for ProcessedSplitting<S, K> {}
impl<P: Compensable> Compensable for Substeps<P> {}

impl<S: Effect, P: Steerable<S>> Steerable<S> for CompensatedSums<P> {
    fn see(&self, motion: &mut MotionOf<S>, kept: &mut Self::Kept, advected: S::Advected) {
        self.0.see(motion, &mut kept.0, advected);
        kept.1.advected = zero();
    }
}

impl<S: Effect, P: Variable<S>> Variable<S> for CompensatedSums<P> {}

/// # Wrap: compensated sums
impl<S: Effect, P: Plan<S>> Stepper<S, P> {
    /// Compensates the sums of a step: the rounding errors of attitude, momentum and advected parameters are stored and
    /// added to the next step's changes.
    ///
    /// Collocation always compensates its sums, and doesn't compile with this.
    #[must_use]
    pub fn compensated(self) -> Stepper<S, CompensatedSums<P>>
    where
        P: Compensable,
    {
        Stepper { scene: self.scene, plan: CompensatedSums(self.plan) }
    }
}

impl<S: Effect, P: Plan<S>> Plan<S> for CompensatedSums<P> {
    type Kept = (P::Kept, Carry<Group<S>, S::Advected>);

    delegate_plan!(0, |kept| kept.0; facts step_size momentum velocity max_step cost);

    fn refolded(&self, scene: &S, h: Scalar<S>) -> Result<Self, SetupError> {
        self.0.refolded(scene, h).map(Self)
    }

    fn keep(&self, scene: &S, motion: &MotionOf<S>) -> Self::Kept {
        (self.0.keep(scene, motion), Carry::nothing())
    }

    #[hot]
    fn step<M: Summation<Group<S>, S::Advected>>(
        &self,
        scene: &S,
        motion: &mut M,
        kept: &mut Self::Kept,
    ) -> Result<StepReport, StepError> {
        let mut sums = Sums { motion: *motion.now(), carry: kept.1 };
        let report = self.0.step(scene, &mut sums, &mut kept.0)?;
        motion.replace(sums.motion);
        kept.1 = sums.carry;
        Ok(report)
    }

    #[hot]
    fn run<M: Summation<Group<S>, S::Advected>>(
        &self,
        scene: &S,
        motion: &mut M,
        kept: &mut Self::Kept,
        steps: u64,
    ) -> Result<u64, StepError> {
        let mut sums = Sums { motion: *motion.now(), carry: kept.1 };
        let iterations = self.0.run(scene, &mut sums, &mut kept.0, steps)?;
        motion.replace(sums.motion);
        kept.1 = sums.carry;
        Ok(iterations)
    }

    fn push<M: Summation<Group<S>, S::Advected>>(
        &self,
        scene: &S,
        motion: &mut M,
        kept: &mut Self::Kept,
        impulse: &Vector<S>,
    ) {
        let mut sums = Sums { motion: *motion.now(), carry: kept.1 };
        self.0.push(scene, &mut sums, &mut kept.0, impulse);
        motion.replace(sums.motion);
        kept.1 = sums.carry;
    }

    fn describe(&self, visitor: &mut dyn SceneVisitor<Scalar<S>>) {
        visitor.term("compensated");
        self.0.describe(visitor);
    }
}

impl<G: LieGroup, A: Advected<G>> Kept<G::Scalar> for Carry<G, A> {
    fn with_numbers(&self, number: &mut dyn FnMut(G::Scalar) -> G::Scalar) -> Option<Self> {
        let (attitude, momentum) = (replaced(&self.attitude, number), replaced(&self.momentum, number));
        Some(Self { attitude, momentum, advected: replaced(&self.advected, number) })
    }
}

/// A motion and the rounding errors of its sums.
#[derive(Clone, Copy)]
struct Sums<G: LieGroup, A> {
    motion: Motion<G, A>,
    carry: Carry<G, A>,
}

#[hot]
impl<G: LieGroup, A: Advected<G>> Summation<G, A> for Sums<G, A> {
    const CARRIES: bool = true;

    fn now(&self) -> &Motion<G, A> {
        &self.motion
    }

    fn turn(&mut self, increment: &G::Matrix) {
        let Self { motion, carry } = self;
        let attitude = carried_sum(&motion.attitude.matrix(), &motion.attitude.change(increment), &carry.attitude);
        let advected = carried_sum(&motion.advected, &motion.advected.change(increment), &carry.advected);
        motion.attitude = G::from_matrix_unchecked(attitude.0);
        motion.advected = advected.0;
        (carry.attitude, carry.advected) = (attitude.1, advected.1);
    }

    fn turned(&self, increment: &G::Matrix) -> A {
        let Self { motion, carry } = self;
        carried_sum(&motion.advected, &motion.advected.change(increment), &carry.advected).0
    }

    fn push(&mut self, change: &G::Vector) {
        let momentum = carried_sum(&self.motion.momentum, change, &self.carry.momentum);
        (self.motion.momentum, self.carry.momentum) = momentum;
    }

    fn proceed(&mut self, increment: &G::Matrix, change: &G::Vector, _: (G::Vector, A)) {
        self.turn_and_push(increment, change);
    }

    fn recount(&mut self, steps: u64) {
        self.motion.steps = steps;
    }

    /// Clears the carry, which belongs to the attitude before.
    #[cold]
    fn restore(&mut self, spatial: &A) {
        let Some(far) = restored(&mut self.motion, spatial, TOLERATED) else { return };
        let mut kept = |carry: G::Scalar, nothing: G::Scalar| nothing.select(far, carry);
        self.carry.attitude = self.carry.attitude.zip(&zero(), &mut kept);
        self.carry.advected = self.carry.advected.zip(&zero(), &mut kept);
    }

    fn replace(&mut self, motion: Motion<G, A>) {
        *self = Self { motion, carry: Carry::nothing() };
    }

    fn show(&mut self, motion: Motion<G, A>) {
        self.motion = motion;
    }
}
