//! Inputs of a step besides the state, and the derivatives of a step by them.

use alloc::vec::Vec;
use core::cell::RefCell;

use crate::error::StepError;
use crate::gradients::recording::ChangeOf;
use crate::gradients::tangent::{SquareOfVector, Tangent, TangentOf, blocks_of};
use crate::gradients::{Carry, Linearisable, Linearisation};
use crate::groups::{Advected as _, LieGroup as _};
use crate::mechanics::{Effect, Group, Scalar, SecondDerivatives, Term, Vector};
use crate::motion::{StateOf, Steerable, StepReport, Stepper};
use crate::numbers::{Coordinates, Entries, Real, dispatch, real};

/// An input of a step besides the state, or the derivative of a scalar by it: that has the kind of the input, and each
/// of its numbers is the derivative by the number in its place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Input<V, A> {
    /// No input: the step is [`Stepper::step`].
    Free,
    /// A control force, constant over the step: [`Stepper::step_forced`]. On SO(3) a torque in the body's axes, N m.
    Force(V),
    /// Advected parameters in space during the step: [`Stepper::step_with`].
    Values(A),
}

/// The type of a scene's inputs.
pub type InputOf<S> = Input<Vector<S>, <S as Term>::Advected>;

impl<V, A> Input<V, A> {
    /// The numbers of the input: the components of the force, or those of the values in the order of [`Entries`].
    #[must_use]
    pub fn scalars<T: Copy>(&self) -> Vec<T>
    where
        V: Entries<T>,
        A: Entries<T>,
    {
        let mut scalars = Vec::new();
        match self {
            Self::Free => {}
            Self::Force(force) => force.each(&mut |scalar| scalars.push(scalar)),
            Self::Values(values) => values.each(&mut |scalar| scalars.push(scalar)),
        }
        scalars
    }

    /// An input of the same kind, from the next numbers of a stream.
    #[must_use]
    pub fn of_scalars<T>(&self, next: &mut impl FnMut() -> T) -> Self
    where
        V: Entries<T>,
        A: Entries<T>,
    {
        match self {
            Self::Free => Self::Free,
            Self::Force(_) => Self::Force(V::from_entries(next)),
            Self::Values(_) => Self::Values(A::from_entries(next)),
        }
    }
}

/// The derivatives of the state after a step, `(ζ⁺, δμ⁺)`, by the state before it and by the input.
///
/// ```text
/// (ζ⁺, δμ⁺) = A (ζ, δμ) + B δu
/// ```
///
/// The coordinates on the group are those of `g exp ζ̂`: on SO(3) radians about the body's axes at either end of the
/// step.
#[derive(Clone, Debug, PartialEq)]
pub struct Transition<V> {
    /// The columns of `A`: first along displacements `ζ`, then by the components of the momentum.
    pub by_state: Vec<(V, V)>,
    /// The columns of `B`, one for each of the [scalars](Input::scalars) of the input.
    pub by_input: Vec<(V, V)>,
}

impl<V> Transition<V> {
    /// The four blocks of `A`: `[[∂ζ⁺/∂ζ, ∂ζ⁺/∂μ], [∂μ⁺/∂ζ, ∂μ⁺/∂μ]]`.
    #[must_use]
    pub fn blocks<T: Real>(&self) -> [[SquareOfVector<V, T>; 2]; 2]
    where
        V: Coordinates<T>,
    {
        blocks_of(&self.by_state)
    }
}

/// # Step: of any kind
impl<S: Effect, P: Steerable<S>> Stepper<S, P> {
    /// One step with this input: [`step`](Self::step), [`step_forced`](Self::step_forced) or
    /// [`step_with`](Self::step_with), according to its kind. On an error the state is unchanged.
    ///
    /// # Errors
    ///
    /// The errors of these functions.
    pub fn step_given(&self, state: &mut StateOf<S, P>, input: &InputOf<S>) -> Result<StepReport, StepError> {
        match input {
            Input::Free => self.step(state),
            Input::Force(force) => self.step_forced(state, force),
            Input::Values(values) => self.step_with(state, values),
        }
    }
}

