//! The steps of a plan, and their first and second derivatives in flat coordinates: a displacement `ζ`, the momentum, and
//! behind them the duration where that is free.

use liestep::StepError;
use liestep::gradients::{Cotangent, Input, InputOf, Linearisable, Tape};
use liestep::groups::{ExponentialRetraction, LieGroup, Retraction};
use liestep::mechanics::{Group, SecondDerivatives, Vector};
use liestep::motion::{Plan, StateOf, Stepper};
use liestep::numbers::Entries;
use nalgebra::{DMatrix, DVector};

use crate::control::Control;
use crate::riccati::Stage;

/// Of differences by the duration, and of those of derivatives: about a third of the digits, and a quarter.
const SMALL: f64 = 1e-5;
const COARSE: f64 = 1e-4;

/// The step of a duration, and those of a longer and a shorter one, for the derivatives by it.
pub(crate) struct Model<S: SecondDerivatives<Scalar = f64>, P> {
    pub(crate) duration: f64,
    pub(crate) stepper: Stepper<S, P>,
    beside: Vec<Stepper<S, P>>,
    like: InputOf<S>,
    places: Vec<usize>,
}

/// The components of vectors, one after another.
pub(crate) fn flat<'v, V: Entries<f64> + 'v>(vectors: impl IntoIterator<Item = &'v V>) -> DVector<f64> {
    let mut entries = Vec::new();
    for vector in vectors {
        vector.each(&mut |entry| entries.push(entry));
    }
    DVector::from_vec(entries)
}

fn vector<V: Entries<f64>>(entries: &[f64]) -> V {
    let mut entries = entries.iter().copied();
    V::from_entries(&mut || entries.next().unwrap_or(0.0))
}

