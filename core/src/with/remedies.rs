//! What to do about a step that has no solution, for those who would rather go on than stop.
//!
//! A [`Stepper`] refuses such a step and leaves the state alone. A remedy makes another step in its place, and the report
//! says so. Both remedies here give up something; a motion that needs them often wants a smaller step.

use crate::error::{SetupError, StepError};
use crate::mechanics::{Effect, Group, Scalar, SceneVisitor, Vector};
use crate::motion::{Cost, Motion, Plan, Remedy, Steerable, StepReport, Stepper, Summation};
use crate::numbers::{Vectors, real};

/// A plan that has a remedy for steps without a solution, by [`Stepper::or_substeps`] or [`Stepper::or_fallback`].
#[derive(Clone, Copy, Debug)]
#[doc(hidden)]
pub struct OrElse<P, R> {
    plan: P,
    remedy: R,
}

/// The remedy that takes a step in equal parts.
#[derive(Clone, Copy, Debug)]
pub struct Substeps {
    at_most: u32,
}

/// Another step in the place of one that has no solution: [`Substeps`], or the step of another [`Stepper`].
#[doc(hidden)]
pub trait Instead<S: Effect>: Sized {
    /// The remedy for the same plan with another step.
    ///
    /// # Errors
    ///
    /// [`SetupError`] where there is no such step.
    fn refolded(&self, h: Scalar<S>) -> Result<Self, SetupError>;

    /// Makes the step in another way, or leaves everything as it was and returns the error.
    ///
    /// # Errors
    ///
    /// The error that the step was refused with, where there is no other way either.
    fn step<P: Plan<S>, M: Summation<Group<S>, S::Advected>>(
        &self,
        plan: &P,
        scene: &S,
        moved: (&mut M, &mut P::Kept),
        error: StepError,
    ) -> Result<StepReport, StepError>;

    /// Shows its name and every constant.
    fn describe(&self, visitor: &mut dyn SceneVisitor<Scalar<S>>);
}

/// # Wrap: remedies
impl<S: Effect, P: Plan<S>> Stepper<S, P> {
    /// The same steps, and where there is none that step in 2, 4, 8, … equal parts, as few as will do and no more than
    /// these.
    ///
    /// The motion through such a step is as good as any other, but the step isn't constant then: the energy keeps to its
    /// bound between two such steps and may change by the order of `h²` at each, so that over many it can drift. What a
    /// step conserves whatever its size is kept: the group, the momentum maps, the Casimirs.
    ///
    /// The constants of the parts are folded anew each time, which takes far longer than a step.
    ///
    /// # Examples
    ///
    /// ```
    /// use liestep::motion::Remedy;
    /// use liestep::{SO3, Stepper, lagrangian};
    /// use liestep::groups::LieGroup as _;
    /// use liestep::mechanics::DiagonalNonstandardInertia;
    /// use nalgebra::Vector3;
    ///
    /// /// A free rigid body.
    /// #[lagrangian(group = SO3, l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
    /// struct Body {
    ///     J_d: DiagonalNonstandardInertia,
    /// }
    ///
    /// let J_d = DiagonalNonstandardInertia::from_principal_moments(Vector3::new(1.0, 2.0, 2.5))?;
    /// let stepper = Stepper::new(Body { J_d }, 0.1)?.or_substeps(8);
    /// let mut state = stepper.start(SO3::identity(), Vector3::new(0.0, 25.0, 0.0))?;
    /// let report = stepper.step(&mut state)?;
    /// assert_eq!(report.remedy, Some(Remedy::Substeps(4)));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn or_substeps(self, at_most: u32) -> Stepper<S, OrElse<P, Substeps>> {
        Stepper { scene: self.scene, plan: OrElse { plan: self.plan, remedy: Substeps { at_most } } }
    }

    /// The same steps, and where there is none the step of another scene, or another method, with the same group and
    /// advected parameters.
    ///
    /// The one that is meant is the same system with a kinetic term that has a solution at every `h`, like that of
    /// [`CayleyBody`](crate::effects::CayleyBody) (for bodies that aren't needles). It is variational too, of the same
    /// order, with an error about twice as large; but another map, so that changing over has the effect on the energy
    /// that [substeps](Self::or_substeps) have.
    ///
    /// # Errors
    ///
    /// [`SetupError::InvalidStep`] where the other step isn't of the same length.
    #[allow(clippy::type_complexity)] // a stepper with a stepper in it
    pub fn or_fallback<R, Q>(self, other: Stepper<R, Q>) -> Result<Stepper<S, OrElse<P, Stepper<R, Q>>>, SetupError>
    where
        R: Effect<Scalar = S::Scalar, Group = S::Group, Advected = S::Advected>,
        Q: Plan<R>,
    {
        use nalgebra::{SimdBool as _, SimdPartialOrd as _};
        if !other.step_size().simd_eq(self.step_size()).all() {
            return Err(SetupError::InvalidStep { step: crate::numbers::reported(other.step_size()) });
        }
        Ok(Stepper { scene: self.scene, plan: OrElse { plan: self.plan, remedy: other } })
    }
}

impl<S: Effect, P: Plan<S>, R: Instead<S>> Plan<S> for OrElse<P, R> {
    type Kept = P::Kept;

    const VECTORS: Vectors = P::VECTORS;
    const EXPLAINS: bool = P::EXPLAINS;

    fn step_size(&self) -> Scalar<S> {
        self.plan.step_size()
    }

    fn refolded(&self, scene: &S, h: Scalar<S>) -> Result<Self, SetupError> {
        Ok(Self { plan: self.plan.refolded(scene, h)?, remedy: self.remedy.refolded(h)? })
    }