impl<S: SecondDerivatives, P: Linearisable<S>> Linearisation<'_, S, P> {
    /// One step with this input, and its tangent map applied to the derivatives by start and parameters. On an error
    /// both are unchanged.
    ///
    /// # Errors
    ///
    /// The errors of [`Stepper::step_given`], and [`StepError::NonFinite`] if a derivative overflows.
    ///
    /// # Panics
    ///
    /// The panics of [`step`](Self::step).
    pub fn step_given(
        &self,
        state: &mut StateOf<S, P>,
        input: &InputOf<S>,
        tangent: &mut TangentOf<S>,
    ) -> Result<StepReport, StepError> {
        if let Some(count) = tangent.parameters() {
            let own = self.stepper.plan.parameters();
            assert_eq!(count, own, "the tangent is that of a plan with {count} parameters, and this one has {own}");
        }
        let before = *state;
        tangent.events.get_mut().clear();
        let made = self.recorded_given(state, input, &tangent.events, [true; 2]);
        let report = made.inspect_err(|_| *state = before)?;
        tangent.is_given_values = matches!(input, Input::Values(_));
        tangent.keep();
        dispatch(Carry { linearised: self, tangent });
        if tangent.is_finite() {
            return Ok(report);
        }
        tangent.go_back();
        *state = before;
        Err(StepError::NonFinite { what: "derivative after the step" })
    }

    /// One step with this input, and its blocks `A = ∂x⁺/∂x` and `B = ∂x⁺/∂u`. On an error the state is unchanged.
    ///
    /// A control force `f` acts by half of its impulse `h f` before the step and by half of it after the step, so that
    /// with the columns `A_μ` by the momentum
    ///
    /// ```text
    /// B = h/2 (A_μ + (0, I))
    /// ```
    ///
    /// Values act in each stage as advected parameters do; in the body frame a value changes by `δw = g⁻¹·δa`.
    ///
    /// # Errors
    ///
    /// The errors of [`step_given`](Self::step_given).
    ///
    /// # Examples
    ///
    /// A torque on a body at rest turns it in one step by `h²/2 J⁻¹ f`:
    ///
    /// ```
    /// use liestep::effects::RigidBody;
    /// use liestep::gradients::Input;
    /// use liestep::groups::LieGroup as _;
    /// use liestep::{NonstandardInertia, SO3, Stepper};
    /// use nalgebra::Vector3;
    ///
    /// let J_d = NonstandardInertia::from_principal_moments(Vector3::new(2.0, 3.0, 4.0))?;
    /// let stepper = Stepper::new(RigidBody { J_d }, 0.1)?;
    /// let mut state = stepper.start(SO3::identity(), Vector3::zeros())?;
    /// let transition = stepper.linearised()?.transition(&mut state, &Input::Force(Vector3::zeros()))?;
    /// let (turn, momentum) = transition.by_input[0];
    /// assert!((turn - Vector3::x() * 0.0025).norm() < 1e-15);
    /// assert!((momentum - Vector3::x() * 0.1).norm() < 1e-15);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn transition(
        &self,
        state: &mut StateOf<S, P>,
        input: &InputOf<S>,
    ) -> Result<Transition<Vector<S>>, StepError> {
        let parameters = self.stepper.plan.parameters();
        let mut values = 0;
        if let Input::Values(given) = input {
            given.each(&mut |_| values += 1);
        }
        let numbers: Vec<usize> = (parameters..parameters + values).collect();
        let mut tangent = Tangent::new([parameters, values], &numbers);
        self.step_given(state, input, &mut tangent)?;
        let by_state: Vec<_> = tangent.columns().take(2 * Group::<S>::DIMENSION).collect();
        let mut by_input: Vec<_> = tangent.by_parameters().collect();
        if let Input::Force(_) = input {
            let half = self.half_step();
            by_input.extend(
                by_state[Group::<S>::DIMENSION..]
                    .iter()
                    .enumerate()
                    .map(|(k, (attitude, momentum))| (*attitude * half, (*momentum + Vector::<S>::axis(k)) * half)),
            );
        }
        Ok(Transition { by_state, by_input })
    }

    /// Half of the step, which multiplies a force in each half impulse.
    pub(super) fn half_step(&self) -> Scalar<S> {
        self.stepper.step_size() * real(0.5)
    }

    /// One step with this input, whose stages are recorded; after an error the state is undefined. The bits are those
    /// of [`Stepper::step_given`].
    pub(super) fn recorded_given(
        &self,
        state: &mut StateOf<S, P>,
        input: &InputOf<S>,
        events: &RefCell<Vec<ChangeOf<S>>>,
        ends: [bool; 2],
    ) -> Result<StepReport, StepError> {
        let Stepper { scene, plan } = self.stepper;
        let half = if let Input::Force(force) = input { Some(*force * self.half_step()) } else { None };
        match input {
            Input::Force(force) if !force.is_finite() => return Err(StepError::NonFinite { what: "control force" }),
            Input::Values(values) if !values.is_finite() => {
                return Err(StepError::NonFinite { what: "value given to the step" });
            }
            Input::Values(values) => {
                let seen = values.seen_from(&state.motion.attitude);
                plan.see(&mut state.motion, &mut state.kept, seen);
            }
            Input::Free | Input::Force(_) => {}
        }
        if let Some(half) = &half {
            plan.push(scene, &mut state.motion, &mut state.kept, half);
        }
        let report = self.stepper.recorded(state, events, ends)?;
        if let Some(half) = &half {
            plan.push(scene, &mut state.motion, &mut state.kept, half);
            if !state.motion.momentum.is_finite() {
                return Err(StepError::NonFinite { what: "momentum after the step" });
            }
        }
        if let Input::Values(_) = input {
            let own = scene.advected().seen_from(&state.motion.attitude);
            plan.see(&mut state.motion, &mut state.kept, own);
        }
        Ok(report)
    }
}
