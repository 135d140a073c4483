//! Steps with prescribed values: a field that turns, a direction along an orbit.

use crate::error::{SetupError, StepError};
use crate::groups::Advected as _;
use crate::mechanics::{Effect, Group, Scalar, SceneVisitor, Vector};
use crate::motion::{MotionOf, Plan, PlanFacts, Runs, Steerable, StepReport, Stepper, Summation, explained};
use crate::numbers::real;
use nalgebra::{SimdPartialOrd as _, SimdValue as _};

/// A plan whose steps have prescribed values in their middles, or in those of their stages, by [`Stepper::driven`].
#[derive(Clone, Copy, Debug)]
#[doc(hidden)]
pub struct Driven<P, V> {
    plan: P,
    values: V,
}

/// # Wrap: prescribed values
impl<S: Effect, P: Steerable<S>> Stepper<S, P> {
    /// A stepper whose steps have prescribed parameters, each [with](Self::step_with) those in its middle. The function
    /// `values` of the time since the start, s, returns the advected parameters in space, as `scene.advected()` does.
    ///
    /// It is recorded, watched for events and evaluated between its steps as any other. A part of a step takes the
    /// values of the whole step, so that its parts join it to the next. A state has the values of its own time, and so
    /// do its energy and velocity. The scheme is of second order in values that change smoothly, and a
    /// [composition](Self::composed) of its own order: each of its stages, in a part of a step too, takes the values in its middle.
    ///
    /// Substeps and compensated sums have to be added before: `stepper.or_substeps(8).driven(…)`. A checkpoint doesn't
    /// distinguish two functions.
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
    pub fn driven<V>(self, values: V) -> Stepper<S, Driven<P, V>>
    where
        V: Fn(Scalar<S>) -> S::Advected + Clone,
    {
        Stepper { scene: self.scene, plan: Driven { plan: self.plan, values } }
    }
}

impl<S: Effect, P: Steerable<S>, V> Plan<S> for Driven<P, V>
where
    V: Fn(Scalar<S>) -> S::Advected + Clone,
{
    type Kept = P::Kept;

    delegate_plan!(plan, |kept| *kept; step_size keep momentum velocity cost push);

    const FACTS: PlanFacts = PlanFacts { runs: Runs::BySteps, counts_time: true, explains: false, ..P::FACTS };

    fn refolded(&self, scene: &S, h: Scalar<S>) -> Result<Self, SetupError> {
        Ok(Self { plan: self.plan.refolded(scene, h)?, values: self.values.clone() })
    }

    fn begun(&self, _: &S, attitude: &Group<S>, _: &Vector<S>) -> S::Advected {
        (self.values)(real(0.0)).seen_from(attitude)
    }

    fn time(&self, motion: &MotionOf<S>, kept: &P::Kept) -> Scalar<S> {
        self.plan.time(motion, kept)
    }

    fn length(&self, scene: &S, motion: &MotionOf<S>, kept: &P::Kept, is_ahead: bool) -> Scalar<S> {
        self.plan.length(scene, motion, kept, is_ahead)
    }

    fn step<M: Summation<Group<S>, S::Advected>>(
        &self,
        scene: &S,
        motion: &mut M,
        kept: &mut Self::Kept,
    ) -> Result<StepReport, StepError> {
        let (mut now, mut next) = (*motion.now(), *kept);
        let (start, length) = (self.plan.time(&now, &next), self.plan.length(scene, &now, &next, true));
        let end = self.value::<S>(start + length)?;
        let made = self.plan.step_seeing(scene, &mut now, &mut next, &mut self.middles::<S>(start, length));
        let report = made.map_err(|error| explained(&self.plan, error, (scene, &now, &next)))?;
        let seen = end.seen_from(&now.attitude);
        self.plan.see(&mut now, &mut next, seen);
        motion.replace(now);
        *kept = next;
        Ok(report)
    }

    fn part(
        &self,
        scene: &S,
        motion: &MotionOf<S>,
        kept: &P::Kept,
        fraction: Scalar<S>,
    ) -> Result<MotionOf<S>, StepError> {
        let [ahead, back] = [true, false].map(|is_ahead| self.plan.length(scene, motion, kept, is_ahead));
        let is_ahead = fraction.simd_ge(real(0.0));
        let (start, length) = (self.plan.time(motion, kept), ahead.select(is_ahead, -back));
        let end = self.value::<S>(start + ahead.select(is_ahead, back) * fraction)?;
        let values = &mut self.middles::<S>(start, length);
        let mut part = self.plan.part_seeing(scene, motion, kept, fraction, values)?;
        part.advected = end.seen_from(&part.attitude);
        Ok(part)
    }

    fn describe(&self, visitor: &mut dyn SceneVisitor<Scalar<S>>) {
        visitor.term("driven");
        self.plan.describe(visitor);
    }
}

impl<P, V> Driven<P, V> {
    /// The values at a time, if they are finite.
    fn value<S: Effect>(&self, time: Scalar<S>) -> Result<S::Advected, StepError>
    where
        V: Fn(Scalar<S>) -> S::Advected,
    {
        let values = (self.values)(time);
        if values.is_finite() { Ok(values) } else { Err(StepError::NonFinite { what: "value given to the step" }) }
    }

    /// The values in the middles of parts of a step of this start and length, s.
    fn middles<S: Effect>(
        &self,
        start: Scalar<S>,
        length: Scalar<S>,
    ) -> impl FnMut([Scalar<S>; 2]) -> Result<S::Advected, StepError> + use<'_, P, V, S>
    where
        V: Fn(Scalar<S>) -> S::Advected,
    {
        move |[begin, share]| self.value::<S>(start + length * begin + length * share * real(0.5))
    }
}