    fn keep(&self, scene: &S, motion: &Motion<Group<S>, S::Advected>) -> Self::Kept {
        self.plan.keep(scene, motion)
    }

    fn admits(&self, scene: &S, motion: &Motion<Group<S>, S::Advected>) -> Result<(), SetupError> {
        self.plan.admits(scene, motion)
    }

    fn is_in_step(&self, kept: &Self::Kept) -> bool {
        self.plan.is_in_step(kept)
    }

    #[hot]
    fn step<M: Summation<Group<S>, S::Advected>>(
        &self,
        scene: &S,
        motion: &mut M,
        kept: &mut Self::Kept,
    ) -> Result<StepReport, StepError> {
        match self.plan.step(scene, motion, kept) {
            Ok(report) => Ok(report),
            Err(error) => self.remedy.step(&self.plan, scene, (motion, kept), error),
        }
    }

    fn push<M: Summation<Group<S>, S::Advected>>(
        &self,
        scene: &S,
        motion: &mut M,
        kept: &mut Self::Kept,
        impulse: &Vector<S>,
    ) -> Result<(), StepError> {
        self.plan.push(scene, motion, kept, impulse)
    }

    fn see(&self, motion: &mut Motion<Group<S>, S::Advected>, kept: &mut Self::Kept, advected: S::Advected) {
        self.plan.see(motion, kept, advected);
    }

    fn explained(
        &self,
        error: StepError,
        scene: &S,
        motion: &Motion<Group<S>, S::Advected>,
        kept: &Self::Kept,
    ) -> StepError {
        self.plan.explained(error, scene, motion, kept)
    }

    /// Of the plan itself: a step that only its remedy makes is none of its own.
    fn max_step(&self, scene: &S, motion: &Motion<Group<S>, S::Advected>, kept: &Self::Kept) -> Scalar<S> {
        self.plan.max_step(scene, motion, kept)
    }

    fn describe(&self, visitor: &mut dyn SceneVisitor<Scalar<S>>) {
        self.remedy.describe(visitor);
        self.plan.describe(visitor);
    }

    fn cost(&self) -> Cost {
        self.plan.cost()
    }
}

impl<P: Steerable> Steerable for OrElse<P, Substeps> {}
impl<P: Steerable, R: Effect, Q: Steerable> Steerable for OrElse<P, Stepper<R, Q>> {}

impl<S: Effect> Instead<S> for Substeps {
    fn refolded(&self, _: Scalar<S>) -> Result<Self, SetupError> {
        Ok(*self)
    }

    #[cold]
    #[inline(never)]
    fn step<P: Plan<S>, M: Summation<Group<S>, S::Advected>>(
        &self,
        plan: &P,
        scene: &S,
        (motion, kept): (&mut M, &mut P::Kept),
        error: StepError,
    ) -> Result<StepReport, StepError> {
        if matches!(error, StepError::NonFinite { .. }) {
            return Err(error);
        }
        let steps = motion.now().steps;
        let mut parts = 2;
        while parts <= self.at_most {
            if let Some((mut moved, iterations)) = substepped(plan, scene, *motion, parts) {
                moved.recount(steps + 1);
                // What isn't a step of the whole tells nothing of the next one's increment.
                *kept = plan.keep(scene, moved.now());
                *motion = moved;
                return Ok(StepReport { iterations, remedy: Some(Remedy::Substeps(parts)) });
            }
            let Some(more) = parts.checked_mul(2) else { break };
            parts = more;
        }
        Err(error)
    }

    fn describe(&self, visitor: &mut dyn SceneVisitor<Scalar<S>>) {
        visitor.term("or substeps");
        visitor.parameter("at most", real(f64::from(self.at_most)));
    }
}

/// The motion after `parts` steps of an equal part of `h`, and all their iterations.
#[cold]
#[inline(never)]
fn substepped<S: Effect, P: Plan<S>, M: Summation<Group<S>, S::Advected>>(
    plan: &P,
    scene: &S,
    mut motion: M,
    parts: u32,
) -> Option<(M, u32)> {
    let small = plan.refolded(scene, plan.step_size() / real(f64::from(parts))).ok()?;
    motion.recount(0);
    let mut kept = small.keep(scene, motion.now());
    let mut iterations = 0;
    for _ in 0..parts {
        iterations += small.step(scene, &mut motion, &mut kept).ok()?.iterations;
    }
    Some((motion, iterations))
}

impl<S, R, Q> Instead<S> for Stepper<R, Q>
where
    S: Effect,
    R: Effect<Scalar = S::Scalar, Group = S::Group, Advected = S::Advected> + Clone,
    Q: Plan<R>,
{
    fn refolded(&self, h: Scalar<S>) -> Result<Self, SetupError> {
        Ok(Self { scene: self.scene.clone(), plan: self.plan.refolded(&self.scene, h)? })
    }

    #[cold]
    #[inline(never)]
    fn step<P: Plan<S>, M: Summation<Group<S>, S::Advected>>(
        &self,
        plan: &P,
        scene: &S,
        (motion, kept): (&mut M, &mut P::Kept),
        error: StepError,
    ) -> Result<StepReport, StepError> {
        let mut remembered = self.plan.keep(&self.scene, motion.now());
        let Ok(report) = self.plan.step(&self.scene, motion, &mut remembered) else { return Err(error) };
        // Its increments are those of another map.
        *kept = plan.keep(scene, motion.now());
        Ok(StepReport { remedy: Some(Remedy::Fallback), ..report })
    }

    fn describe(&self, visitor: &mut dyn SceneVisitor<Scalar<S>>) {
        visitor.term("or fallback");
        self.scene.describe(visitor);
        self.plan.describe(visitor);
    }
}
