//! Steps that are given values which are known beforehand: a field that turns, a direction along an orbit.

use crate::error::{SetupError, StepError};
use crate::groups::Advected as _;
use crate::mechanics::{Effect, Group, Scalar, SceneVisitor, Vector};
use crate::motion::{Plan, Steerable, StepReport, Stepper, Summation};
use crate::numbers::{Real, real};

/// A plan whose steps are given the values of their middles, by [`Stepper::driven`].
#[derive(Clone, Copy, Debug)]
#[doc(hidden)]
pub struct Driven<P, V, T> {
    plan: P,
    values: V,
    /// The step that time is counted by, s; that of the plan is a part of it where a motion is read between two steps.
    whole: T,
}

/// # Wrap: given values
impl<S: Effect, P: Plan<S> + Steerable> Stepper<S, P> {
    /// A stepper each of whose steps is the one [with](Self::step_with) the values in its middle: `values` is a function of
    /// the time since the start, s, and returns what is advected as it is in space, as `scene.advected()` does.
    ///
    /// It is recorded, watched for events and read between its steps as any other. A part of a step is made with the values
    /// of the whole step, so that its parts join it to the next. A state sees the values of its own time, and so do its
    /// energy and velocity. The scheme is of second order in values that change smoothly, whatever the order of the method.
    ///
    /// Substeps are to be asked for before, and sums compensated: `stepper.or_substeps(8).driven(…)`. Two steppers with
    /// different functions aren't told apart by a checkpoint.
    ///
    /// # Examples
    ///
    /// A magnet follows a field that turns.
    ///
    /// ```
    /// use liestep::effects::{Dipole, RigidBody};
    /// use liestep::groups::LieGroup as _;
    /// use liestep::motion::Integrator as _;
    /// use liestep::{NonstandardInertia, SO3, Stepper};
    /// use nalgebra::Vector3;
    ///
    /// let field = |t: f64| Vector3::new((0.1 * t).cos(), (0.1 * t).sin(), 0.0) * 2.0;
    /// let J_d = NonstandardInertia::from_principal_moments(Vector3::new(1.0, 2.0, 2.5))?;
    /// let magnet = RigidBody { J_d } + Dipole { moment: Vector3::x(), field: field(0.0) };
    /// let driven = Stepper::new(magnet, 0.05)?.driven(move |t| ((), field(t)));
    /// let mut state = driven.start(SO3::identity(), Vector3::new(0.0, 0.0, 0.1))?;
    /// driven.run(&mut state, 2000)?;
    /// assert!((state.attitude().as_matrix().column(0).dot(&field(100.0)) - 2.0).abs() < 1e-2);
    ///
    /// // The end of a step is the part of length one.
    /// let part = driven.part(&state, 1.0)?;
    /// driven.step(&mut state)?;
    /// assert!((part.momentum() - state.momentum()).norm() < 1e-14);
    /// assert!((part.advected().1 - state.advected().1).norm() < 1e-14);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn driven<V>(self, values: V) -> Stepper<S, Driven<P, V, Scalar<S>>>
    where
        V: Fn(Scalar<S>) -> S::Advected + Clone,
    {
        let whole = self.step_size();
        Stepper { scene: self.scene, plan: Driven { plan: self.plan, values, whole } }
    }
}

impl<S: Effect, P: Plan<S>, V> Plan<S> for Driven<P, V, Scalar<S>>
where
    V: Fn(Scalar<S>) -> S::Advected + Clone,
{
    type Kept = P::Kept;

    delegate_plan!(plan, |kept| kept; constants step_size keep admits momentum velocity is_in_step cost);

    const RUNS_BY_STEPS: bool = true;
    const COUNTS_TIME: bool = true;

    fn refolded(&self, scene: &S, h: Scalar<S>) -> Result<Self, SetupError> {
        let (plan, values) = (self.plan.refolded(scene, h)?, self.values.clone());
        Ok(Self { plan, values, whole: self.whole })
    }

    fn advected(&self, _: &S, steps: u64) -> S::Advected {
        (self.values)(self.whole * counted(steps))
    }

    fn step<M: Summation<Group<S>, S::Advected>>(
        &self,
        scene: &S,
        motion: &mut M,
        kept: &mut Self::Kept,
    ) -> Result<StepReport, StepError> {
        let (mut now, mut next) = (*motion.now(), *kept);
        let start = self.whole * counted(now.steps);
        let [middle, end] = [self.whole * real(0.5), self.plan.step_size()].map(|part| (self.values)(start + part));
        if !(middle.is_finite() && end.is_finite()) {
            return Err(StepError::NonFinite { what: "value given to the step" });
        }
        let seen = middle.seen_from(&now.attitude);
        self.plan.see(&mut now, &mut next, seen);
        let made = self.plan.step(scene, &mut now, &mut next);
        let report = made.map_err(|error| self.plan.explained(error, scene, &now, &next))?;
        let seen = end.seen_from(&now.attitude);
        self.plan.see(&mut now, &mut next, seen);
        motion.replace(now);
        *kept = next;
        Ok(report)
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

    fn describe(&self, visitor: &mut dyn SceneVisitor<Scalar<S>>) {
        visitor.term("driven");
        self.plan.describe(visitor);
    }
}

/// A number of steps.
#[allow(clippy::cast_precision_loss)] // as `Stepper::time`
fn counted<T: Real>(steps: u64) -> T {
    real(steps as f64)
}
