//! What to do about a step that has no solution, for those who would rather go on than stop.
//!
//! A [`Stepper`] refuses such a step and leaves the state alone. A remedy makes another step in its place, and the report
//! says so. Both remedies here give up something; a motion that needs them often wants a smaller step.

use crate::error::{SetupError, StepError};
use crate::mechanics::{Effect, Group, Scalar, SceneVisitor, Vector};
use crate::motion::{Cost, Motion, Plan, Remedy, StepReport, Stepper, Summation};
use crate::numbers::real;

/// A plan that takes a step without a solution in equal parts, by [`Stepper::or_substeps`].
#[derive(Clone, Copy, Debug)]
pub struct OrSubsteps<P> {
    plan: P,
    at_most: u32,
}

/// A plan that leaves a step without a solution to another stepper, by [`Stepper::or_fallback`].
#[derive(Clone, Copy, Debug)]
pub struct OrFallback<P, F> {
    plan: P,
    other: F,
}

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
    pub fn or_substeps(self, at_most: u32) -> Stepper<S, OrSubsteps<P>> {
        Stepper { scene: self.scene, plan: OrSubsteps { plan: self.plan, at_most } }
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
    pub fn or_fallback<R, Q>(self, other: Stepper<R, Q>) -> Result<Stepper<S, OrFallback<P, Stepper<R, Q>>>, SetupError>
    where
        R: Effect<Scalar = S::Scalar, Group = S::Group, Advected = S::Advected>,
        Q: Plan<R>,
    {
        use nalgebra::{SimdBool as _, SimdPartialOrd as _};
        if !other.step_size().simd_eq(self.step_size()).all() {
            return Err(SetupError::InvalidStep { step: crate::numbers::reported(other.step_size()) });
        }
        Ok(Stepper { scene: self.scene, plan: OrFallback { plan: self.plan, other } })
    }
}

impl<S: Effect, P: Plan<S>> Plan<S> for OrSubsteps<P> {
    type Kept = P::Kept;

    const DISPATCHED: bool = P::DISPATCHED;
    const EXPLAINS: bool = P::EXPLAINS;

    fn step_size(&self) -> Scalar<S> {
        self.plan.step_size()
    }

    fn refolded(&self, scene: &S, h: Scalar<S>) -> Result<Self, SetupError> {
        Ok(Self { plan: self.plan.refolded(scene, h)?, at_most: self.at_most })
    }

    fn keep(&self, scene: &S, motion: &Motion<Group<S>, S::Advected>) -> Self::Kept {
        self.plan.keep(scene, motion)
    }

    #[inline(always)]
    fn step<M: Summation<Group<S>, S::Advected>>(
        &self,
        scene: &S,
        motion: &mut M,
        kept: &mut Self::Kept,
    ) -> Result<StepReport, StepError> {
        match self.plan.step(scene, motion, kept) {
            Ok(report) => Ok(report),
            Err(error) => self.in_parts(scene, motion, kept, error),
        }
    }

    fn push(&self, motion: &mut Motion<Group<S>, S::Advected>, kept: &mut Self::Kept, impulse: &Vector<S>) {
        self.plan.push(motion, kept, impulse);
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

    fn describe(&self, visitor: &mut dyn SceneVisitor<Scalar<S>>) {
        visitor.term("or substeps");
        visitor.parameter("at most", real(f64::from(self.at_most)));
        self.plan.describe(visitor);
    }

    fn cost(&self) -> Cost {
        self.plan.cost()
    }
}

impl<P> OrSubsteps<P> {
    #[cold]
    #[inline(never)]
    fn in_parts<S: Effect, M: Summation<Group<S>, S::Advected>>(
        &self,
        scene: &S,
        motion: &mut M,
        kept: &mut P::Kept,
        error: StepError,
    ) -> Result<StepReport, StepError>
    where
        P: Plan<S>,
    {
        if matches!(error, StepError::NonFinite { .. }) {
            return Err(error);
        }
        let steps = motion.now().steps;
        let mut parts = 2;
        while parts <= self.at_most {
            if let Some((mut moved, iterations)) = self.substepped(scene, *motion, parts) {
                let last = Motion { steps: steps + 1, ..*moved.now() };
                // What isn't a step of the whole tells nothing of the next one's increment.
                *kept = self.plan.keep(scene, &last);
                moved.recount(steps + 1);
                *motion = moved;
                return Ok(StepReport { iterations, remedy: Some(Remedy::Substeps(parts)) });
            }
            let Some(more) = parts.checked_mul(2) else { break };
            parts = more;
        }
        Err(error)
    }

