//! A stepper with inputs and derivatives in flat coordinates, as optimal control and estimation read them.

use alloc::vec::Vec;
use core::iter;

use crate::error::{SetupError, StepError};
use crate::gradients::{Cotangent, Input, InputOf, Linearisable, Tape, Transition};
use crate::groups::{ExponentialRetraction, LieGroup, Retraction};
use crate::mechanics::{Group, SecondDerivatives, Vector};
use crate::motion::{Motion, StateOf, Stepper};
use crate::numbers::{Coordinates, Entries};

/// Two lists of numbers: the columns of `∂x⁺/∂x` and of `∂x⁺/∂u`, one after the other, each of `2n` numbers; or the gradients
/// by `x` and by `u`.
pub type Both = [Vec<f64>; 2];

/// A stepper with inputs, whose steps have derivatives in flat coordinates: the plant of a control problem.
///
/// A change `x` of a state has `2n` numbers on a group of `n` dimensions: a displacement `ζ`, by which the attitude `g` becomes
/// `g exp ζ̂`, on SO(3) in rad about the body's axes, and a change of the momentum in the body frame, on SO(3) in kg m²/s. Steps
/// are those of (2.7) and (2.9). A [`Stepper`] of a scene with derivatives is a plant, and so
/// is a declaration that is derived at run time.
pub trait Plant: Clone {
    /// The state of the stepper.
    type State: Clone;
    /// The part of a state that constraints and readings are functions of.
    type Motion: ?Sized;
    /// An element of the group.
    type Attitude: Clone;
    /// A vector of the algebra or of its dual.
    type Vector: Clone;
    /// The input of a step, by its kind.
    type Input: Clone;

    /// The dimension `n` of the group.
    fn dimension(&self) -> usize;

    /// The step `h`, s.
    fn step_size(&self) -> f64;

    /// The plant of this scene and method by the step `h`, s; none if it can't be used.
    fn of_length(&self, h: f64) -> Option<Self>;

    /// Checks that steps have derivatives.
    ///
    /// # Errors
    ///
    /// [`SetupError::NoSecondDerivatives`] if a term has none.
    fn check(&self) -> Result<(), SetupError>;

    /// No input.
    fn free(&self) -> Self::Input;

    /// A control force of zero, along all `n` components.
    fn force(&self) -> Self::Input;

    /// The motion of a state.
    fn motion(state: &Self::State) -> &Self::Motion;

    /// The components of a vector.
    fn components(vector: &Self::Vector) -> Vec<f64>;

    /// The numbers of an input.
    fn numbers(input: &Self::Input) -> Vec<f64>;

    /// An input of this kind with other numbers.
    fn with_numbers(input: &Self::Input, numbers: &[f64]) -> Self::Input;

    /// A state of this plant at the attitude and momentum of another, whose time begins here.
    fn adopt(&self, state: &Self::State) -> Self::State;

    /// Makes one step with this input. On an error the state is unchanged.
    ///
    /// # Errors
    ///
    /// The errors of [`Stepper::step_given`].
    fn step(&self, state: &mut Self::State, input: &Self::Input) -> Result<(), StepError>;

    /// Makes one step with this input, and returns the columns of its derivatives by the change of the state before it and by
    /// the numbers of the input.
    ///
    /// # Errors
    ///
    /// The errors of [`step`](Self::step), and [`StepError::NonFinite`] if a derivative overflows.
    fn transition(&self, state: &mut Self::State, input: &Self::Input) -> Result<Both, StepError>;

    /// Makes one step with this input, and returns the gradients `Aᵀλ` and `Bᵀλ` of a covector `λ` after it.
    ///
    /// # Errors
    ///
    /// The errors of [`transition`](Self::transition).
    fn gradient(&self, state: &mut Self::State, input: &Self::Input, covector: &[f64]) -> Result<Both, StepError> {
        let dot = |column: &[f64]| column.iter().zip(covector).map(|(a, b)| a * b).sum::<f64>();
        let both = self.transition(state, input)?;
        Ok(both.map(|columns| columns.chunks_exact(covector.len().max(1)).map(dot).collect()))
    }

    /// The state beside this one, by a change; none if no motion starts there.
    fn displaced(&self, state: &Self::State, change: &[f64]) -> Option<Self::State>;

    /// The coordinates `ξ` of the displacement `g_0⁻¹ g = exp ξ̂` to the attitude of a state; none out of their range.
    fn displacement(&self, from: &Self::Attitude, to: &Self::State) -> Option<Vec<f64>>;

    /// The columns of two matrices `T` and `A` with `T dξ = A ζ`, for the change of these coordinates by a displacement `ζ` of
    /// the state.
    fn displacement_slopes(&self, from: &Self::Attitude, to: &Self::State) -> Option<Both>;

    /// The attitude of a state.
    fn attitude(&self, state: &Self::State) -> Self::Attitude;

    /// The `n` components of the momentum of a state, in the body frame, on SO(3) in kg m²/s.
    fn momentum(&self, state: &Self::State) -> Vec<f64>;

    /// `ad*_ξ μ` by components, for which `⟨ad*_ξ μ, η⟩ = ⟨μ, [ξ, η]⟩`.
    fn bracket_transpose(&self, xi: &[f64], momentum: &[f64]) -> Vec<f64>;
}