impl<S, P> Model<S, P>
where
    S: SecondDerivatives<Scalar = f64> + Clone,
    P: Linearisable<S> + Clone,
    ExponentialRetraction: Retraction<Group<S>>,
{
    /// `None` where the scene can't be stepped in this time.
    pub(crate) fn new(control: &Control<'_, S, P>, duration: f64) -> Option<Self>
    where
        P: Plan<S>,
    {
        let (stepper, is_free) = (control.stepper, control.cost.time > 0.0);
        #[allow(clippy::cast_precision_loss)] // exact up to 2⁵³
        let of = |share: f64| {
            let (scene, h) = (stepper.scene(), duration * share / control.steps as f64);
            Stepper::with_plan(scene.clone(), stepper.plan().refolded(scene, h).ok()?).ok()
        };
        let beside = if is_free { vec![of(1.0 + SMALL)?, of(1.0 - SMALL)?] } else { Vec::new() };
        let stepper = if is_free { of(1.0)? } else { stepper.clone() };
        Some(Self { duration, stepper, beside, like: control.like, places: control.places.clone() })
    }

    /// The components of a state, with the duration where that is free.
    pub(crate) fn states(&self) -> usize {
        2 * Group::<S>::DIMENSION + self.beside.len() / 2
    }

    /// What a step is given.
    pub(crate) fn input(&self, chosen: &[f64]) -> InputOf<S> {
        let mut scalars: Vec<f64> = self.like.scalars();
        for (place, scalar) in self.places.iter().zip(chosen) {
            scalars[*place] = *scalar;
        }
        let mut scalars = scalars.into_iter();
        self.like.of_scalars(&mut || scalars.next().unwrap_or(0.0))
    }

    /// The states of these inputs; of a step that can't be made its number and error.
    pub(crate) fn run(
        &self,
        start: &StateOf<S, P>,
        inputs: &[DVector<f64>],
    ) -> Result<Vec<StateOf<S, P>>, (usize, StepError)> {
        let mut states = vec![self.stepper.adopt(start)];
        for (k, input) in inputs.iter().enumerate() {
            let mut state = states[k];
            self.stepper.step_given(&mut state, &self.input(input.as_slice())).map_err(|error| (k, error))?;
            states.push(state);
        }
        Ok(states)
    }

    /// The derivatives of the step from this state, without any of a cost.
    pub(crate) fn blocks(&self, state: &StateOf<S, P>, chosen: &DVector<f64>) -> Result<Stage, StepError> {
        let unknown = || StepError::NonFinite { what: "derivative" };
        let (input, states, count) = (self.input(chosen.as_slice()), self.states(), chosen.len());
        let (mut end, whole) = (*state, 2 * Group::<S>::DIMENSION);
        let transition = self.stepper.linearised().map_err(|_| unknown())?.transition(&mut end, &input)?;
        let mut by_state = DMatrix::identity(states, states);
        let mut by_input = DMatrix::zeros(states, count);
        for (k, (attitude, momentum)) in transition.by_state.iter().enumerate() {
            by_state.view_mut((0, k), (whole, 1)).copy_from(&flat([attitude, momentum]));
        }
        for (k, place) in self.places.iter().enumerate() {
            let (attitude, momentum) = &transition.by_input[*place];
            by_input.view_mut((0, k), (whole, 1)).copy_from(&flat([attitude, momentum]));
        }
        let mut changes = Vec::with_capacity(2);
        for stepper in &self.beside {
            let mut other = stepper.adopt(state);
            stepper.step_given(&mut other, &input)?;
            let turn = end.attitude().inverse().compose(&other.attitude());
            let turn = ExponentialRetraction::local_coordinates(&turn).ok_or_else(unknown)?;
            changes.push(flat([&turn, &(other.momentum() - end.momentum())]));
        }
        let mut bent = DVector::zeros(states);
        if let [longer, shorter] = &changes[..] {
            let small = SMALL * self.duration;
            by_state.view_mut((0, whole), (whole, 1)).copy_from(&((longer - shorter) / (2.0 * small)));
            bent.rows_mut(0, whole).copy_from(&((longer + shorter) / (small * small)));
        }
        let (state_gradient, input_gradient) = (DVector::zeros(states), DVector::zeros(count));
        let hessian = DMatrix::zeros(states + count, states + count);
        Ok(Stage { by_state, by_input, state_gradient, input_gradient, hessian, fixed: Vec::new(), bent })
    }

    /// The second derivatives of `λ·x⁺` by state and input, in the coordinates of the exponential, by differences of the
    /// adjoint. `None` where a step beside this one can't be made.
    ///
    /// At the end of a step beside this one the covector is `λ + ½ ad*_y λ`, where `y` is how far that is; at its beginning
    /// the same makes the differences of derivatives asymmetric, so their symmetric part is taken.
    pub(crate) fn bending(
        &self,
        state: &StateOf<S, P>,
        chosen: &DVector<f64>,
        stage: &Stage,
        multipliers: &DVector<f64>,
    ) -> Option<DMatrix<f64>> {
        let (dimension, states, inputs) = (Group::<S>::DIMENSION, self.states(), chosen.len());
        let part = |x: &DVector<f64>, first: usize| -> Vector<S> { vector(&x.as_slice()[first..first + dimension]) };
        let place = part(multipliers, 0);
        let pull = |stepper: &Stepper<S, P>, x: &DVector<f64>| -> Option<DVector<f64>> {
            let turned = state.attitude().compose(&ExponentialRetraction::retract(&part(x, 0)));
            let mut state = stepper.start_with_momentum(turned, state.momentum() + part(x, dimension)).ok()?;
            let beyond = &stage.by_state * x.rows(0, states) + &stage.by_input * x.rows(states, inputs);
            let attitude = place + Group::<S>::lie_bracket_transpose(&part(&beyond, 0), &place) * 0.5;
            let end = Cotangent { attitude, momentum: part(multipliers, dimension) };
            let cost = |n, _: &_| if n == 1 { end } else { Cotangent::zero() };
            let input = self.input((chosen + x.rows(states, inputs)).as_slice());
            let linear = stepper.linearised().ok()?;
            let (gradient, by_inputs) = linear.adjoint_given(&mut state, &[input], Tape::All, cost).ok()?;
            let mut found = DVector::zeros(states + inputs);
            let start = flat([&gradient.start.attitude, &gradient.start.momentum]);
            found.rows_mut(0, 2 * dimension).copy_from(&start);
            let by_scalars: Vec<f64> = by_inputs.first().map(Input::scalars)?;
            for (k, place) in self.places.iter().enumerate() {
                found[states + k] = by_scalars[*place];
            }
            Some(found)
        };
        // The momentum that turns the body by a radian on the whole way, and what makes it in one step.
        let turn = stage.by_state.view((0, dimension), (dimension, dimension)).amax();
        let momentum = COARSE * self.stepper.step_size() / (self.duration * turn);
        let force = momentum / stage.by_input.rows(dimension, dimension).amax();
        let mut hessian = DMatrix::zeros(states + inputs, states + inputs);
        for k in (0..2 * dimension).chain(states..states + inputs) {
            let mut x = DVector::zeros(states + inputs);
            x[k] = if k < dimension {
                COARSE
            } else if k < states {
                momentum
            } else {
                force
            };
            let column = (pull(&self.stepper, &x)? - pull(&self.stepper, &-&x)?) / (2.0 * x[k]);
            hessian.set_column(k, &column);
        }
        if let [longer, shorter] = &self.beside[..] {
            let (mut x, last) = (DVector::zeros(states + inputs), states - 1);
            x[last] = SMALL * self.duration;
            let column = (pull(longer, &x)? - pull(shorter, &-&x)?) / (2.0 * x[last]);
            hessian.set_column(last, &column);
            hessian.set_row(last, &column.transpose());
            hessian[(last, last)] = multipliers.dot(&stage.bent);
        }
        hessian.iter().all(|entry| entry.is_finite()).then(|| (&hessian + hessian.transpose()) * 0.5)
    }
}