    /// The motion after so many steps of an equal part of `h`, and all their iterations.
    fn substepped<S: Effect, M: Summation<Group<S>, S::Advected>>(
        &self,
        scene: &S,
        mut motion: M,
        parts: u32,
    ) -> Option<(M, u32)>
    where
        P: Plan<S>,
    {
        let small = self.plan.refolded(scene, self.plan.step_size() / real(f64::from(parts))).ok()?;
        motion.recount(0);
        let mut kept = small.keep(scene, motion.now());
        let mut iterations = 0;
        for _ in 0..parts {
            iterations += small.step(scene, &mut motion, &mut kept).ok()?.iterations;
        }
        Some((motion, iterations))
    }
}

impl<S, P, R, Q> Plan<S> for OrFallback<P, Stepper<R, Q>>
where
    S: Effect,
    P: Plan<S>,
    R: Effect<Scalar = S::Scalar, Group = S::Group, Advected = S::Advected> + Clone,
    Q: Plan<R>,
{
    type Kept = P::Kept;

    const DISPATCHED: bool = P::DISPATCHED;
    const EXPLAINS: bool = P::EXPLAINS;

    fn step_size(&self) -> Scalar<S> {
        self.plan.step_size()
    }

    fn refolded(&self, scene: &S, h: Scalar<S>) -> Result<Self, SetupError> {
        let plan = self.other.plan.refolded(&self.other.scene, h)?;
        let other = Stepper { scene: self.other.scene.clone(), plan };
        Ok(Self { plan: self.plan.refolded(scene, h)?, other })
    }

    fn keep(&self, scene: &S, motion: &Motion<Group<S>, S::Advected>) -> Self::Kept {
        self.plan.keep(scene, motion)
    }

    #[inline(always)]
    fn step<M: Summation<Group<S>, S::Advected>>(
        &self,
        scene: &S,
        motion: &mut M,
        kept: &mut Self::Kept,
    ) -> Result<StepReport, StepError> {
        match self.plan.step(scene, motion, kept) {
            Ok(report) => Ok(report),
            Err(error) => self.by_the_other(scene, motion, kept, error),
        }
    }

    fn push(&self, motion: &mut Motion<Group<S>, S::Advected>, kept: &mut Self::Kept, impulse: &Vector<S>) {
        self.plan.push(motion, kept, impulse);
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

    fn describe(&self, visitor: &mut dyn SceneVisitor<Scalar<S>>) {
        visitor.term("or fallback");
        self.other.scene.describe(visitor);
        self.other.plan.describe(visitor);
        self.plan.describe(visitor);
    }

    fn cost(&self) -> Cost {
        self.plan.cost()
    }
}

impl<P, R: Effect, Q: Plan<R>> OrFallback<P, Stepper<R, Q>> {
    #[cold]
    #[inline(never)]
    fn by_the_other<S, M>(
        &self,
        scene: &S,
        motion: &mut M,
        kept: &mut P::Kept,
        error: StepError,
    ) -> Result<StepReport, StepError>
    where
        S: Effect<Scalar = R::Scalar, Group = R::Group, Advected = R::Advected>,
        M: Summation<Group<S>, S::Advected>,
        P: Plan<S>,
    {
        let Stepper { scene: other, plan } = &self.other;
        let mut remembered = plan.keep(other, motion.now());
        let Ok(report) = plan.step(other, motion, &mut remembered) else { return Err(error) };
        // Its increments are those of another map.
        *kept = self.plan.keep(scene, motion.now());
        Ok(StepReport { remedy: Some(Remedy::Fallback), ..report })
    }
}
