//! What to do about a step that has no solution, for those who would rather go on than stop.
//!
//! A [`Stepper`] refuses such a step and leaves the state alone. A policy makes another step in its place, and the
//! report says so. Both policies here give up something; a motion that needs them often wants a smaller step.

use crate::error::{SetupError, StepError};
use crate::mechanics::{Effect, Group, Regular, Scalar};
use crate::motion::{State, StepReport, Stepper};
use crate::numbers::real;
use crate::solving::History;

/// What was done in the place of a step that has no solution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Remedy {
    /// So many steps of an equal part of `h`.
    Substeps(u32),
    /// A step of another Lagrangian.
    Fallback,
}

/// A policy for steps that have no solution.
pub trait OnFailure<L: Effect> {
    /// Moves the state by the stepper's `h` in another way, or leaves it as it was and returns an error.
    ///
    /// # Errors
    ///
    /// The error that the step was refused with, where there is no other way either.
    fn remedy(
        &self,
        stepper: &Stepper<L>,
        state: &mut State<Group<L>, L::Advected>,
        error: StepError,
    ) -> Result<StepReport, StepError>;
}

/// A [`Stepper`] with a policy, by [`Stepper::on_failure`].
#[derive(Clone, Debug)]
pub struct RemediedStepper<L: Effect, P> {
    stepper: Stepper<L>,
    policy: P,
}

impl<L: Effect> Stepper<L> {
    /// The same steps, and those of the policy where there is none.
    ///
    /// # Examples
    ///
    /// ```
    /// use liestep::{DiagonalNonstandardInertia, LieGroup, Remedy, SO3, Stepper, Substeps, lagrangian};
    /// use nalgebra::Vector3;
    ///
    /// /// A free rigid body.
    /// #[lagrangian(group = SO3, l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
    /// #[derive(Clone)]
    /// struct Body {
    ///     J_d: DiagonalNonstandardInertia,
    /// }
    ///
    /// let J_d = DiagonalNonstandardInertia::from_principal_moments(Vector3::new(1.0, 2.0, 2.5))?;
    /// let stepper = Stepper::new(Body { J_d }, 0.1)?.on_failure(Substeps { at_most: 8 });
    /// let mut state = stepper.stepper().start(SO3::identity(), Vector3::new(0.0, 25.0, 0.0))?;
    /// let report = stepper.step(&mut state)?;
    /// assert_eq!(report.remedy, Some(Remedy::Substeps(4)));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn on_failure<P: OnFailure<L>>(self, policy: P) -> RemediedStepper<L, P> {
        RemediedStepper { stepper: self, policy }
    }
}

impl<L: Effect, P: OnFailure<L>> RemediedStepper<L, P> {
    /// The stepper without the policy.
    #[must_use]
    pub fn stepper(&self) -> &Stepper<L> {
        &self.stepper
    }

    /// One step, or what the policy does in its place; [`StepReport::remedy`] tells. On an error the state is
    /// unchanged.
    ///
    /// # Errors
    ///
    /// As [`Stepper::step`], where the policy has no remedy either.
    #[inline]
    pub fn step(&self, state: &mut State<Group<L>, L::Advected>) -> Result<StepReport, StepError> {
        self.stepper.step(state).or_else(|error| self.policy.remedy(&self.stepper, state, error))
    }
}

/// Takes the step in equal parts, as few as will do.
///
/// The motion through such a step is as good as any other, but the step isn't constant then: the energy keeps to its
/// bound between two such steps and may change by the order of `h²` at each, so that over many it can drift. What a
/// step conserves whatever its size is kept: the group, the momentum maps, the Casimirs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Substeps {
    /// No more parts than these.
    pub at_most: u32,
}

impl<L: Regular + Clone> OnFailure<L> for Substeps {
    #[cold]
    fn remedy(
        &self,
        stepper: &Stepper<L>,
        state: &mut State<Group<L>, L::Advected>,
        error: StepError,
    ) -> Result<StepReport, StepError> {
        if matches!(error, StepError::NonFinite { .. }) {
            return Err(error);
        }
        let mut parts = 2;
        while parts <= self.at_most {
            if let Some(Moved { state: moved, iterations }) = substepped(stepper, state, parts) {
                *state = moved;
                return Ok(StepReport { iterations, remedy: Some(Remedy::Substeps(parts)) });
            }
            let Some(more) = parts.checked_mul(2) else { break };
            parts = more;
        }
        Err(error)
    }
}

/// Where substeps have led.
struct Moved<L: Effect> {
    state: State<Group<L>, L::Advected>,
    iterations: u32,
}

/// The state after `parts` steps of `h/parts`, counted as one, and all Newton iterations.
fn substepped<L: Regular + Clone>(
    stepper: &Stepper<L>,
    state: &State<Group<L>, L::Advected>,
    parts: u32,
) -> Option<Moved<L>> {
    let (whole, part) = (real::<Scalar<L>>(f64::from(parts)), real::<Scalar<L>>(1.0 / f64::from(parts)));
    let small = Stepper::new(stepper.lagrangian().clone(), stepper.step_size() / whole).ok()?;
    // The history is that of the whole step, so these begin as a motion of their own.
    let (half_guess, half, history) = (state.half_guess * part, state.half * part, History::new());
    let mut moved = State { half_guess, half, history, steps: 0, ..*state };
    let mut iterations = 0;
    for _ in 0..parts {
        iterations += small.step(&mut moved).ok()?.iterations;
    }
    let half = moved.half * whole;
    let state = State { half_guess: half, half, history, steps: state.steps + 1, ..moved };
    Some(Moved { state, iterations })
}

/// Takes the step of another Lagrangian with the same group and advected parameters.
///
/// The one that is meant is the same system with a kinetic term that has a solution at every `h`, like that in Cayley
/// coordinates, `(2/h) x·Jx` with `x = tan(θ/2) n` (for bodies that aren't needles). It is variational too, of the same
/// order, with an error about twice as large; but another map, so that changing over has the effect on the energy that
/// [`Substeps`] have.
#[derive(Clone, Debug)]
pub struct Fallback<M: Effect> {
    stepper: Stepper<M>,
}

impl<M: Effect> Fallback<M> {
    /// With the step of the stepper that it is for.
    ///
    /// # Errors
    ///
    /// As [`Stepper::new`].
    pub fn new<L>(lagrangian: M, stepper: &Stepper<L>) -> Result<Self, SetupError>
    where
        M: Regular,
        L: Effect<Scalar = M::Scalar, Group = M::Group, Advected = M::Advected>,
    {
        Stepper::new(lagrangian, stepper.step_size()).map(|stepper| Self { stepper })
    }
}

impl<L, M> OnFailure<L> for Fallback<M>
where
    M: Effect,
    L: Effect<Scalar = M::Scalar, Group = M::Group, Advected = M::Advected>,
{
    #[cold]
    fn remedy(
        &self,
        _: &Stepper<L>,
        state: &mut State<Group<L>, L::Advected>,
        error: StepError,
    ) -> Result<StepReport, StepError> {
        match self.stepper.step(state) {
            Ok(report) => {
                // Its increments are those of another map.
                state.history = History::new();
                Ok(StepReport { remedy: Some(Remedy::Fallback), ..report })
            }
            Err(_) => Err(error),
        }
    }
}