/// The entries of values, one after another.
fn flat<'v, V: Entries<f64> + 'v>(values: impl IntoIterator<Item = &'v V>) -> Vec<f64> {
    let mut entries = Vec::new();
    values.into_iter().for_each(|value| value.each(&mut |entry| entries.push(entry)));
    entries
}

/// The value of the next entries.
fn read<V: Entries<f64>>(entries: &[f64]) -> V {
    let mut entries = entries.iter().copied().chain(iter::repeat(0.0));
    V::from_entries(&mut || entries.next().unwrap_or_default())
}

impl<S, P> Plant for Stepper<S, P>
where
    S: SecondDerivatives<Scalar = f64> + Clone,
    P: Linearisable<S> + Clone,
    ExponentialRetraction: Retraction<Group<S>>,
{
    type State = StateOf<S, P>;
    type Motion = Motion<Group<S>, S::Advected>;
    type Attitude = Group<S>;
    type Vector = Vector<S>;
    type Input = InputOf<S>;

    fn dimension(&self) -> usize {
        Group::<S>::DIMENSION
    }

    fn step_size(&self) -> f64 {
        Self::step_size(self)
    }

    fn of_length(&self, h: f64) -> Option<Self> {
        Self::with_plan(self.scene().clone(), self.plan().refolded(self.scene(), h).ok()?).ok()
    }

    fn check(&self) -> Result<(), SetupError> {
        self.linearised().map(|_| ())
    }

    fn free(&self) -> InputOf<S> {
        Input::Free
    }

    fn force(&self) -> InputOf<S> {
        Input::Force(Vector::<S>::zero())
    }

    fn motion(state: &Self::State) -> &Self::Motion {
        state
    }

    fn components(vector: &Vector<S>) -> Vec<f64> {
        flat([vector])
    }

    fn numbers(input: &InputOf<S>) -> Vec<f64> {
        input.scalars()
    }

    fn with_numbers(input: &InputOf<S>, numbers: &[f64]) -> InputOf<S> {
        let mut numbers = numbers.iter().copied();
        input.of_scalars(&mut || numbers.next().unwrap_or_default())
    }

    fn adopt(&self, state: &Self::State) -> Self::State {
        Self::adopt(self, state)
    }

    fn step(&self, state: &mut Self::State, input: &InputOf<S>) -> Result<(), StepError> {
        self.step_given(state, input).map(|_| ())
    }

    fn transition(&self, state: &mut Self::State, input: &InputOf<S>) -> Result<Both, StepError> {
        let unknown = |_| StepError::NonFinite { what: "derivative" };
        let Transition { by_state, by_input } = self.linearised().map_err(unknown)?.transition(state, input)?;
        Ok([by_state, by_input].map(|columns| columns.iter().flat_map(|(turn, change)| flat([turn, change])).collect()))
    }

    /// One pass of the adjoint in place of all columns.
    fn gradient(&self, state: &mut Self::State, input: &InputOf<S>, covector: &[f64]) -> Result<Both, StepError> {
        let unknown = |_| StepError::NonFinite { what: "derivative" };
        let (attitude, momentum) = covector.split_at(Group::<S>::DIMENSION.min(covector.len()));
        let end = Cotangent { attitude: read(attitude), momentum: read(momentum) };
        let cost = |n, _: &_| if n == 1 { end } else { Cotangent::zero() };
        let linear = self.linearised().map_err(unknown)?;
        let (gradient, by_inputs) = linear.adjoint_given(state, &[*input], Tape::All, cost)?;
        let by_input = by_inputs.first().map(Input::scalars).unwrap_or_default();
        Ok([flat([&gradient.start.attitude, &gradient.start.momentum]), by_input])
    }

    fn displaced(&self, state: &Self::State, change: &[f64]) -> Option<Self::State> {
        let (turn, change) = change.split_at(Group::<S>::DIMENSION.min(change.len()));
        let turned = state.attitude().compose(&ExponentialRetraction::retract(&read(turn)));
        self.start_with_momentum(turned, state.momentum() + read::<Vector<S>>(change)).ok()
    }

    fn displacement(&self, from: &Group<S>, to: &Self::State) -> Option<Vec<f64>> {
        ExponentialRetraction::local_coordinates(&from.inverse().compose(&to.attitude())).map(|xi| flat([&xi]))
    }

    /// The tangent of the exponential, and `Ad`.
    fn displacement_slopes(&self, from: &Group<S>, to: &Self::State) -> Option<Both> {
        let turn = from.inverse().compose(&to.attitude());
        let tangent = ExponentialRetraction::tangent(&ExponentialRetraction::local_coordinates(&turn)?);
        let columns = |matrix| {
            let column = |k| flat([&<Vector<S> as Coordinates<f64>>::column(matrix, k)]);
            (0..Group::<S>::DIMENSION).flat_map(column).collect()
        };
        Some([columns(&tangent), columns(&turn.adjoint_matrix())])
    }

    fn attitude(&self, state: &Self::State) -> Group<S> {
        state.motion.attitude()
    }

    fn momentum(&self, state: &Self::State) -> Vec<f64> {
        flat([&state.motion.momentum()])
    }

    fn bracket_transpose(&self, xi: &[f64], momentum: &[f64]) -> Vec<f64> {
        flat([&Group::<S>::lie_bracket_transpose(&read(xi), &read(momentum))])
    }
}
